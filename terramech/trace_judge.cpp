#include <algorithm>
#include <numeric>

#include <terramech/trace_search.hpp>

namespace talus::terramech {

namespace {

Eigen::MatrixXd rowsOf(const Eigen::MatrixXd& derivative, const std::vector<char>& keep) {
  Eigen::MatrixXd part(std::count(keep.begin(), keep.end(), 1) * kChannels, derivative.cols());
  Eigen::Index to = 0;
  for (std::size_t row = 0; row < keep.size(); ++row)
    if (keep[row])
      part.middleRows(kChannels * to++, kChannels) =
          derivative.middleRows(static_cast<Eigen::Index>(row) * kChannels, kChannels);
  return part;
}

}  // namespace

/// What a model, fitted anew to the rows that are seen, leaves on the others. It starts near, so that the
/// derivative at the start, known for all rows, will do.
TraceSearch::HeldRows TraceSearch::errorsOn(const HeldRows& fold, const RefinedModel& start,
                                            const Eigen::MatrixXd& derivative) const {
  SolvedContacts solved;
  FitPlan plan = planFor(start);
  const Eigen::MatrixXd seen = rowsOf(derivative, fold.is_seen);
  plan.derivative = &seen;
  plan.iterations = 4;
  const RefinedModel model = fitModel(start, fold.seen, fold.white_seen, plan, solved).model;
  solved = {};
  const Eigen::MatrixXd left = fold.unseen.measured - predictRows(model, fold.unseen, solved);
  HeldRows errors;
  errors.chi2 = fold.white_unseen.apply(left).squaredNorm();
  const Eigen::VectorXd scaled = fold.white_unseen.marginal(left);
  for (Eigen::Index i = 0; i < scaled.size(); ++i)
    errors.by_channel[static_cast<std::size_t>(i % kChannels)] += scaled[i] * scaled[i];
  return errors;
}

Eigen::MatrixXd TraceSearch::derivativeOf(const RefinedModel& model, SolvedContacts& solved) const {
  return jacobian(model, trial_, planFor(model).free, solved,
                  [&](const Eigen::MatrixXd& m) { return whitening_.apply(m); });
}

std::vector<TraceSearch::HeldRows> TraceSearch::heldRows(const Folds& folds) {
  const Eigen::MatrixXd derivative = derivativeOf(model_, solved_);
  std::vector<HeldRows> all;
  for (int fold = 0; fold < folds.count; ++fold) {
    const auto seen = rowsOf(folds, fold, false), unseen = rowsOf(folds, fold, true);
    HeldRows rows{.seen = subset(trial_, seen),
                  .unseen = subset(trial_, unseen),
                  .white_seen = subset(whitening_, seen),
                  .white_unseen = subset(whitening_, unseen),
                  .is_seen = seen};
    if (rows.seen.rows() == 0 || rows.unseen.rows() == 0) continue;
    const HeldRows errors = errorsOn(rows, model_, derivative);
    rows.chi2 = errors.chi2;
    rows.by_channel = errors.by_channel;
    all.push_back(std::move(rows));
  }
  return all;
}

/// A curve over a column of few levels can take one knot a level and would pass any test that leaves rows of
/// each level in: it must also tell levels that it has not seen (a knot that only such rows tell is held near
/// 0 by its prior, so that coarse curves pass more easily). Empty where there are none to hold out.
const std::vector<TraceSearch::HeldRows>& TraceSearch::heldLevels(const Candidate& curve,
                                                                  HeldByColumn& known) {
  const std::string& column = curve.covariate();
  if (const auto found = known.find(column); found != known.end()) return found->second;
  const Folds levels = levelFolds(trial_, column);
  const bool each = levels.count > 0 && levels.count <= 8 && levels.scheme.starts_with("whole levels");
  return known[column] = each ? heldRows(levels) : std::vector<HeldRows>{};
}

void TraceSearch::judgeHeldOut(const std::vector<HeldRows>& folds, const RefinedModel& fitted,
                               SolvedContacts& solved, Explanation& e) const {
  const Eigen::MatrixXd derivative = derivativeOf(fitted, solved);
  double gain = 0.0;
  std::array<double, kChannels> before{}, after{};
  for (const HeldRows& fold : folds) {
    const HeldRows errors = errorsOn(fold, fitted, derivative);
    gain += 0.5 * (fold.chi2 - errors.chi2);
    for (std::size_t c = 0; c < kChannels; ++c) {
      before[c] += fold.by_channel[c];
      after[c] += errors.by_channel[c];
    }
  }
  e.score = gain - e.candidate.parameters + (e.candidate.empirical() ? 0.0 : options_.library_bonus);
  for (std::size_t c = 0; c < kChannels; ++c)
    e.spoils |= after[c] > 1.05 * before[c] + 4.0;  // 2.5 % of the rms, and what chance does
}

void TraceSearch::thin(std::size_t k, double least_gain) {
  const auto first =
      std::accumulate(part_count_.begin(), part_count_.begin() + static_cast<long>(k), std::size_t{0});
  for (std::size_t part = part_count_[k]; part-- > 0 && part_count_[k] > 1;) {
    RefinedModel without = model_;
    without.effects.erase(without.effects.begin() + static_cast<long>(first + part));
    SolvedContacts solved = solved_;
    const Fit fit = fitModel(without, trial_, whitening_, planFor(without), solved);
    if (fit.chi2 - chi2() > least_gain) continue;
    model_ = fit.model;
    --part_count_[k];
    refresh();
  }
}

std::vector<Effect> TraceSearch::parts(std::size_t k) const {
  const auto first =
      std::accumulate(part_count_.begin(), part_count_.begin() + static_cast<long>(k), std::size_t{0});
  const auto begin = model_.effects.begin() + static_cast<long>(first);
  return {begin, begin + static_cast<long>(part_count_[k])};
}

}  // namespace talus::terramech
