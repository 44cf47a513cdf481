#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <string>

#include <talus/terramech/calibration/fit/effect_candidates.hpp>
#include <talus/terramech/calibration/held_out/end_levels.hpp>
#include <talus/terramech/calibration/held_out/held_out.hpp>
#include <talus/terramech/calibration/held_out/model_scope.hpp>
#include <talus/terramech/calibration/noise/folds.hpp>
#include <talus/terramech/calibration/search/column_screening.hpp>
#include <talus/terramech/calibration/search/rival_causes.hpp>
#include <talus/terramech/calibration/search/trace_search.hpp>
#include <talus/terramech/calibration/table/closure_offset.hpp>
#include <talus/terramech/calibration/trace/residual_trace.hpp>
#include <talus/terramech/mobility/rut.hpp>

namespace talus::terramech {
namespace {

Channel strongest(const Explanation& e) {
  const auto most = std::max_element(e.by_channel.begin(), e.by_channel.end());
  return static_cast<Channel>(most - e.by_channel.begin());
}

TracedEffect traced(const Explanation& chosen, double p_value) {
  return {.chosen = chosen, .channel = strongest(chosen), .parameter_std = {}, .p_value = p_value};
}

/// Adds the offset of a force sensor in one group of rows (findClosureOffset()), unless the offset increases
/// held-out errors. The effect is kept if it changes predictions, even with a small gain: a soil fitted to
/// all rows absorbs most of the offset.
bool correctOffset(TraceSearch& search, const Trial& trial, std::uint64_t seed,
                   std::vector<TracedEffect>& effects) {
  const auto found = findClosureOffset(trial, seed);
  if (!found) return false;
  Effect tilt;
  tilt.name = "load_cell_tilt";
  tilt.covariate = found->column;
  tilt.channel = Channel::DrawbarPull;
  tilt.parameters = {std::asin(std::clamp(found->offset, -0.3, 0.3))};
  search.trust(Estimate{tilt.parameters[0], found->std});
  tilt.only_column = found->column;
  tilt.only_value = found->value;
  TracedEffect effect;
  effect.chosen.candidate = {{tilt}, "load_cell_tilt", 1};
  effect.p_value = found->p_value;
  if (!accepted({search.fitted(effect.chosen.candidate)}, 0.0)) {
    search.trust(std::nullopt);
    return false;
  }
  search.accept(effect.chosen.candidate);
  effects.push_back(effect);
  return true;
}

/// Accepted effects, in the order of acceptance.
struct Path {
  TraceSearch search;
  double close;  ///< closeGain()
  std::vector<TracedEffect> effects{};
  std::vector<Explanation> rejected{};
  std::vector<Promise> first{}, last{};
  double threshold = 0.0;
  GainDistribution noise{};
  std::size_t pinned = 0;  ///< number of leading effects that only dropIdle() removes
};

/// Accepts the first of the ranked explanations.
void take(Path& path, const std::vector<Explanation>& ranked, double p_value) {
  path.search.accept(ranked.front().candidate);
  path.effects.push_back(traced(ranked.front(), p_value));
  TracedEffect& taken = path.effects.back();
  if (taken.chosen.candidate.parts.size() < 2) return;
  path.search.thin(path.effects.size() - 1, path.close);
  taken.chosen.candidate.parts = path.search.parts(path.effects.size() - 1);
}

/// Removes, from the last on, the effects whose gain relative to the model without the effect is at most that
/// of noise.
void check(Path& path) {
  for (std::size_t k = path.effects.size(); k-- > path.pinned;) {
    if (path.search.gainOf(k) > path.threshold) continue;  // (T44)
    path.search.leaveOut(k);
    path.search.settleAll();
    path.effects.erase(path.effects.begin() + static_cast<long>(k));
  }
}

/// Removes effects without influence on the predictions, and parts of joint forms whose gain is at most that
/// of noise.
void dropIdle(Path& path) {
  for (std::size_t k = path.pinned; k < path.effects.size(); ++k) {
    TracedEffect& effect = path.effects[k];
    if (effect.chosen.candidate.parts.size() < 2 || effect.chosen.candidate.empirical()) continue;
    path.search.thin(k, path.threshold);
    path.search.dropIdleParts(k);
    effect.chosen.candidate.parts = path.search.parts(k);
  }
  check(path);
  for (std::size_t k = path.effects.size(); k-- > 0;) {
    if (path.search.acts(k)) continue;
    path.search.leaveOut(k);
    path.effects.erase(path.effects.begin() + static_cast<long>(k));
    if (k >= path.pinned) continue;
    path.pinned = 0;
    path.search.trust(std::nullopt);
  }
}

/// Searches alternative causes for each effect.
void findRivals(const Path& path, TraceResult& result, const std::function<bool(double)>& go_on) {
  for (std::size_t k = path.pinned; k < result.effects.size() && go_on(0.0); ++k) {
    TracedEffect& effect = result.effects[k];
    const double least = path.search.gainOf(k) - path.close;
    for (RivalCause& rival : rivalsOf(path.search, k)) {
      if (rival.explanation.gain >= least) effect.equal.push_back(rival.explanation);  // (T46)
      result.rivals.push_back(std::move(rival));
    }
  }
  if (result.effects.empty()) result.rivals = rivalsOf(path.search, result.rejected);
}

/// Returns the accepted effects as a set, independent of their order.
std::multiset<std::string> takenIn(const Path& path) {
  std::multiset<std::string> all;
  for (const TracedEffect& e : path.effects)
    for (const Effect& part : e.chosen.candidate.parts)
      all.insert(part.name + '|' + part.covariate + '|' + name(part.channel) + '|' + part.only_value);
  return all;
}

/// Accepts the best explanation repeatedly, until no gain exceeds that of noise or a set of effects recurs
/// (endless loop).
void grow(Path& path, const Trial& trial, const TraceOptions& options,
          const std::function<bool(double)>& go_on) {
  std::set<std::multiset<std::string>> seen;
  while (go_on(0.0) && static_cast<int>(path.effects.size()) < options.max_effects &&
         seen.insert(takenIn(path)).second) {
    const auto screening = path.search.screen(options.draws);
    if (path.first.empty()) path.first = screening.promises;
    path.last = screening.promises;
    path.threshold = screening.threshold;
    path.noise = screening.noise;
    path.rejected = path.search.fitBest(screening.promises);
    preferSimple(path.rejected, screening.threshold, path.close);
    const double least =
        0.5 * options.least_share * static_cast<double>(trial.measured.array().isFinite().count());
    if (!accepted(path.rejected, std::max(screening.threshold, least))) return;  // (T42)
    take(path, path.rejected, screening.noise.pValue(path.rejected.front().gain));
    path.rejected.erase(path.rejected.begin());
    check(path);
  }
}

/// Splits effects found together into single effects, each with the p-value of its own gain.
std::vector<TracedEffect> apart(const Path& path, const std::vector<TracedEffect>& effects) {
  std::vector<TracedEffect> all;
  for (std::size_t k = 0; k < effects.size(); ++k) {
    const TracedEffect& e = effects[k];
    if (e.chosen.candidate.empirical() || e.chosen.candidate.parts.size() == 1) {
      all.push_back(e);
      continue;
    }
    std::size_t at = 0;
    for (std::size_t own = 0; own < e.chosen.candidate.parts.size(); ++own) {
      const Effect& part = e.chosen.candidate.parts[own];
      TracedEffect one = e;
      one.p_value = path.noise.pValue(path.search.gainOfPart(k, own));
      const EffectForm& form = *findEffect(part.name);
      one.chosen.candidate = {{part}, form.family, 0};
      one.channel = form.channel;
      one.parameter_std.clear();
      for (const EffectParameter& p : form.parameters) {
        if (!p.fitted || at >= e.parameter_std.size()) continue;
        ++one.chosen.candidate.parameters;
        one.parameter_std.push_back(e.parameter_std[at++]);
      }
      all.push_back(std::move(one));
    }
  }
  return all;
}

/// Prior information on a rover's own drive. The pull follows from the slope and has the error of an
/// inclinometer, 0.3 degrees unless stated (ours). Wheels behind another wheel drive in a rut (rut.hpp),
/// whose stiffness is fitted.
RefinedModel asDriven(RefinedModel model, const Trial& trial) {
  constexpr double kSlopeError_rad = 0.005;
  if (trial.moment.empty()) return model;
  double load_N = 0.0;
  for (const double w : trial.load_N) load_N += w / trial.rows();
  if (!model.stated.drawbar_pull_N) model.stated.drawbar_pull_N = kSlopeError_rad * load_N;
  const auto& columns = trial.covariates;
  const bool has_passes = std::find(columns.begin(), columns.end(), "pass_index") != columns.end();
  if (!has_passes || knowsPasses(model.effects)) return model;
  model.effects.push_back({.name = "multipass_reload",
                           .covariate = "pass_index",
                           .channel = Channel::Sinkage,
                           .parameters = {kReloadStiffness - 1.0, 1.0}});
  return model;
}

}  // namespace

namespace {

/// Rank of a kind of candidate by the causes that the kind can absorb: a drift includes a constant, a curve
/// includes a drift, and a product represents both of its columns.
int freedom(const Candidate& candidate) {
  return isProduct(candidate.covariate()) ? 3
         : candidate.empirical()          ? 2
         : candidate.family == "drift"    ? 1
                                          : 0;
}

/// True if `a` is of a kind with less freedom, or a form of the same family with fewer parameters.
bool isSimpler(const Candidate& a, const Candidate& b) {
  if (freedom(a) != freedom(b)) return freedom(a) < freedom(b);
  return !a.empirical() && a.family == b.family && a.parts.size() == b.parts.size() &&
         a.parameters < b.parameters;
}

}  // namespace

void preferSimple(std::vector<Explanation>& ranked, double threshold, double close) {
  auto first = ranked.begin();
  for (auto e = ranked.begin(); e != ranked.end(); ++e)
    if (e->gain > threshold && e->gain > ranked.front().gain - close &&  // (T43)
        isSimpler(e->candidate, first->candidate))
      first = e;
  if (first != ranked.end()) std::rotate(ranked.begin(), first, first + 1);
}

bool accepted(const std::vector<Explanation>& ranked, double threshold) {
  return !ranked.empty() && ranked.front().gain > threshold;
}

namespace {

/// Progress of work in an unknown number of rounds: each round counts as half of the remaining share.
class Rounds {
 public:
  double at(double share) {
    if (share > 0.0 && share < last_) left_ *= 0.5;
    last_ = share > 0.0 ? share : last_;
    return 1.0 - left_ * (1.0 - 0.5 * last_);
  }

 private:
  double left_ = 1.0, last_ = 0.0;
};

TraceResult searched(const RefinedModel& base, const Trial& trial, const TraceOptions& given,
                     const ProgressMonitor& watch) {
  TraceOptions options = given;
  if (!trial.moment.empty()) {  // errors of slip and slope are not normal: docs/effects.md
    options.max_effects = 1;
    options.least_share = 0.06;
  }
  Rounds rounds;
  const auto go_on = [&](double share) {
    watch.report(0.95 * rounds.at(share));
    return !watch.stopped();
  };
  const Trial screened = screenColumns(asDriven(base, trial), trial, options, go_on);
  Path path{TraceSearch{asDriven(base, trial), screened, options, go_on}, closeGain(options)};
  TraceResult result;
  result.given = base.soil;
  result.base = path.search.model();
  result.base_shared = path.search.sharedError();
  if (options.fit_soil && trial.moment.empty())
    path.pinned = correctOffset(path.search, screened, options.seed, path.effects) ? 1 : 0;
  grow(path, trial, options, go_on);
  dropIdle(path);
  result.rejected = path.rejected;
  result.first_promises = path.first;
  result.last_promises = path.last;
  result.threshold = path.threshold;
  result.effects = path.effects;
  path.search.finish(result);
  result.held_out = holdOut(result, options, foldsOf(result.trial));
  findRivals(path, result, go_on);
  result.ends = endLevels(result, options, watch);
  boundEffects(result.refined, result.trial, result.ends);
  result.scope = scopeOf(result);
  keepConfirmed(result.held_out, result.scope);
  keepConfirmed(result.ends, result.noise_floor);
  result.refined_rmse = rmseOf(predictInScope(result, asMeasured(result.trial)), result.trial);
  result.effects = apart(path, result.effects);
  return result;
}

}  // namespace

TraceResult traceResiduals(const RefinedModel& base, const Trial& trial, const TraceOptions& options,
                           const ProgressMonitor& watch) {
  watch.report(0.0);
  std::vector<char> sample = rowSample(trial, options.most_rows, options.seed);
  const bool all = std::find(sample.begin(), sample.end(), 0) == sample.end();
  TraceResult result = searched(base, all ? trial : subset(trial, sample), options, watch);
  if (!all) {
    for (char& row : sample) row = !row;
    const Trial rest = subset(trial, sample);
    result.unsearched = {rest.rows(), rmseOf(result.base, rest), rmseOf(predictInScope(result, rest), rest)};
  }
  watch.report(1.0);
  return result;
}

}  // namespace talus::terramech
