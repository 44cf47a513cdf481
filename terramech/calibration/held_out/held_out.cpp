#include <cmath>
#include <map>
#include <set>

#include <talus/common/common.hpp>
#include <talus/terramech/calibration/fit/model_fit.hpp>
#include <talus/terramech/calibration/held_out/held_out.hpp>
#include <talus/terramech/calibration/noise/whitening.hpp>

namespace talus::terramech {
namespace {

/// Whitening of the rows for one model, because the effect of the noise of slip and load depends on the
/// model.
Whitening whiteningOf(const RefinedModel& model, const SharedError& shared, const TraceResult& result) {
  SolvedContacts solved;
  Whitening all = whitening(result.trial, predictRows(model, result.trial, solved),
                            inputSlopes(model, result.trial, solved), model.noise);
  all.common = shared;
  return all;
}

RefinedModel refitted(const RefinedModel& model, const SharedError& shared, const TraceResult& result,
                      const TraceOptions& options, const std::vector<char>& train) {
  const Trial seen = subset(result.trial, train);
  const Whitening white = subset(whiteningOf(model, shared, result), train);
  SolvedContacts start;
  FitPlan plan = fitPlan(model, options.fit_soil);
  plan.iterations = 8;
  plan.misfit = misfitOf(white.apply(seen.measured - predictRows(model, seen, start)), seen);
  return fitModel(model, seen, white, plan, start).model;
}

/// Residuals (measured - predicted) with slip and load as measured, rows x kChannels.
Eigen::MatrixXd leftAsMeasured(const RefinedModel& model, const Trial& trial) {
  SolvedContacts solved;
  return trial.measured - predictRows(model, asMeasured(trial), solved);
}

}  // namespace

void SquaredErrors::add(const Eigen::MatrixXd& residual) {
  for (int c = 0; c < kChannels; ++c)
    for (double r : residual.col(c))
      if (std::isfinite(r)) {
        sum_[static_cast<std::size_t>(c)] += r * r;
        ++count_[static_cast<std::size_t>(c)];
      }
}

ChannelErrors SquaredErrors::rmse() const {
  ChannelErrors e{};
  for (std::size_t c = 0; c < kChannels; ++c) e[c] = count_[c] ? std::sqrt(sum_[c] / count_[c]) : kNaN;
  return e;
}

ChannelErrors rmseAsMeasured(const RefinedModel& model, const Trial& trial) {
  return SquaredErrors(leftAsMeasured(model, trial)).rmse();
}

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

namespace {

/// Errors of one model on all rows, and on the rows of each group.
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
  SquaredErrors all_;
  std::map<Key, SquaredErrors> groups_;
  std::map<Key, int> rows_;
};

void keep(ChannelErrors& refined, const ChannelErrors& base, const ModelScope& scope) {
  for (std::size_t c = 0; c < kChannels; ++c)
    if (!scope.kept[c]) refined[c] = base[c];
}

std::vector<std::string> columnsOfOneGroup(const RefinedModel& model) {
  std::set<std::string> columns;
  for (const Effect& e : model.effects)
    if (!e.only_column.empty()) columns.insert(e.only_column);
  return {columns.begin(), columns.end()};
}

}  // namespace

void keepConfirmed(HeldOut& held, const ModelScope& scope) {
  keep(held.refined_rmse, held.base_rmse, scope);
  for (GroupErrors& g : held.groups) keep(g.refined_rmse, g.base_rmse, scope);
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
