#include <algorithm>
#include <cmath>

#include <talus/terramech/numerics/natural_spline.hpp>
#include <talus/terramech/trace/spline_basis.hpp>
#include <talus/terramech/trace/trace_search.hpp>

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

TraceSearch::Held TraceSearch::held() {
  return {heldRows(foldsOf(trial_)), {}};
}

/// A curve over a column of few levels can take one knot a level and would pass any test that leaves rows of
/// each level in: it must also tell levels that it has not seen (a knot that only such rows tell is held near
/// 0 by its prior, so that coarse curves pass more easily). Empty where there are none to hold out.
const std::vector<TraceSearch::HeldRows>& TraceSearch::heldLevels(const Candidate& curve, Held& known) {
  const std::string& column = curve.covariate();
  if (const auto found = known.levels.find(column); found != known.levels.end()) return found->second;
  const Folds levels = levelFolds(trial_, column);
  const bool each = levels.count > 0 && levels.count <= 8 && levels.scheme.starts_with("whole levels");
  return known.levels[column] = each ? heldRows(levels) : std::vector<HeldRows>{};
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
  const std::size_t first = firstPart(k);
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
  const std::size_t first = firstPart(k);
  const auto begin = model_.effects.begin() + static_cast<long>(first);
  return {begin, begin + static_cast<long>(part_count_[k])};
}

std::optional<std::size_t> TraceSearch::choose(const std::vector<Explanation>& ranked) const {
  const auto believable = [](const Explanation& e) {
    return e.score >= 2.0 && e.in_sample >= 2.0 && !e.spoils;
  };
  const auto first = std::find_if(ranked.begin(), ranked.end(), believable);
  if (first == ranked.end()) return {};
  auto best = static_cast<std::size_t>(first - ranked.begin());
  if (first->candidate.empirical()) {
    // A known form that carries nearly all of what the curve does is the cause; its remainder is a
    // correction.
    const auto known = std::find_if(first, ranked.end(), [&](const Explanation& e) {
      return !e.candidate.empirical() && believable(e) && e.chi2_gain > 0.93 * first->chi2_gain;
    });
    if (known == ranked.end()) return best;
    best = static_cast<std::size_t>(known - ranked.begin());
  }
  // A parameter more than another form needs must carry a share, as a further effect must.
  const auto values = static_cast<double>(trial_.measured.array().isFinite().count());
  const double spare = std::min(0.1 * values, 0.05 * ranked[best].chi2_gain);
  const double enough = ranked[best].chi2_gain - spare;
  for (std::size_t k = best + 1; k < ranked.size(); ++k)
    if (!ranked[k].candidate.empirical() && believable(ranked[k]) && ranked[k].chi2_gain > enough &&
        ranked[k].candidate.parameters < ranked[best].candidate.parameters)
      best = k;
  return best;
}

void TraceSearch::refineCurves() {
  bool refined = false;
  for (std::size_t k = 0; k < model_.effects.size(); ++k) {
    if (!model_.effects[k].empirical()) continue;
    const Eigen::VectorXd x = covariateValues(trial_, model_.effects[k].covariate, sinkages(level_));
    for (const int most : {7, 9, 13}) {
      const Effect coarse = model_.effects[k];
      const auto knots = quantileKnots(x, std::min(most, trial_.rows() / 10));
      if (knots.size() <= coarse.knots.size()) continue;
      RefinedModel finer = model_;
      finer.effects[k].knots = knots;
      finer.effects[k].parameters.clear();
      const NaturalSpline curve{coarse.knots, coarse.parameters};
      for (const double knot : knots) finer.effects[k].parameters.push_back(curve(knot));
      SolvedContacts solved = solved_;
      const Fit fit = fitModel(finer, trial_, whitening_, planFor(finer), solved);
      const auto more = static_cast<double>(knots.size() - coarse.knots.size());
      if (chi2() - fit.cost() < more * std::log(static_cast<double>(trial_.rows())) + 4.0) continue;
      setModel(fit.model);
      refined = true;
    }
  }
  if (refined) refresh();
}

}  // namespace talus::terramech
