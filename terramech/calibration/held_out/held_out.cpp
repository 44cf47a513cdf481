#include <algorithm>
#include <map>
#include <set>

#include <talus/terramech/calibration/held_out/held_out.hpp>
#include <talus/terramech/calibration/held_out/model_scope.hpp>
#include <talus/terramech/calibration/held_out/refit.hpp>

namespace talus::terramech {
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

std::vector<std::string> columnsOfOneGroup(const RefinedModel& model) {
  std::set<std::string> columns;
  for (const Effect& e : model.effects)
    if (!e.only_column.empty()) columns.insert(e.only_column);
  return {columns.begin(), columns.end()};
}

}  // namespace

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
