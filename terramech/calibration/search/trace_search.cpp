#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <set>
#include <string>
#include <string_view>

#include <talus/terramech/calibration.hpp>
#include <talus/terramech/calibration/fit/model_fit.hpp>
#include <talus/terramech/calibration/search/trace_search.hpp>

namespace talus::terramech {
namespace {

std::string keyOf(const Effect& e) {
  return e.name + '|' + e.covariate + '|' + (e.empirical() ? name(e.channel) : "") + '|' + e.only_value;
}

/// True if the model contains a form of the candidate. A form that is in the model twice would be one cause.
bool shares(const RefinedModel& model, const Candidate& candidate) {
  return std::any_of(candidate.parts.begin(), candidate.parts.end(), [&](const Effect& part) {
    return std::any_of(model.effects.begin(), model.effects.end(),
                       [&](const Effect& e) { return keyOf(e) == keyOf(part); });
  });
}

}  // namespace

TraceSearch::TraceSearch(const RefinedModel& base, const Trial& trial, const TraceOptions& options,
                         std::function<bool(double)> go_on)
    : options_(options),
      go_on_(std::move(go_on)),
      fit_(base, trial, options.fit_soil, go_on_),
      given_effects_(base.effects.size()) {}

GainDistribution TraceSearch::distributionOf(const std::vector<Candidate>& candidates, int draws) const {
  const CalibratedRows& rows = fit_.rows();
  const Eigen::VectorXd sinkage_m = rows.sinkages_m();
  SolvedContacts solved = fit_.solved();
  const NullModel null = fit_.standing(model(), rows.residual(), solved);
  const ModelOnRows here{model(), rows.trial(), rows.whitening(), rows.level(), sinkage_m, fit_.solved()};
  GainDistribution found = gainDistribution(
      null, {candidates.size(), [&](std::size_t k) { return contenderOf(candidates[k], here); }}, draws,
      options_.seed, go_on_);
  found.further_questions = furtherQuestions(rows.trial());
  return found;
}

std::vector<double> TraceSearch::gainsOf(const std::vector<Candidate>& candidates) {
  std::vector<double> gains = distributionOf(candidates, 0).gain;
  for (std::size_t k = 0; k < gains.size(); ++k) gains[k] -= candidates[k].logPrior();
  return gains;
}

TraceSearch::Screening TraceSearch::screen(int draws) {
  const Trial& trial = fit_.rows().trial();
  const Eigen::VectorXd sinkage_m = fit_.rows().sinkages_m();
  std::vector<Candidate> all;
  // On a drive slip, load, heading and time are correlated, and curves of these columns are interchangeable.
  // Only forms that predict every channel can be distinguished.
  const bool drive = !trial.moment.empty();
  for (Candidate& c : libraryCandidates(trial, sinkage_m))
    if (!shares(model(), c) && !(drive && c.family == "drift")) all.push_back(std::move(c));
  if (!drive)
    for (Candidate& c : empiricalCandidates(trial, model().effects)) all.push_back(std::move(c));
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

std::vector<Explanation> TraceSearch::fitBest(const std::vector<Promise>& promises) const {
  const double before = fit_.scoreOf(model());
  std::vector<Explanation> ranked;
  std::map<std::string, int> tried;
  int library = 0, empirical = 0;
  for (const Promise& p : promises) {
    int& count = p.candidate.empirical() ? empirical : library;
    if (!go_on_(0.0)) break;
    // The linearised gain of joint forms is unreliable; joint forms are always fitted.
    if (!p.candidate.empirical() && p.candidate.parts.size() > 1) {
      ranked.push_back(fitted(p.candidate, before));
      continue;
    }
    if (p.gain <= 0.0 || count >= (p.candidate.empirical() ? options_.fits / 2 : options_.fits)) continue;
    if (++tried[keyOf(p.candidate.parts.front())] > 2) continue;
    ++count;
    ranked.push_back(fitted(p.candidate, before));
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const Explanation& a, const Explanation& b) { return a.gain > b.gain; });
  return ranked;
}

Explanation TraceSearch::fitted(const Candidate& candidate) const {
  return fitted(candidate, fit_.scoreOf(model()));
}

Explanation TraceSearch::fitted(const Candidate& candidate, double before) const {
  SolvedContacts solved = fit_.solved();
  const Fit found = fit_.fit(withCandidate(model(), candidate),
                             candidate.parts.size() > 2   ? 30
                             : candidate.parts.size() > 1 ? 15
                                                          : 10,
                             solved);
  Explanation e;
  e.candidate = candidate;
  for (std::size_t k = 0; k < candidate.parts.size(); ++k)
    e.candidate.parts[k] = found.model.effects[model().effects.size() + k];
  e.chi2_gain = chi2() - found.chi2 - found.prior_chi2;
  e.gain = fit_.scoreOf(found.model) - before + candidate.logPrior();  // (T35)
  return e;
}

RefinedModel TraceSearch::modelWith(const Candidate& candidate) const {
  TrialFit other = fit_;
  other.setModel(withCandidate(model(), candidate));
  other.finish(true);
  return other.model();
}

bool TraceSearch::dependsOn(const RefinedModel& model, const std::string& column) const {
  const Trial& trial = fit_.rows().trial();
  if (column == "sinkage_m" ||
      std::find(trial.covariates.begin(), trial.covariates.end(), column) == trial.covariates.end())
    return true;
  Trial exchanged = trial;
  const std::size_t rows = trial.states.size();
  for (std::size_t row = 0; row < rows; ++row)
    exchanged.states[row].setCovariate(column, trial.states[(row + rows / 2) % rows].covariate(column));
  SolvedContacts solved, solved_exchanged;
  const Eigen::VectorXd moved = fit_.rows().whitening().marginal(trial.measured.array().isFinite().select(
      predictRows(model, exchanged, solved_exchanged) - predictRows(model, trial, solved), 0.0));
  return 0.5 * moved.squaredNorm() > closeGain(options_);  // (T46)
}

void TraceSearch::settleAll() {
  fit_.settle(model());
}

void TraceSearch::accept(const Candidate& candidate) {
  if (candidate.empirical())
    units_.push_back({candidate.parts.size(), candidate.logPrior()});
  else
    for (const Effect& part : candidate.parts) units_.push_back({1, formOf(part).logPrior()});
  fit_.settle(withCandidate(model(), candidate));
}

std::size_t TraceSearch::firstPart(std::size_t k) const {
  return std::accumulate(units_.begin(), units_.begin() + static_cast<long>(k), given_effects_,
                         [](std::size_t sum, const Unit& unit) { return sum + unit.parts; });
}

void TraceSearch::leaveOut(std::size_t k) {
  RefinedModel without = model();
  const auto begin = without.effects.begin() + static_cast<long>(firstPart(k));
  without.effects.erase(begin, begin + static_cast<long>(units_[k].parts));
  units_.erase(units_.begin() + static_cast<long>(k));
  fit_.setModel(fit_.fitted(without, 12));
}

double TraceSearch::gainOf(std::size_t k) const {
  TraceSearch without = *this;
  without.leaveOut(k);
  return gainOver(without, k);
}

double TraceSearch::gainOver(const TraceSearch& without, std::size_t k) const {
  return fit_.scoreOf(model()) - without.fit_.scoreOf(without.model()) + units_[k].log_prior;
}

std::vector<Effect> TraceSearch::parts(std::size_t k) const {
  const auto begin = model().effects.begin() + static_cast<long>(firstPart(k));
  return {begin, begin + static_cast<long>(units_[k].parts)};
}

void TraceSearch::describe(std::vector<TracedEffect>& effects, const Eigen::MatrixXd& covariance) const {
  std::size_t at = given_effects_;
  for (std::size_t k = 0; k < effects.size(); ++k) {
    TracedEffect& effect = effects[k];
    effect.channel = fit_.strongest(at, units_[k].parts);
    for (Effect& part : effect.chosen.candidate.parts) part = model().effects[at++];
    effect.parameter_std.clear();
    for (std::size_t j = 0; j < model().fitted.size(); ++j) {
      const int e = model().fitted[j].effect;
      if (e >= static_cast<int>(at - units_[k].parts) && e < static_cast<int>(at))
        effect.parameter_std.push_back(
            std::sqrt(std::max(0.0, covariance(static_cast<long>(j), static_cast<long>(j)))));
    }
  }
}

void TraceSearch::finish(TraceResult& result) {
  // Without effects the refined model is the base, which needs no further fit.
  const Eigen::MatrixXd covariance = fit_.finish(!result.effects.empty());
  describe(result.effects, covariance);
  result.refined = model();
  result.trial = fit_.rows().trial();
  const Trial measured = asMeasured(result.trial);
  result.base_rmse = rmseOf(result.base, measured);
  result.refined_rmse = rmseOf(result.refined, measured);
  result.noise_floor = fit_.noiseFloor(model().noise);
  SensorNoise declared = model().noise;
  result.strained = strainedSensors(result.trial, fit_.rows().level(), model().stated, declared);
  result.declared_floor = fit_.noiseFloor(declared);
  result.shared = sharedError();
}

namespace {

/// Returns true if two effects are the same cause: the same column, and curves or forms of one family. Drifts
/// of one column are the same cause if they differ in their time course only.
bool isOneCause(const Effect& other, const Effect& own) {
  const Candidate a{{other}, "", 0}, b{{own}, "", 0};
  if (a.covariate() != b.covariate()) return false;
  const EffectForm *of_other = findEffect(other.name), *of_own = findEffect(own.name);
  if (!of_other || !of_own) return true;
  return std::string_view(of_other->family) == of_own->family &&
         (std::string_view(of_own->family) != "drift" || other.name.starts_with(own.name) ||
          own.name.starts_with(other.name));
}

/// Returns true if the candidate includes the constant sensor offset `own`: a curve or a drift of the same
/// sensor.
bool holdsOffset(const Candidate& other, const Effect& own) {
  const EffectForm* form = findEffect(own.name);
  return form && form->of_sensor && own.parameters.size() == 1 &&
         other.parts.front().channel == own.channel && (other.empirical() || other.family == "drift");
}

/// Returns true if the candidate is another cause than the effects `own`. A product represents both of its
/// columns; product candidates are therefore rivals of products only.
bool isOther(const Candidate& other, const std::vector<Effect>& own) {
  if (isProduct(other.covariate()) && !isProduct(own.front().covariate)) return false;
  return std::none_of(own.begin(), own.end(), [&](const Effect& part) {
    return isOneCause(other.parts.front(), part) || holdsOffset(other, part);
  });
}

}  // namespace

Replacements replacementsOf(const TraceSearch& search, std::size_t k) {
  Replacements in{search, {}};
  in.without.leaveOut(k);
  in.ranked = in.without.fitBest(in.without.screen(0).promises);
  return in;
}

std::vector<RivalCause> rivalsOf(const TraceSearch& search, const std::vector<Explanation>& ranked,
                                 const std::vector<Effect>& own) {
  constexpr std::size_t kRivals = 3;
  std::vector<RivalCause> rivals;
  std::set<std::string> seen;
  for (const Explanation& e : ranked) {
    const Candidate& c = e.candidate;
    if (rivals.size() == kRivals || e.gain <= 0.0) break;
    const bool together = c.parts.size() > 1 && !c.empirical();
    if (!own.empty() && (together || !isOther(c, own))) continue;
    if (!seen.insert(c.parts.front().name + '|' + c.covariate() + '|' + c.parts.front().only_value).second)
      continue;
    RefinedModel model = search.modelWith(c);
    // Skips curves that are constant over their column.
    if (search.dependsOn(model, c.covariate()))
      rivals.push_back({own.empty() ? "" : own.front().name, e, std::move(model)});
  }
  return rivals;
}

ChannelErrors rmseOf(const RefinedModel& model, const Trial& trial) {
  SolvedContacts solved;
  return rmseOf(predictRows(model, trial, solved), trial);
}

ChannelErrors rmseOf(const Eigen::MatrixXd& predicted, const Trial& trial) {
  const Eigen::MatrixXd residual = trial.measured - predicted;
  ChannelErrors errors{};
  for (int c = 0; c < kChannels; ++c) {
    double sum = 0.0;
    int count = 0;
    for (double r : residual.col(c))
      if (std::isfinite(r)) sum += r * r, ++count;
    errors[static_cast<std::size_t>(c)] = count ? std::sqrt(sum / count) : std::nan("");
  }
  return errors;
}

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
  const auto isDropped = [&](const std::string& name) {
    return std::ranges::count(screened.dropped, name) > 0;
  };
  std::erase_if(screened.covariates, isDropped);
  std::erase_if(screened.groupings, isDropped);
  for (WheelState& s : screened.states) {
    std::erase_if(s.extra, [&](const auto& value) { return isDropped(value.first); });
    std::erase_if(s.group, [&](const auto& label) { return isDropped(label.first); });
  }
  return screened;
}

}  // namespace talus::terramech
