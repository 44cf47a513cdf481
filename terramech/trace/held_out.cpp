#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <talus/terramech/trace/held_out.hpp>
#include <talus/terramech/trace/model_scope.hpp>

namespace talus::terramech {
namespace {

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

/// Those of one model on all rows, and on those of each group.
class Tally {
 public:
  explicit Tally(const std::vector<std::string>& columns) : columns_(columns) {}

  void add(const Trial& unseen, const Eigen::MatrixXd& residual) {
    all_.add(residual);
    for (const std::string& column : columns_)
      for (int row = 0; row < unseen.rows(); ++row) {
        const std::string label{unseen.states[static_cast<std::size_t>(row)].label(column)};
        groups_[{column, label}].add(residual.row(row));
        ++rows_[{column, label}];
      }
  }

  ChannelErrors rmse() const { return all_.rmse(); }

  static std::vector<GroupErrors> groups(const Tally& base, const Tally& refined) {
    std::vector<GroupErrors> all;
    for (const auto& [key, sums] : base.groups_)
      all.push_back({.column = key.first,
                     .value = key.second,
                     .rows = base.rows_.at(key),
                     .base_rmse = sums.rmse(),
                     .refined_rmse = refined.groups_.at(key).rmse()});
    return all;
  }

 private:
  using Key = std::pair<std::string, std::string>;
  std::vector<std::string> columns_;
  Sums all_;
  std::map<Key, Sums> groups_;
  std::map<Key, int> rows_;
};

std::vector<std::string> columnsOfOneGroup(const RefinedModel& model) {
  std::set<std::string> columns;
  for (const Effect& e : model.effects)
    if (!e.only_column.empty()) columns.insert(e.only_column);
  return {columns.begin(), columns.end()};
}

/// Measured less predicted, at the slip and load as measured.
Eigen::MatrixXd leftAsMeasured(const RefinedModel& model, const Trial& trial) {
  SolvedContacts solved;
  return trial.measured - predictRows(model, asMeasured(trial), solved);
}

/// Each model is fitted under the errors that it would have: what the noise of slip and load does depends on
/// it.
Whitening whiteningOf(const RefinedModel& model, const SharedError& shared, const TraceResult& result) {
  SolvedContacts solved;
  Whitening all = whitening(result.trial, predictRows(model, result.trial, solved),
                            inputSlopes(model, result.trial, solved), model.noise);
  all.unit = shared.unit;
  all.run = shared.run;
  return all;
}

}  // namespace

ChannelErrors rmseAsMeasured(const RefinedModel& model, const Trial& trial) {
  Sums sums;
  sums.add(leftAsMeasured(model, trial));
  return sums.rmse();
}

namespace {

RefinedModel refitted(const RefinedModel& model, const SharedError& shared, const TraceResult& result,
                      const TraceOptions& options, const std::vector<char>& train) {
  const Trial seen = subset(result.trial, train);
  const Whitening white = subset(whiteningOf(model, shared, result), train);
  SolvedContacts start;
  FitPlan plan = fitPlan(model, options.fit_soil);
  plan.iterations = 8;
  if (result.first_prior && !model.effects.empty()) plan.effect_prior[0] = *result.first_prior;
  plan.misfit = misfitOf(white.apply(seen.measured - predictRows(model, seen, start)), seen);
  return fitModel(model, seen, white, plan, start).model;
}

}  // namespace

RefinedModel refittedBase(const TraceResult& result, const TraceOptions& options, std::vector<char> train) {
  const std::vector<char> of_soil = rowsOfSoil(subset(result.trial, train));
  for (std::size_t row = 0, seen = 0; row < train.size(); ++row)
    if (train[row] && !of_soil[seen++]) train[row] = 0;
  return refitted(result.base, result.base_shared, result, options, train);
}

RefinedModel refittedModel(const TraceResult& result, const TraceOptions& options,
                           const std::vector<char>& train) {
  return refitted(result.refined, result.shared, result, options, train);
}

HeldOut holdOut(const TraceResult& result, const TraceOptions& options, const Folds& folds) {
  const Trial& trial = result.trial;
  const auto columns = columnsOfOneGroup(result.refined);
  Tally base{columns}, refined{columns};
  for (int fold = 0; fold < folds.count; ++fold) {
    const std::vector<char> train = rowsOf(folds, fold, false);
    const Trial unseen = subset(trial, rowsOf(folds, fold, true));
    if (unseen.rows() == 0 || unseen.rows() == trial.rows()) continue;
    base.add(unseen, leftAsMeasured(refittedBase(result, options, train), unseen));
    refined.add(unseen, leftAsMeasured(refittedModel(result, options, train), unseen));
  }
  HeldOut held{folds.scheme, base.rmse(), refined.rmse(), Tally::groups(base, refined)};
  keepConfirmed(held, result.scope);
  return held;
}

std::vector<HeldOut> holdOutLevels(const TraceResult& result, const TraceOptions& options) {
  std::vector<HeldOut> all;
  std::set<std::string> columns;
  for (const TracedEffect& e : result.effects) columns.insert(e.chosen.candidate.covariate());
  for (const std::string& column : columns) {
    if (column == "slip" && result.held_out.scheme.find("slip") != std::string::npos) continue;
    const Folds folds = levelFolds(result.trial, column);
    if (folds.count > 0) all.push_back(holdOut(result, options, folds));
  }
  return all;
}

}  // namespace talus::terramech
