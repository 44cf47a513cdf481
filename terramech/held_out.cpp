#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include <terramech/held_out.hpp>

namespace talus::terramech {
namespace {

constexpr int kFolds = 5;

struct Folds {
  std::string scheme;
  std::vector<int> of_row;
};

/// Rows in bands of like values, neighbours in different folds.
std::vector<int> bands(const std::vector<double>& value, int count) {
  std::vector<std::size_t> order(value.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return value[a] < value[b]; });
  std::vector<int> fold(value.size());
  for (std::size_t k = 0; k < order.size(); ++k)
    fold[order[k]] = static_cast<int>(k * static_cast<std::size_t>(count) / order.size()) % kFolds;
  return fold;
}

std::vector<int> levels(const std::vector<double>& value) {
  std::map<long, int> number;
  for (double v : value) number.try_emplace(std::lround(v / 0.02), 0);
  int next = 0;
  for (auto& [key, fold] : number) fold = next++ % kFolds;
  std::vector<int> fold;
  for (double v : value) fold.push_back(number[std::lround(v / 0.02)]);
  return fold;
}

Folds foldsOf(const Trial& trial) {
  const std::set<int> runs(trial.run.begin(), trial.run.end());
  if (runs.size() >= kFolds && 2 * runs.size() <= trial.run.size()) {
    std::vector<int> fold;
    for (int run : trial.run) fold.push_back(static_cast<int>(std::distance(runs.begin(), runs.find(run))) % kFolds);
    return {"whole runs, five folds", fold};
  }
  std::set<long> slips;
  for (double s : trial.slip) slips.insert(std::lround(s / 0.02));
  if (slips.size() >= kFolds && 4 * slips.size() <= trial.slip.size() && slips.size() <= 20)
    return {"whole slip levels, five folds", levels(trial.slip)};
  if (slips.size() >= kFolds) return {"whole bands of slip, ten bands in five folds", bands(trial.slip, 10)};
  return {"whole bands of load, ten bands in five folds", bands(trial.load_N, 10)};
}

/// Squared errors summed by channel.
struct Sums {
  ChannelErrors sum{};
  std::array<int, kChannels> count{};

  void add(const Eigen::MatrixXd& residual) {
    for (int c = 0; c < kChannels; ++c)
      for (double r : residual.col(c))
        if (std::isfinite(r)) {
          sum[static_cast<std::size_t>(c)] += r * r;
          ++count[static_cast<std::size_t>(c)];
        }
  }

  ChannelErrors rmse() const {
    ChannelErrors e{};
    for (std::size_t c = 0; c < kChannels; ++c) e[c] = count[c] ? std::sqrt(sum[c] / count[c]) : std::nan("");
    return e;
  }
};

Eigen::MatrixXd asMeasured(const RefinedModel& model, Trial trial) {
  for (std::size_t row = 0; row < trial.states.size(); ++row) {
    trial.states[row].slip = trial.slip[row];
    trial.states[row].load_N = trial.load_N[row];
  }
  std::vector<double> guesses;
  return trial.measured - predictRows(model, trial, guesses);
}

}  // namespace

HeldOut holdOut(const TraceResult& result, const TraceOptions& options) {
  const Trial& trial = result.trial;
  const Folds folds = foldsOf(trial);
  std::vector<double> guesses;
  const Whitening all = whitening(trial, predictRows(result.refined, trial, guesses),
                                  inputSlopes(result.refined, trial, guesses), result.refined.noise);
  Sums base, refined;
  for (int fold = 0; fold < kFolds; ++fold) {
    std::vector<char> train, held;
    Whitening white;
    for (std::size_t row = 0; row < trial.states.size(); ++row) {
      train.push_back(folds.of_row[row] != fold);
      held.push_back(!train.back());
      if (train.back()) white.factor.push_back(all.factor[row]);
    }
    const Trial seen = subset(trial, train), unseen = subset(trial, held);
    if (unseen.rows() == 0 || seen.rows() == 0) continue;
    const auto refit = [&](const RefinedModel& model) {
      std::vector<double> start;
      FitPlan plan = fitPlan(model, options.fit_soil);
      plan.iterations = 8;
      return fitModel(model, seen, white, plan, start).model;
    };
    base.add(asMeasured(refit(result.base), unseen));
    refined.add(asMeasured(refit(result.refined), unseen));
  }
  return {folds.scheme, base.rmse(), refined.rmse()};
}

}  // namespace talus::terramech
