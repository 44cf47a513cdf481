#include <algorithm>

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

std::vector<TraceSearch::HeldRows> TraceSearch::heldRows() {
  const Folds folds = foldsOf(trial_);
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

}  // namespace talus::terramech
