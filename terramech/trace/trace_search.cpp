#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/QR>

#include <talus/terramech/trace/input_calibration.hpp>
#include <talus/terramech/trace/spline_basis.hpp>
#include <talus/terramech/trace/trace_search.hpp>

namespace talus::terramech {
namespace {

RefinedModel with(const RefinedModel& model, const Candidate& candidate) {
  RefinedModel grown = model;
  for (const Effect& part : candidate.parts) grown.effects.push_back(part);
  return grown;
}

/// Whether a form of a candidate is in the model: several forms together are tried once.
bool shares(const RefinedModel& model, const Candidate& candidate) {
  return std::any_of(candidate.parts.begin(), candidate.parts.end(), [&](const Effect& part) {
    return std::any_of(model.effects.begin(), model.effects.end(),
                       [&](const Effect& e) { return e.name == part.name; });
  });
}

Eigen::MatrixXd off(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& orthonormal_nuisance) {
  if (orthonormal_nuisance.cols() == 0) return columns;
  return columns - orthonormal_nuisance * (orthonormal_nuisance.transpose() * columns);
}

}  // namespace

double TraceSearch::work() const {
  return trial_.rows() * (static_cast<double>(planFor(model_).free.size()) + 3.0);
}

TraceSearch::TraceSearch(const RefinedModel& base, const Trial& trial, const TraceOptions& options)
    : options_(options), model_(base), trial_(trial), given_effects_(base.effects.size()) {
  refresh();
  if (!planFor(model_).free.empty()) fitSoil();
}

FitPlan TraceSearch::planFor(const RefinedModel& model) const {
  FitPlan plan = fitPlan(model, options_.fit_soil);
  if (first_prior_) plan.effect_prior[0] = *first_prior_;
  return plan;
}

void TraceSearch::fitSoil() {
  // A soil is learned where the wheel rolls straight, if there are rows enough: at an angle the base has no
  // say.
  const Trial all = trial_;
  std::vector<char> straight;
  for (const WheelState& s : trial_.states) straight.push_back(std::abs(s.slip_angle_rad) < 0.1);
  const auto count = std::count(straight.begin(), straight.end(), 1);
  const bool part = count >= 20 && count < trial_.rows();
  if (part) {
    trial_ = subset(all, straight);
    solved_ = {};
    refresh();
  }
  for (int round = 0; round < 3; ++round) {
    FitPlan plan = planFor(model_);
    plan.iterations = 30;
    model_ = fitModel(model_, trial_, whitening_, plan, solved_).model;
    refresh();
  }
  if (!part) return;
  trial_ = all;
  solved_ = {};
  refresh();
}

Eigen::VectorXd TraceSearch::sinkages(const Eigen::MatrixXd& level) const {
  Eigen::VectorXd z(level.rows());
  for (int row = 0; row < trial_.rows(); ++row)
    z[row] = level(row, static_cast<int>(Channel::Sinkage)) * trial_.denominator(row, Channel::Sinkage);
  return z;
}

double TraceSearch::penalty(const Candidate& candidate) const {
  return 0.5 * candidate.parameters * std::log(static_cast<double>(trial_.rows()));
}

Eigen::VectorXd TraceSearch::change(const RefinedModel& moved) {
  SolvedContacts solved = solved_;
  return whitening_.apply(predictRows(moved, trial_, solved) - level_);
}

TraceSearch::Screened TraceSearch::screenLibrary(const Candidate& candidate,
                                                 const Eigen::MatrixXd& nuisance) {
  const RefinedModel grown = with(model_, candidate);
  const Eigen::VectorXd whole = change(grown);
  std::vector<FittedParameter> free;
  for (std::size_t part = model_.effects.size(); part < grown.effects.size(); ++part)
    for (const FittedParameter& p : parametersOf(grown, static_cast<int>(part))) free.push_back(p);
  Eigen::MatrixXd columns(whole.size(), std::max<Eigen::Index>(1, static_cast<Eigen::Index>(free.size())));
  columns.col(0) = whole;
  for (std::size_t k = 1; k < free.size(); ++k) {
    RefinedModel moved = grown;
    setValue(moved, free[k], value(grown, free[k]) + 0.05 * rangeOf(grown, free[k]).scale);
    columns.col(static_cast<Eigen::Index>(k)) = (change(moved) - whole) / 0.05;
  }
  Screened screened{candidate, off(columns, nuisance), 0.0};
  const Eigen::VectorXd weights = screened.direction.colPivHouseholderQr().solve(white_);
  double gain = (screened.direction * weights).squaredNorm();
  if (!std::isfinite(gain)) gain = 0.0;  // a form that moves nothing has no direction
  if (free.empty()) gain = white_.squaredNorm() - (white_ - screened.direction.col(0)).squaredNorm();
  const EffectForm* form = findEffect(candidate.parts.front().name);
  if (!free.empty() && form->parameters.front().low >= 0.0 && weights[0] < 0.0) gain = 0.0;
  screened.score = 0.5 * gain - penalty(candidate) + options_.library_bonus;
  return screened;
}

TraceSearch::Screened TraceSearch::screenSoilCurve(const Candidate& candidate,
                                                   const Eigen::MatrixXd& nuisance) {
  // All knots act through one number of the soil, so that one derivative by it gives every column.
  const Effect& curve = candidate.parts.front();
  Candidate level = candidate;
  level.parts.front().parameters.assign(curve.knots.size(), 0.02);
  const Eigen::VectorXd whole = change(with(model_, level)) / 0.02;
  const Eigen::MatrixXd basis =
      splineBasis(covariateValues(trial_, curve.covariate, sinkages(level_)), curve.knots);
  Eigen::MatrixXd columns(whole.size(), basis.cols());
  for (Eigen::Index row = 0; row < basis.rows(); ++row)
    for (int c = 0; c < kChannels; ++c)
      columns.row(row * kChannels + c) = whole[row * kChannels + c] * basis.row(row);
  Screened screened{candidate, off(columns, nuisance), 0.0};
  const double gain = (orthonormal(screened.direction).transpose() * white_).squaredNorm();
  screened.score = 0.5 * gain - penalty(candidate);
  return screened;
}

TraceSearch::Screened TraceSearch::screenCurves(const Candidate& candidate, const Eigen::MatrixXd& nuisance) {
  if (candidate.parts.front().name != "empirical") return screenSoilCurve(candidate, nuisance);
  Screened screened{candidate, {}, 0.0};
  screened.candidate.parts.clear();
  screened.candidate.parameters = 0;
  for (const Effect& curve : candidate.parts) {
    const auto x = covariateValues(trial_, curve.covariate, sinkages(level_));
    const Eigen::MatrixXd basis = splineBasis(x, curve.knots);
    Eigen::MatrixXd columns(white_.size(), basis.cols());
    for (Eigen::Index k = 0; k < basis.cols(); ++k) {
      Eigen::MatrixXd change = Eigen::MatrixXd::Zero(trial_.rows(), kChannels);
      change.col(static_cast<int>(curve.channel)) = basis.col(k);
      columns.col(k) = whitening_.apply(change);
    }
    columns = off(columns, nuisance);
    const double gain = (orthonormal(columns).transpose() * white_).squaredNorm();
    const double cost =
        0.5 * static_cast<double>(curve.knots.size()) * std::log(static_cast<double>(trial_.rows()));
    if (0.5 * gain < cost) continue;
    screened.candidate.parts.push_back(curve);
    screened.candidate.parameters += static_cast<int>(curve.knots.size());
    const Eigen::Index at = screened.direction.cols();
    screened.direction.conservativeResize(white_.size(), at + columns.cols());
    screened.direction.rightCols(columns.cols()) = columns;
  }
  if (screened.candidate.parts.empty()) return screened;
  const double gain = (orthonormal(screened.direction).transpose() * white_).squaredNorm();
  screened.score = 0.5 * gain - penalty(screened.candidate);
  return screened;
}

std::vector<TraceSearch::Screened> TraceSearch::screen() {
  const Eigen::MatrixXd known = orthonormal(derivativeOf(model_, solved_));
  std::vector<Screened> all;
  for (const Candidate& c : libraryCandidates(trial_, sinkages(level_)))
    if (c.parts.size() == 1 || !shares(model_, c)) all.push_back(screenLibrary(c, known));
  for (const Candidate& c : empiricalCandidates(trial_, sinkages(level_))) {
    Screened s = screenCurves(c, known);
    if (!s.candidate.parts.empty()) all.push_back(std::move(s));
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Screened& a, const Screened& b) { return a.score > b.score; });
  return all;
}

std::vector<CovariateTest> TraceSearch::test(const std::vector<Screened>& screened) {
  TestPlan plan;
  plan.units = units_;
  plan.flips = options_.flips;
  plan.seed = options_.seed;
  plan.nuisance_whitened = derivativeOf(model_, solved_);
  plan.nuisance_marginal = jacobian(model_, trial_, planFor(model_).free, solved_,
                                    [&](const Eigen::MatrixXd& m) { return whitening_.marginal(m); });
  if (by_slip_) plan.shared_error = trial_.measured.array().isFinite().select(*by_slip_, 0.0);
  for (const Screened& s : screened)
    if (!s.candidate.empirical()) plan.directions.push_back({s.candidate.parts.front().name, s.direction});
  return testCovariates(trial_, whitening_, residual_, sinkages(level_), plan);
}

std::vector<Explanation> TraceSearch::fitBest(const std::vector<Screened>& screened) {
  std::vector<Explanation> ranked;
  std::map<std::string, int> tried;
  Held rows = held();
  int library = 0, empirical = 0;
  for (const Screened& s : screened) {
    int& count = s.candidate.empirical() ? empirical : library;
    const Effect& front = s.candidate.parts.front();
    if (count >= (s.candidate.empirical() ? 3 : options_.fits) || s.score < -2.0) continue;
    if (++tried[front.name + front.covariate + front.only_value] > 2) continue;
    ++count;
    ranked.push_back(fitted(s.candidate, rows));
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const Explanation& a, const Explanation& b) { return a.score > b.score; });
  return ranked;
}

Explanation TraceSearch::fitted(const Candidate& candidate, Held& held) {
  const RefinedModel grown = with(model_, candidate);
  SolvedContacts solved = solved_;
  FitPlan plan = planFor(grown);
  plan.iterations = candidate.empirical()        ? 5
                    : candidate.parts.size() > 2 ? 30
                    : candidate.parts.size() > 1 ? 15
                                                 : 10;
  const Fit fit = fitModel(grown, trial_, whitening_, plan, solved);
  Explanation e;
  e.candidate = candidate;
  for (std::size_t k = 0; k < candidate.parts.size(); ++k)
    e.candidate.parts[k] = fit.model.effects[model_.effects.size() + k];
  e.chi2_gain = white_.squaredNorm() - fit.chi2 - fit.prior_chi2;
  e.in_sample =
      0.5 * e.chi2_gain - penalty(candidate) + (candidate.empirical() ? 0.0 : options_.library_bonus);
  judgeHeldOut(held.folds, fit.model, solved, e);
  // What comes on top of other effects must hold between the levels, too; a first dependence is told as it
  // is.
  const bool further = model_.effects.size() > given_effects_;
  if (further && candidate.empirical() && !heldLevels(candidate, held).empty()) {
    Explanation unseen = e;
    judgeHeldOut(heldLevels(candidate, held), fit.model, solved, unseen);
    e.score = std::min(e.score, unseen.score);
    e.spoils |= unseen.spoils;
  }
  const Eigen::VectorXd before = whitening_.marginal(residual_),
                        after = whitening_.marginal(trial_.measured - predictRows(fit.model, trial_, solved));
  for (Eigen::Index i = 0; i < before.size(); ++i)
    e.by_channel[static_cast<std::size_t>(i % kChannels)] += before[i] * before[i] - after[i] * after[i];
  return e;
}

void TraceSearch::accept(const Candidate& candidate) {
  part_count_.push_back(candidate.parts.size());
  model_ = with(model_, candidate);
  for (int round = 0; round < 2; ++round) {
    model_ = fitModel(model_, trial_, whitening_, planFor(model_), solved_).model;
    refresh();
  }
}

std::size_t TraceSearch::firstPart(std::size_t k) const {
  return std::accumulate(part_count_.begin(), part_count_.begin() + static_cast<long>(k), given_effects_);
}

void TraceSearch::leaveOut(std::size_t k) {
  const std::size_t first = firstPart(k);
  const auto begin = model_.effects.begin() + static_cast<long>(first);
  model_.effects.erase(begin, begin + static_cast<long>(part_count_[k]));
  part_count_.erase(part_count_.begin() + static_cast<long>(k));
  SolvedContacts solved = solved_;
  setModel(fitModel(model_, trial_, whitening_, planFor(model_), solved).model);
}

std::vector<Explanation> TraceSearch::rivals(std::size_t k) {
  const TraceSearch kept = *this;
  leaveOut(k);
  auto ranked = fitBest(screen());
  *this = kept;
  return ranked;
}

void TraceSearch::drop(std::size_t k) {
  leaveOut(k);
  for (int round = 0; round < 2; ++round) {
    model_ = fitModel(model_, trial_, whitening_, planFor(model_), solved_).model;
    refresh();
  }
}

void TraceSearch::replace(std::size_t k, const Candidate& candidate) {
  leaveOut(k);
  accept(candidate);
}

Channel TraceSearch::strongest(std::size_t effect) {
  RefinedModel without = model_;
  without.effects.erase(without.effects.begin() + static_cast<long>(effect));
  SolvedContacts solved = solved_;
  const Eigen::VectorXd moved = whitening_.marginal(
      trial_.measured.array().isFinite().select(predictRows(without, trial_, solved) - level_, 0.0));
  std::array<double, kChannels> size{};
  for (Eigen::Index i = 0; i < moved.size(); ++i)
    size[static_cast<std::size_t>(i % kChannels)] += moved[i] * moved[i];
  return static_cast<Channel>(std::max_element(size.begin(), size.end()) - size.begin());
}

void TraceSearch::finish(TraceResult& result) {
  const FitPlan plan = planFor(model_);
  const Fit fit = fitModel(model_, trial_, whitening_, plan, solved_);
  const SensorNoise noise = model_.noise;
  model_ = fit.model;
  model_.noise = noise;
  model_.fitted = plan.free;
  const Eigen::MatrixXd covariance = parameterCovariance(model_, trial_, whitening_, plan, solved_);
  model_.covariance.assign(covariance.data(), covariance.data() + covariance.size());
  level_ = predictRows(model_, trial_, solved_);
  std::size_t at = given_effects_;
  for (std::size_t k = 0; k < result.effects.size(); ++k) {
    auto& effect = result.effects[k];
    if (part_count_[k] == 1) effect.channel = strongest(at);
    for (Effect& part : effect.chosen.candidate.parts) part = model_.effects[at++];
    effect.parameter_std.clear();
    for (std::size_t j = 0; j < plan.free.size(); ++j) {
      const int e = plan.free[j].effect;
      if (e >= static_cast<int>(at - part_count_[k]) && e < static_cast<int>(at))
        effect.parameter_std.push_back(
            std::sqrt(std::max(0.0, covariance(static_cast<long>(j), static_cast<long>(j)))));
    }
  }
  result.refined = model_;
  result.first_prior = first_prior_;
  Trial measured = trial_;
  for (std::size_t row = 0; row < measured.states.size(); ++row) {
    measured.states[row].slip = measured.slip[row];
    measured.states[row].load_N = measured.load_N[row];
  }
  result.base_rmse = rmseOf(result.base, measured);
  result.refined_rmse = rmseOf(result.refined, measured);
  // What the sensors and the noisy inputs alone would leave, at the rows' own slip and load.
  const InputSlopes slopes = inputSlopes(model_, measured, solved_);
  for (std::size_t c = 0; c < kChannels; ++c) {
    double sum = 0.0;
    int count = 0;
    for (int row = 0; row < trial_.rows(); ++row) {
      const auto k = static_cast<int>(c);
      if (!std::isfinite(trial_.measured(row, k))) continue;
      const auto& n = model_.noise;
      const double slip =
          std::hypot(n.slip_absolute, n.slip_relative * trial_.slip[static_cast<std::size_t>(row)]);
      sum += std::pow(n.absolute[c] / trial_.denominator(row, static_cast<Channel>(k)), 2) +
             std::pow(n.relative[c] * level_(row, k), 2) + std::pow(slip * slopes.by_slip(row, k), 2) +
             std::pow(n.load_relative * slopes.by_load(row, k), 2);
      ++count;
    }
    result.noise_floor[c] = count ? std::sqrt(sum / count) : std::nan("");
  }
  result.units = units_;
  result.trial = trial_;
}

}  // namespace talus::terramech
