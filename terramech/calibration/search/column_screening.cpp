#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include <talus/terramech/calibration/fit/effect_candidates.hpp>
#include <talus/terramech/calibration/search/column_screening.hpp>
#include <talus/terramech/calibration/search/trace_search.hpp>

namespace talus::terramech {
namespace {

/// Rows in order of runs, the rows of a moment together.
std::vector<std::vector<std::size_t>> unitsInOrder(const Trial& trial) {
  std::vector<std::size_t> order(static_cast<std::size_t>(trial.rows()));
  std::iota(order.begin(), order.end(), std::size_t{0});
  const bool drive = !trial.moment.empty();
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    if (trial.run[a] != trial.run[b]) return trial.run[a] < trial.run[b];
    return drive && trial.moment[a] < trial.moment[b];
  });
  std::vector<std::vector<std::size_t>> units;
  for (std::size_t k = 0; k < order.size(); ++k)
    if (k > 0 && drive && trial.moment[order[k]] == trial.moment[order[k - 1]])
      units.back().push_back(order[k]);
    else
      units.push_back({order[k]});
  return units;
}

std::vector<std::string> ownColumns(const Trial& trial) {
  std::vector<std::string> own;
  std::copy_if(trial.covariates.begin(), trial.covariates.end(), std::back_inserter(own), isOwnColumn);
  own.insert(own.end(), trial.groupings.begin(), trial.groupings.end());
  return own;
}

/// The greatest gain of the coarse candidates of each column.
std::vector<double> gainsOf(const RefinedModel& base, const Trial& trial, const std::vector<std::string>& own,
                            const TraceOptions& options, const std::function<bool(double)>& go_on) {
  std::vector<Candidate> candidates;
  std::vector<std::size_t> column;
  for (std::size_t k = 0; k < own.size(); ++k)
    for (Candidate& c : coarseCandidates(trial, own[k])) {
      candidates.push_back(std::move(c));
      column.push_back(k);
    }
  Trial without = trial;  // trial without the screened columns
  std::erase_if(without.covariates, isOwnColumn);
  without.groupings.clear();
  const std::vector<double> each = TraceSearch{base, without, options, go_on}.gainsOf(candidates);
  std::vector<double> gain(own.size(), 0.0);
  for (std::size_t k = 0; k < each.size(); ++k) gain[column[k]] = std::max(gain[column[k]], each[k]);
  return gain;
}

bool isIn(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

std::vector<char> rowSample(const Trial& trial, int most, std::uint64_t seed) {
  const auto rows = static_cast<std::size_t>(trial.rows());
  if (trial.rows() <= most) return std::vector<char>(rows, 1);
  const auto units = unitsInOrder(trial);
  const double stretch = static_cast<double>(rows) / most;
  std::mt19937_64 random(seed);
  std::vector<char> keep(rows, 0);
  for (std::size_t k = 0;; ++k) {
    const auto first = static_cast<std::size_t>(static_cast<double>(k) * stretch),
               last = std::min(units.size(), static_cast<std::size_t>(static_cast<double>(k + 1) * stretch));
    if (first >= last) break;
    for (const std::size_t row : units[first + random() % (last - first)]) keep[row] = 1;
  }
  return keep;
}

Trial screenColumns(const RefinedModel& base, const Trial& trial, const TraceOptions& options,
                    const std::function<bool(double)>& go_on) {
  const std::vector<std::string> own = ownColumns(trial);
  const auto most = static_cast<std::size_t>(options.most_columns);
  if (own.size() <= most) return trial;
  const std::vector<double> gain = gainsOf(base, trial, own, options, go_on);
  std::vector<std::size_t> order(own.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return gain[a] > gain[b]; });
  std::sort(order.begin() + static_cast<long>(most), order.end());
  Trial screened = trial;
  const double by_chance = std::log(static_cast<double>(own.size()) / options.significance);
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::string& column = own[order[k]];
    if (k >= most)
      screened.dropped.push_back(column);
    else if (gain[order[k]] <= by_chance)  // (T40)
      screened.chance.push_back(column);
  }
  const auto isDropped = [&](const std::string& name) { return isIn(screened.dropped, name); };
  std::erase_if(screened.covariates, isDropped);
  std::erase_if(screened.groupings, isDropped);
  for (WheelState& s : screened.states) {
    std::erase_if(s.extra, [&](const auto& value) { return isDropped(value.first); });
    std::erase_if(s.group, [&](const auto& label) { return isDropped(label.first); });
  }
  return screened;
}

}  // namespace talus::terramech
