#include <algorithm>
#include <cmath>

#include <talus/terramech/mobility/rut.hpp>
#include <talus/terramech/trace/closure_offset.hpp>
#include <talus/terramech/trace/residual_trace.hpp>
#include <talus/terramech/trace/trace_search.hpp>

namespace talus::terramech {
namespace {

/// Above this p-value known forms are taken to have left nothing.
constexpr double kDoubt = 0.05;

double smallest(const std::vector<CovariateTest>& tests) {
  double p = 1.0;
  for (const CovariateTest& t : tests) p = std::min(p, t.p_value);
  return p;
}

/// The family-wise p-value of the questions that the chosen effect answers.
double pValueOf(const std::vector<CovariateTest>& tests, const Candidate& chosen) {
  double p = 1.0;
  for (const CovariateTest& t : tests)
    if (t.channel < 0 ? t.covariate == chosen.parts.front().name : t.covariate == chosen.covariate())
      p = std::min(p, t.p_value);
  return p;
}

bool hasCurve(const Candidate& candidate) {
  return std::any_of(candidate.parts.begin(), candidate.parts.end(),
                     [](const Effect& e) { return e.empirical(); });
}

/// A curve in slip or load, which are measured with errors of their own; or in a speed where both speeds are
/// at hand, since together they tell the error of the slip.
bool inNoisyInput(const Explanation& e, const Trial& trial) {
  const std::string& covariate = e.candidate.covariate();
  const auto& known = trial.covariates;
  const auto has = [&](const char* name) {
    return std::find(known.begin(), known.end(), name) != known.end();
  };
  const bool speed = covariate == "speed_mps" || covariate == "rim_speed_mps";
  const bool tells_slip = speed && has("speed_mps") && has("rim_speed_mps");
  return e.candidate.empirical() && (covariate == "slip" || covariate == "load_N" || tells_slip);
}

/// Whether a further effect carries a share of the residual worth a name: what the form of the first leaves
/// over is often certain and tiny. A curve must carry more than a known form, and one in a noisy input more
/// again, since its own errors, where they are not as normal as supposed, look like one. The shares come from
/// worlds made for development.
bool matters(const Explanation& e, const Trial& trial) {
  const auto values = static_cast<double>(trial.measured.array().isFinite().count());
  return e.chi2_gain > (inNoisyInput(e, trial) ? 0.5 : hasCurve(e.candidate) ? 0.1 : 0.06) * values;
}

Channel strongest(const Explanation& e) {
  const auto most = std::max_element(e.by_channel.begin(), e.by_channel.end());
  return static_cast<Channel>(most - e.by_channel.begin());
}

bool same(const Candidate& a, const Candidate& b) {
  return a.parts.size() == b.parts.size() && a.parts.front().name == b.parts.front().name &&
         a.covariate() == b.covariate() && a.parts.front().only_value == b.parts.front().only_value;
}

// Explanations by the same form from several starts count once.
TracedEffect traced(const std::vector<Explanation>& ranked, std::size_t best, double p_value) {
  TracedEffect effect;
  effect.chosen = ranked[best];
  effect.channel = strongest(ranked[best]);
  effect.p_value = p_value;
  for (const Explanation& e : ranked) {
    const auto like = [&e](const Explanation& other) { return same(e.candidate, other.candidate); };
    if (e.score > ranked[best].score - 6.0 && effect.alternatives.size() < 6 && !like(effect.chosen) &&
        std::none_of(effect.alternatives.begin(), effect.alternatives.end(), like))
      effect.alternatives.push_back(e);
  }
  return effect;
}

/// How often something is tried again whose cost grows with rows and parameters: four times and more in small
/// tables, once in large ones, so that 700 rows take no more than a few times what 200 do.
int attempts(const TraceSearch& search) {
  return static_cast<int>(std::clamp(16'000.0 / search.work(), 1.0, 6.0));
}

/// Looks at every effect again, the newest first, until none is better replaced.
void reconsider(TraceSearch& search, std::vector<TracedEffect>& effects, std::size_t pinned) {
  int replacements = 0;
  const int most = std::min(4, attempts(search));
  for (std::size_t looked = 0; looked + pinned < effects.size();) {
    const std::size_t k = effects.size() - 1 - looked;
    const auto ranked = search.rivals(k);
    const auto best = search.choose(ranked);
    ++looked;
    if (!best) {  // the others, fitted again, leave nothing for it
      search.drop(k);
      effects.erase(effects.begin() + static_cast<long>(k));
      looked = 0;
      if (++replacements > most) return;
      continue;
    }
    TracedEffect again = traced(ranked, *best, effects[k].p_value);
    if (same(ranked[*best].candidate, effects[k].chosen.candidate)) {
      effects[k] = again;
      continue;
    }
    if (++replacements > most) return;
    search.replace(k, ranked[*best].candidate);
    effects.erase(effects.begin() + static_cast<long>(k));
    effects.push_back(again);
    looked = 0;
  }
}

/// Puts in the offset of a force sensor that its group's own torque and sinkage betray; a soil fitted to all
/// rows would hide it. It stays: the search sees only what the soil left of it.
bool correctOffset(TraceSearch& search, const Trial& trial, std::uint64_t seed,
                   std::vector<TracedEffect>& effects) {
  const auto found = findClosureOffset(trial, seed);
  if (!found) return false;
  Effect tilt;
  tilt.name = "load_cell_tilt";
  tilt.covariate = found->column;
  tilt.channel = Channel::DrawbarPull;
  tilt.parameters = {std::asin(std::clamp(found->offset, -0.3, 0.3))};
  search.trust({tilt.parameters[0], found->std});
  tilt.only_column = found->column;
  tilt.only_value = found->value;
  TracedEffect effect;
  effect.chosen.candidate = {{tilt}, "load_cell_tilt", 1};
  effect.p_value = found->p_value;
  search.accept(effect.chosen.candidate);
  effects.push_back(effect);
  return true;
}

/// One order in which effects were taken in.
struct Path {
  TraceSearch search;
  std::vector<TracedEffect> effects;
  std::vector<Explanation> rejected;
  std::vector<CovariateTest> first_tests, last_tests{};
  std::size_t pinned = 0;  ///< effects at the front that stay
  int barren = 0;          ///< times that an effect came and another went
};

/// Takes in what explains the residuals best until nothing is left to explain.
void grow(Path& path, const Trial& trial, const TraceOptions& options, const ProgressMonitor& watch) {
  while (!watch.stopped()) {
    const auto count = static_cast<int>(path.effects.size());
    watch.report(count / (options.max_effects + 1.0));
    auto screened = path.search.screen();
    const auto tests = path.search.test(screened);
    if (path.first_tests.empty()) path.first_tests = tests;
    path.last_tests = tests;
    if (smallest(tests) > options.significance || count >= options.max_effects) break;
    // Only what answers a question that noise does not.
    const auto answers = [&](const auto& e) { return pValueOf(tests, e.candidate) <= options.significance; };
    std::stable_partition(screened.begin(), screened.end(), answers);
    auto ranked = path.search.fitBest(screened);
    const auto rest = std::stable_partition(ranked.begin(), ranked.end(), answers);
    auto best = path.search.choose({ranked.begin(), rest});
    if (!best && count > 0) best = path.search.choose(ranked);  // what is left mixes with what is in
    const bool further = !path.effects.empty() || (best && inNoisyInput(ranked[*best], trial));
    if (best && further && !matters(ranked[*best], trial)) best.reset();
    path.rejected = ranked;
    if (!best) break;
    path.rejected.erase(path.rejected.begin() + static_cast<long>(*best));
    path.search.accept(ranked[*best].candidate);
    path.effects.push_back(traced(ranked, *best, pValueOf(tests, ranked[*best].candidate)));
    reconsider(path.search, path.effects, path.pinned);
    if (static_cast<int>(path.effects.size()) <= count && ++path.barren > 2) break;
  }
}

/// Whether a pair of known forms is the better account. Known forms are believed before a curve; in place of
/// known forms it must say more, and one more of them must carry what a further effect must.
bool isBetter(const Explanation& pair, const Explanation& present, std::size_t members, const Trial& trial) {
  if (pair.score < 2.0 || pair.in_sample < 2.0 || pair.spoils) return false;
  if (hasCurve(present.candidate)) return pair.score > present.score;
  Explanation further = pair;
  further.chi2_gain -= present.chi2_gain;
  return pair.score > present.score + 2.0 && (members > 1 || matters(further, trial));
}

/// Effects, and twos of them, for which a pair of known forms might stand: those with a curve, or any where
/// the last tests leave a doubt. Forms that came in together stay.
std::vector<std::vector<std::size_t>> replaceable(const Path& path) {
  const bool doubt = smallest(path.last_tests) <= kDoubt;
  std::vector<std::size_t> open;
  for (std::size_t k = path.pinned; k < path.effects.size(); ++k) {
    const Candidate& c = path.effects[k].chosen.candidate;
    if (c.empirical() || c.parts.size() == 1) open.push_back(k);
  }
  const auto curve = [&](std::size_t k) { return hasCurve(path.effects[k].chosen.candidate); };
  std::vector<std::vector<std::size_t>> choices;
  for (const std::size_t k : open)
    if (doubt || curve(k)) choices.push_back({k});
  for (std::size_t i = 0; open.size() == 2 && i < open.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (doubt || curve(open[i]) || curve(open[j])) choices.push_back({open[j], open[i]});
  return choices;
}

/// Tries two known forms in place of effects; true when something was replaced.
bool reconsiderPairs(Path& path, const Trial& trial) {
  int left = attempts(path.search);
  for (const auto& members : replaceable(path)) {
    if (left-- == 0) return false;
    Explanation present;
    const auto ranked = path.search.pairsInPlaceOf(members, present);
    const auto better = std::find_if(ranked.begin(), ranked.end(), [&](const Explanation& e) {
      return isBetter(e, present, members.size(), trial);
    });
    if (better == ranked.end()) continue;
    path.search.replaceByPair(members, better->candidate);
    const double p_value = path.effects[members.front()].p_value;
    for (auto k = members.rbegin(); k != members.rend(); ++k)
      path.effects.erase(path.effects.begin() + static_cast<long>(*k));
    for (const Effect& part : better->candidate.parts) {
      TracedEffect effect;
      effect.chosen = *better;
      effect.chosen.candidate = {{part}, findEffect(part.name)->family, 0};
      effect.p_value = p_value;
      path.effects.push_back(effect);
    }
    return true;
  }
  return false;
}

double least(const Trial& trial) {
  return 0.1 * static_cast<double>(trial.measured.array().isFinite().count());
}

/// Takes out, last first, what beside the others carries nothing that matters; of forms that came together
/// each for itself.
void prune(Path& path, const Trial& trial) {
  for (std::size_t k = path.pinned; k < path.effects.size(); ++k) {
    Candidate& chosen = path.effects[k].chosen.candidate;
    if (chosen.empirical() || chosen.parts.size() == 1) continue;
    path.search.thin(k, least(trial));
    chosen.parts = path.search.parts(k);
  }
  for (std::size_t k = path.effects.size(); k-- > path.pinned && path.effects.size() > 1;) {
    TraceSearch without = path.search;
    const double before = without.chi2();
    without.leaveOut(k);
    Explanation gain = path.effects[k].chosen;
    gain.chi2_gain = without.chi2() - before;
    if (matters(gain, trial)) continue;
    path.search.drop(k);
    path.effects.erase(path.effects.begin() + static_cast<long>(k));
  }
}

/// Forms that were found together, each told for itself.
std::vector<TracedEffect> apart(const std::vector<TracedEffect>& effects) {
  std::vector<TracedEffect> all;
  for (const TracedEffect& e : effects) {
    if (e.chosen.candidate.empirical() || e.chosen.candidate.parts.size() == 1) {
      all.push_back(e);
      continue;
    }
    std::size_t at = 0;
    for (const Effect& part : e.chosen.candidate.parts) {
      TracedEffect one = e;
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

/// What is known of a rover's own drive beforehand. Its pull is known as its slope is: unless stated, to 0.3
/// degrees (an inclinometer's; ours). Wheels that follow another drive in its rut (rut.hpp); how stiff that
/// is is fitted.
RefinedModel asDriven(RefinedModel model, const Trial& trial) {
  constexpr double kSlopeError_rad = 0.005;
  if (trial.moment.empty()) return model;
  double load_N = 0.0;
  for (const double w : trial.load_N) load_N += w / trial.rows();
  if (!model.stated.drawbar_pull_N) model.stated.drawbar_pull_N = kSlopeError_rad * load_N;
  const auto& columns = trial.covariates;
  const bool told = std::find(columns.begin(), columns.end(), "pass_index") != columns.end();
  if (!told || knowsPasses(model.effects)) return model;
  model.effects.push_back({.name = "multipass_reload",
                           .covariate = "pass_index",
                           .channel = Channel::Sinkage,
                           .parameters = {kReloadStiffness - 1.0, 1.0}});
  return model;
}

}  // namespace

TraceResult traceResiduals(const RefinedModel& base, const Trial& trial, const TraceOptions& options,
                           const ProgressMonitor& watch) {
  Path best{TraceSearch{asDriven(base, trial), trial, options}, {}, {}, {}};
  TraceResult result;
  result.base = best.search.model();
  if (options.fit_soil && trial.moment.empty())
    best.pinned = correctOffset(best.search, trial, options.seed, best.effects) ? 1 : 0;
  grow(best, trial, options, watch);
  for (int round = 0;
       round < (attempts(best.search) > 2 ? 2 : 1) && !watch.stopped() && reconsiderPairs(best, trial);
       ++round) {
    reconsider(best.search, best.effects, best.pinned);
    best.barren = 0;
    grow(best, trial, options, watch);
  }
  prune(best, trial);
  best.search.refineCurves();
  result.first_tests = best.first_tests;
  result.effects = best.effects;
  result.rejected = best.rejected;
  result.last_tests = best.last_tests;
  best.search.finish(result);
  result.effects = apart(result.effects);
  watch.report(1.0);
  return result;
}

}  // namespace talus::terramech
