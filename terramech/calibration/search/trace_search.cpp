#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include <talus/terramech/calibration/noise/input_calibration.hpp>
#include <talus/terramech/calibration/noise/run_units.hpp>
#include <talus/terramech/calibration/noise/spline_basis.hpp>
#include <talus/terramech/calibration/search/trace_search.hpp>
#include <talus/terramech/numerics/natural_spline.hpp>

namespace talus::terramech {
namespace {

/// Whether a form of a candidate is in the model: several forms together are tried once.
bool shares(const RefinedModel& model, const Candidate& candidate) {
  return std::any_of(candidate.parts.begin(), candidate.parts.end(), [&](const Effect& part) {
    return std::any_of(model.effects.begin(), model.effects.end(),
                       [&](const Effect& e) { return e.name == part.name; });
  });
}

std::string keyOf(const Effect& e) {
  return e.name + '|' + e.covariate + '|' + (e.empirical() ? name(e.channel) : "") + '|' + e.only_value;
}

/// A column, and whether by a known form or a curve.
std::string kindOf(const Candidate& candidate) {
  return candidate.covariate() + (candidate.empirical() ? " curve" : " form");
}

}  // namespace

TraceSearch::TraceSearch(const RefinedModel& base, const Trial& trial, const TraceOptions& options,
                         std::function<bool(double)> go_on)
    : options_(options),
      go_on_(std::move(go_on)),
      model_(base),
      prior_modulus_(base.soil.cohesive_modulus + base.soil.frictional_modulus),
      trial_(trial),
      folds_(foldsOf(trial)),
      given_effects_(base.effects.size()) {
  refresh();
  if (!planFor(model_).free.empty()) fitSoil();
}

FitPlan TraceSearch::planFor(const RefinedModel& model) const {
  FitPlan plan = fitPlan(model, options_.fit_soil);
  plan.prior_modulus = prior_modulus_;
  if (first_prior_) plan.effect_prior[0] = *first_prior_;
  plan.misfit = misfit_;
  return plan;
}

Fit TraceSearch::fit(const RefinedModel& model, int iterations, SolvedContacts& solved) const {
  FitPlan plan = planFor(model);
  plan.iterations = iterations;
  return fitModel(model, trial_, whitening_, plan, solved);
}

void TraceSearch::fitSoil() {
  const Trial all = trial_;
  const std::vector<char> rows = rowsOfSoil(all);
  const bool part = std::find(rows.begin(), rows.end(), 0) != rows.end();
  if (part) {
    trial_ = subset(all, rows);
    folds_ = foldsOf(trial_);
    solved_ = {};
    refresh();
  }
  for (int round = 0; round < 3 && go_on_(0.0); ++round) {
    model_ = fit(model_, 30, solved_).model;
    refresh();
  }
  if (!part) return;
  trial_ = all;
  folds_ = foldsOf(trial_);
  solved_ = {};
  refresh();
}

Eigen::VectorXd TraceSearch::sinkages() const {
  Eigen::VectorXd z(level_.rows());
  for (int row = 0; row < trial_.rows(); ++row)
    z[row] = level_(row, static_cast<int>(Channel::Sinkage)) * trial_.denominator(row, Channel::Sinkage);
  return z;
}

NullModel TraceSearch::standing(const RefinedModel& model, const Eigen::MatrixXd& residual,
                                SolvedContacts& solved) const {
  NullModel null{whitening_.shared(),
                 whitening_.unit,
                 folds_,
                 whitening_.rowByRow(residual),
                 linearised(model, trial_, whitening_, planFor(model), solved),
                 whitening_.run,
                 static_cast<Eigen::Index>(planFor(model).soil_prior.size())};
  if (!by_slip_) return null;
  // The error that all slips share is one more number, known to be 0 give or take one.
  LinearModel& known = null.known;
  const Eigen::Index at = known.columns.cols();
  known.columns.conservativeResize(null.residual.size(), at + 1);
  known.columns.col(at) =
      whitening_.rowByRow(trial_.measured.array().isFinite().select(*by_slip_, 0.0).matrix());
  known.prior.mean.conservativeResize(at + 1);
  known.prior.precision.conservativeResize(at + 1);
  known.prior.mean[at] = 0.0;
  known.prior.precision[at] = 1.0;
  return null;
}

GainDistribution TraceSearch::distributionOf(const std::vector<Candidate>& candidates, int draws) {
  const Eigen::VectorXd sinkage_m = sinkages();
  SolvedContacts solved = solved_;
  const NullModel null = standing(model_, residual_, solved);
  const ModelOnRows here{model_, trial_, whitening_, level_, sinkage_m, solved_};
  GainDistribution found = gainDistribution(
      null, {candidates.size(), [&](std::size_t k) { return contenderOf(candidates[k], here); }}, draws,
      options_.seed, go_on_);
  found.further_questions = furtherQuestions(trial_);
  return found;
}

std::vector<double> TraceSearch::gainsOf(const std::vector<Candidate>& candidates) {
  return distributionOf(candidates, 0).gain;
}

TraceSearch::Screening TraceSearch::screen(int draws) {
  const Eigen::VectorXd sinkage_m = sinkages();
  std::vector<Candidate> all;
  // On a drive slip, load, heading and time go together: a curve of one stands for any, and only forms that say
  // what every channel does can be told apart.
  const bool drive = !trial_.moment.empty();
  for (Candidate& c : libraryCandidates(trial_, sinkage_m))
    if ((c.parts.size() == 1 || !shares(model_, c)) && !(drive && c.family == "drift"))
      all.push_back(std::move(c));
  if (!drive)
    for (Candidate& c : empiricalCandidates(trial_, sinkage_m)) all.push_back(std::move(c));
  Screening screening;
  screening.noise = distributionOf(all, draws);
  screening.threshold = screening.noise.threshold(options_.significance);
  for (std::size_t k = 0; k < all.size(); ++k)
    screening.promises.push_back(
        {all[k], screening.noise.gain[k], screening.noise.pValue(screening.noise.gain[k])});
  std::stable_sort(screening.promises.begin(), screening.promises.end(),
                   [](const Promise& a, const Promise& b) { return a.gain > b.gain; });
  return screening;
}

std::vector<Explanation> TraceSearch::fitBest(const std::vector<Promise>& promises) {
  std::vector<Explanation> ranked;
  std::map<std::string, int> tried;
  int library = 0, empirical = 0;
  for (const Promise& p : promises) {
    int& count = p.candidate.empirical() ? empirical : library;
    if (!go_on_(0.0)) break;
    // Forms that act together say little to first order.
    if (!p.candidate.empirical() && p.candidate.parts.size() > 1) {
      ranked.push_back(fitted(p.candidate));
      continue;
    }
    if (p.gain <= 0.0 || count >= (p.candidate.empirical() ? options_.fits / 2 : options_.fits)) continue;
    if (++tried[keyOf(p.candidate.parts.front())] > 2) continue;
    ++count;
    ranked.push_back(fitted(p.candidate));
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const Explanation& a, const Explanation& b) { return a.gain > b.gain; });
  return ranked;
}

double TraceSearch::scoreOf(const RefinedModel& fitted) const {
  SolvedContacts solved = solved_;
  const Eigen::MatrixXd residual = trial_.measured - predictRows(fitted, trial_, solved);
  return fittedScore(standing(fitted, residual, solved));
}

Explanation TraceSearch::fitted(const Candidate& candidate) {
  const RefinedModel grown = withCandidate(model_, candidate);
  SolvedContacts solved = solved_;
  const Fit found = fit(grown,
                        candidate.parts.size() > 2   ? 30
                        : candidate.parts.size() > 1 ? 15
                                                     : 10,
                        solved);
  Explanation e;
  e.candidate = candidate;
  for (std::size_t k = 0; k < candidate.parts.size(); ++k)
    e.candidate.parts[k] = found.model.effects[model_.effects.size() + k];
  e.chi2_gain = white_.squaredNorm() - found.chi2 - found.prior_chi2;
  const Eigen::MatrixXd left = trial_.measured - predictRows(found.model, trial_, solved);
  SolvedContacts before_solved = solved_;
  const NullModel before = standing(model_, residual_, before_solved),
                  after = standing(found.model, left, solved);
  e.gain = fittedScore(after) - fittedScore(before);
  const Eigen::VectorXd was = whitening_.marginal(residual_), is = whitening_.marginal(left);
  for (Eigen::Index i = 0; i < was.size(); ++i)
    e.by_channel[static_cast<std::size_t>(i % kChannels)] += was[i] * was[i] - is[i] * is[i];
  // What explains leaves the readings themselves less to explain. Beside a soil that is known, one that moves them
  // farther off, by more than all that it gains, moved what rows of a run share; a soil that is fitted moves with it.
  if (before.soil == 0 && is.squaredNorm() - was.squaredNorm() > 2.0 * std::max(0.0, e.gain))
    e.gain = std::min(0.0, e.gain);
  return e;
}

std::vector<Explanation> TraceSearch::pairs() {
  constexpr int kFirsts = 8, kPairs = 5;
  std::vector<std::pair<double, Candidate>> promised;
  const Screening screening = screen(0);
  std::set<std::string> columns;
  for (const Promise& p : screening.promises) {
    if (static_cast<int>(columns.size()) == kFirsts || p.gain <= 0.0 || !go_on_(0.0)) break;
    if (p.candidate.parts.size() > 1 || !columns.insert(kindOf(p.candidate)).second) continue;
    const Explanation first = fitted(p.candidate);
    TraceSearch beside = *this;
    SolvedContacts solved = solved_;
    beside.setModel(fit(withCandidate(model_, first.candidate), 3, solved).model);
    std::set<bool> seconds;  // the best curve and the best known form
    for (const Promise& q : beside.screen(0).promises) {
      if (seconds.size() == 2) break;
      if (q.candidate.parts.size() > 1 || q.candidate.covariate() == p.candidate.covariate()) continue;
      if (!seconds.insert(q.candidate.empirical()).second) continue;
      Candidate both = first.candidate;
      both.parts.push_back(q.candidate.parts.front());
      both.parameters += q.candidate.parameters;
      promised.emplace_back(first.gain + q.gain, std::move(both));
    }
  }
  std::stable_sort(promised.begin(), promised.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Explanation> ranked;
  std::set<std::set<std::string>> tried;
  for (const auto& [gain, pair] : promised)
    if (static_cast<int>(ranked.size()) < kPairs &&
        tried.insert({keyOf(pair.parts.front()), keyOf(pair.parts.back())}).second)
      ranked.push_back(fitted(pair));
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const Explanation& a, const Explanation& b) { return a.gain > b.gain; });
  return ranked;
}

void TraceSearch::settleAll() {
  for (int round = 0; round < 2; ++round) {
    model_ = fit(model_, 12, solved_).model;
    refresh();
  }
}

void TraceSearch::accept(const Candidate& candidate) {
  part_count_.push_back(candidate.parts.size());
  model_ = withCandidate(model_, candidate);
  settleAll();
}

std::size_t TraceSearch::firstPart(std::size_t k) const {
  return std::accumulate(part_count_.begin(), part_count_.begin() + static_cast<long>(k), given_effects_);
}

void TraceSearch::setModel(const RefinedModel& model) {
  model_ = model;
  level_ = predictRows(model_, trial_, solved_);
  residual_ = trial_.measured - level_;
  white_ = whitening_.apply(residual_);
}

void TraceSearch::leaveOut(std::size_t k) {
  const std::size_t first = firstPart(k);
  const auto begin = model_.effects.begin() + static_cast<long>(first);
  model_.effects.erase(begin, begin + static_cast<long>(part_count_[k]));
  part_count_.erase(part_count_.begin() + static_cast<long>(k));
  SolvedContacts solved = solved_;
  setModel(fit(model_, 12, solved).model);
}

double TraceSearch::gainOf(std::size_t k) {
  TraceSearch without = *this;
  without.leaveOut(k);
  return scoreOf(model_) - without.scoreOf(without.model_);
}

void TraceSearch::thin(std::size_t k) {
  const std::size_t first = firstPart(k);
  double score = scoreOf(model_);
  for (std::size_t part = part_count_[k]; part-- > 0 && part_count_[k] > 1;) {
    RefinedModel without = model_;
    without.effects.erase(without.effects.begin() + static_cast<long>(first + part));
    SolvedContacts solved = solved_;
    without = fit(without, 12, solved).model;
    const double now = scoreOf(without);
    if (now < score) continue;
    score = now;
    --part_count_[k];
    setModel(without);
  }
  settleAll();
}

std::vector<Effect> TraceSearch::parts(std::size_t k) const {
  const std::size_t first = firstPart(k);
  const auto begin = model_.effects.begin() + static_cast<long>(first);
  return {begin, begin + static_cast<long>(part_count_[k])};
}

void TraceSearch::refineCurves() {
  bool refined = false;
  for (std::size_t k = 0; k < model_.effects.size(); ++k) {
    if (!model_.effects[k].empirical() || model_.effects[k].knots.size() < 3) continue;
    const Eigen::VectorXd x = covariateValues(trial_, model_.effects[k].covariate, sinkages());
    double score = scoreOf(model_);
    for (const int most : {9, 13}) {
      const Effect coarse = model_.effects[k];
      const auto knots = quantileKnots(x, std::min(most, trial_.rows() / 10));
      if (knots.size() <= coarse.knots.size()) continue;
      RefinedModel finer = model_;
      finer.effects[k].knots = knots;
      finer.effects[k].parameters.clear();
      const NaturalSpline curve{coarse.knots, coarse.parameters};
      for (const double knot : knots) finer.effects[k].parameters.push_back(curve(knot));
      SolvedContacts solved = solved_;
      finer = fit(finer, 8, solved).model;
      const double now = scoreOf(finer);
      if (now <= score) continue;
      score = now;
      setModel(finer);
      refined = true;
    }
  }
  if (refined) refresh();
}

}  // namespace talus::terramech
