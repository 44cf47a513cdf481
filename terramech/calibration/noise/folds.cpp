#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include <talus/terramech/calibration/noise/folds.hpp>

namespace talus::terramech {
namespace {

constexpr int kFolds = 5;

/// Assigns rows to bands of similar values; neighbouring bands are in different folds.
std::vector<int> bands(const std::vector<double>& value, int count) {
  std::vector<std::size_t> order(value.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return value[a] < value[b]; });
  std::vector<int> fold(value.size());
  for (std::size_t k = 0; k < order.size(); ++k)
    fold[order[k]] = static_cast<int>(k * static_cast<std::size_t>(count) / order.size()) % kFolds;
  return fold;
}

/// Level number of each row of a column, in ascending order; values within `width` are one level.
std::vector<int> levels(const std::vector<double>& value, double width) {
  std::map<long, int> number;
  for (double v : value) number.try_emplace(std::lround(v / width), 0);
  int next = 0;
  for (auto& [key, level] : number) level = next++;
  std::vector<int> level;
  for (double v : value) level.push_back(number[std::lround(v / width)]);
  return level;
}

}  // namespace

Folds foldsOf(const Trial& trial) {
  const std::set<int> runs(trial.run.begin(), trial.run.end());
  if (runs.size() >= kFolds && 2 * runs.size() <= trial.run.size()) {
    // Consecutive moments of a drive have similar errors; whole stretches of the drive are therefore held
    // out.
    const bool moments = trial.run == trial.moment;
    const auto of = [&](int run) {
      const auto k = std::distance(runs.begin(), runs.find(run)),
                 count = static_cast<std::ptrdiff_t>(runs.size());
      return static_cast<int>((moments ? 2 * kFolds * k / count : k) % kFolds);
    };
    std::vector<int> fold;
    for (int run : trial.run) fold.push_back(of(run));
    return {moments ? "stretches of the drive, ten in five folds" : "whole runs, five folds", fold, kFolds};
  }
  std::vector<int> level = levels(trial.slip, 0.02);
  const auto count = static_cast<std::size_t>(*std::max_element(level.begin(), level.end())) + 1;
  if (count >= kFolds && 4 * count <= level.size() && count <= 20) {
    for (int& l : level) l %= kFolds;
    return {"whole slip levels, five folds", level, kFolds};
  }
  if (count >= kFolds) return {"whole bands of slip, ten bands in five folds", bands(trial.slip, 10), kFolds};
  return {"whole bands of load, ten bands in five folds", bands(trial.load_N, 10), kFolds};
}

Folds levelFolds(const Trial& trial, const std::string& column) {
  std::vector<double> value;
  for (const WheelState& s : trial.states) value.push_back(std::abs(s.covariate(column)));
  if (value.empty() || std::any_of(value.begin(), value.end(), [](double v) { return !std::isfinite(v); }))
    return {};
  const auto [low, high] = std::minmax_element(value.begin(), value.end());
  if (*high <= *low) return {};
  const std::vector<int> level = levels(value, 0.04 * (*high - *low));
  const int count = *std::max_element(level.begin(), level.end()) + 1;
  if (count < 3) return {};
  if (count > 8) return {"whole bands of " + column + ", ten bands in five folds", bands(value, 10), kFolds};
  return {"whole levels of " + column + ", each held out in turn", level, count};
}

std::vector<char> rowsOf(const Folds& folds, int fold, bool held) {
  std::vector<char> rows;
  for (int f : folds.of_row) rows.push_back((f == fold) == held);
  return rows;
}

}  // namespace talus::terramech
