#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <string>

#include <talus/terramech/calibration.hpp>
#include <talus/terramech/calibration/fit/model_fit.hpp>
#include <talus/terramech/calibration/held_out/held_out.hpp>
#include <talus/terramech/calibration/noise/run_likelihood.hpp>
#include <talus/terramech/calibration/search/trace_search.hpp>
#include <talus/terramech/calibration/trace/residual_trace.hpp>
#include <talus/terramech/io/wheel_rows.hpp>
#include <talus/terramech/mobility/wheel_forces_table.hpp>
#include <talus/terramech/numerics/functions.hpp>
#include <talus/terramech/terramech_io.hpp>

namespace talus::terramech {

Telemetry readTraceTable(const TableFile& file) {
  Telemetry table = readTelemetry(file, {.required = {"load_N", "slip"}});
  leaveOutWithoutSlipAngle(table);
  return table;
}

TableTrace traceTable(const Telemetry& table, const TableTraceOptions& options,
                      const ProgressMonitor& watch) {
  const TraceInput input = traceInput(table, options.base, options.search);
  const ModelRows& rows = input.rows;
  TableTrace trace{.source = table.source,
                   .rejected = rows.rejected,
                   .result = traceResiduals(rows.model, rows.trial, input.options, watch)};
  if (watch.stopped()) return trace;
  trace.held_out = holdOutLevels(trace.result, input.options);
  trace.held_out.insert(trace.held_out.begin(), trace.result.held_out);
  trace.answer = answerOf(trace.result);
  trace.applies = applicability(trace.result, input.options);
  // No effect makes readings possible that no wheel on soil has.
  const TraceResult& r = trace.result;
  if (trace.answer.verdict == Verdict::Unexplained || !trace.applies.applies)
    if (const auto scale = likelyScale(r, trace.applies.possible ? r.refined : r.base, input.options))
      trace.applies = {.applies = false, .reason = scale->text()};
  if (!trace.applies.applies) {
    trace.answer.verdict = Verdict::Unexplained;
    trace.answer.inapplicable = trace.applies.reason;
  }
  trace.beyond_axle = rows.beyond_axle.rows();
  if (trace.beyond_axle > 0) trace.beyond_axle_rmse = rmseOf(trace.result.refined, rows.beyond_axle);
  return trace;
}

std::string TableTrace::modelText() const {
  return terramech::modelText(forPrediction(result), result.scope);
}

namespace {

/// State of the search: accepted effects, in the order of acceptance. Its objective is the score of the model
/// plus the logarithms of the candidates' priors, less the threshold for each accepted candidate.
struct Path {
  TraceSearch search;
  double close;  ///< closeGain()
  std::vector<TracedEffect> effects{};
  std::vector<Explanation> rejected{};
  std::vector<Promise> first{}, last{};
  double threshold = 0.0;
  GainDistribution noise{};
  std::set<std::multiset<std::string>> seen{};

  /// Returns the accepted effects as a set, independent of their order.
  std::multiset<std::string> taken() const {
    std::multiset<std::string> all;
    for (const TracedEffect& e : effects)
      for (const Effect& part : e.chosen.candidate.parts)
        all.insert(part.name + '|' + part.covariate + '|' + name(part.channel) + '|' + part.only_value);
    return all;
  }
};

/// Accepts an explanation. Forms that were found together become one effect each.
void take(Path& path, const Explanation& chosen) {
  path.search.accept(chosen.candidate);
  if (chosen.candidate.empirical()) return path.effects.push_back({.chosen = chosen});
  for (const Effect& part : chosen.candidate.parts) {
    Explanation one = chosen;
    one.candidate = formOf(part);
    path.effects.push_back({.chosen = one});
  }
}

void drop(Path& path, std::size_t k) {
  path.search.leaveOut(k);
  path.effects.erase(path.effects.begin() + static_cast<long>(k));
}

/// Removes the effect with the least gain beside the others, as long as this gain is at most that of noise.
void prune(Path& path) {
  while (!path.effects.empty()) {
    std::size_t least = 0;
    double gain = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < path.effects.size(); ++k)
      if (const double own = path.search.gainOf(k); own < gain) least = k, gain = own;
    if (gain > path.threshold) return;  // (T43)
    drop(path, least);
    path.search.settleAll();
  }
}

/// Accepts the best explanation repeatedly, until no gain exceeds that of noise or a set of effects recurs
/// (endless loop).
void grow(Path& path, const Trial& trial, const TraceOptions& options,
          const std::function<bool(double)>& go_on) {
  while (go_on(0.0) && static_cast<int>(path.effects.size()) < options.max_effects) {
    const auto screening = path.search.screen(options.draws);
    if (path.first.empty()) path.first = screening.promises;
    path.last = screening.promises;
    path.threshold = screening.threshold;
    path.noise = screening.noise;
    path.rejected = path.search.fitBest(screening.promises);
    const double least =
        0.5 * options.least_share * static_cast<double>(trial.measured.array().isFinite().count());
    if (!accepted(path.rejected, std::max(screening.threshold, least))) return;  // (T41)
    take(path, path.rejected.front());
    path.rejected.erase(path.rejected.begin());
    prune(path);
    if (!path.seen.insert(path.taken()).second) return;
  }
}

/// Candidates in the place of each effect.
using InPlace = std::map<std::size_t, Replacements>;

/// Exchanges effects in turn for candidates with a higher gain in their place, until no exchange of any effect
/// gains more. Returns true if the effects have changed; false also if a set of effects recurs.
bool exchange(Path& path, InPlace& in_place, const std::function<bool(double)>& go_on) {
  constexpr double kOfFit = 0.1;  // error of a fitted gain
  in_place.clear();
  bool changed = false;
  for (std::size_t k = 0; in_place.size() < path.effects.size() && go_on(0.0);) {
    if (k >= path.effects.size()) k = 0;
    Replacements in = replacementsOf(path.search, k);
    const bool several = !in.ranked.empty() && !in.ranked.front().candidate.empirical() &&
                         in.ranked.front().candidate.parts.size() > 1;
    const double own = path.search.gainOver(in.without, k);
    if (!accepted(in.ranked, own + (several ? path.threshold : kOfFit))) {  // (T44)
      in_place.insert_or_assign(k++, std::move(in));
      continue;
    }
    in_place.clear();
    drop(path, k);
    take(path, in.ranked.front());
    prune(path);
    changed = true;
    if (!path.seen.insert(path.taken()).second) return false;
  }
  return changed;
}

/// Sets the gain and the p-value of each effect beside the others, and lists alternative causes.
void findRivals(const Path& path, InPlace& in_place, TraceResult& result,
                const std::function<bool(double)>& go_on) {
  for (std::size_t k = 0; k < result.effects.size() && go_on(0.0); ++k) {
    TracedEffect& effect = result.effects[k];
    if (!in_place.contains(k)) in_place.emplace(k, replacementsOf(path.search, k));
    const Replacements& in = in_place.at(k);
    effect.chosen.gain = path.search.gainOver(in.without, k);
    effect.p_value = path.noise.pValue(effect.chosen.gain);
    const double least = effect.chosen.evidence() - path.close;
    for (RivalCause& rival : rivalsOf(in.without, in.ranked, path.search.parts(k))) {
      if (rival.explanation.evidence() >= least) effect.equal.push_back(rival.explanation);  // (T46)
      result.rivals.push_back(std::move(rival));
    }
  }
  if (result.effects.empty()) result.rivals = rivalsOf(path.search, result.rejected, {});
}

}  // namespace

bool accepted(const std::vector<Explanation>& ranked, double threshold) {
  return !ranked.empty() && ranked.front().gain > threshold;
}

namespace {

TraceResult searched(const RefinedModel& base, const Trial& trial, const TraceOptions& given,
                     const ProgressMonitor& watch) {
  TraceOptions options = given;
  if (!trial.moment.empty()) {  // errors of slip and slope are not normal: docs/effects.md
    options.max_effects = 1;
    options.least_share = 0.06;
  }
  RoundProgress rounds;
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
  InPlace in_place;
  do grow(path, trial, options, go_on);
  while (exchange(path, in_place, go_on));
  result.rejected = path.rejected;
  result.first_promises = path.first;
  result.last_promises = path.last;
  result.threshold = path.threshold;
  result.effects = path.effects;
  path.search.finish(result);
  result.held_out = holdOut(result, options, foldsOf(result.trial));
  findRivals(path, in_place, result, go_on);
  result.ends = endLevels(result, options, watch);
  result.refined = withinRows(result.refined, result.trial);
  result.scope = scopeOf(result);
  keepConfirmed(result.held_out, result.scope);
  result.refined_rmse = rmseOf(predictInScope(result, asMeasured(result.trial)), result.trial);
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

TraceInput traceInput(const Telemetry& table, const ModelFile& base, const TraceOptions& options) {
  constexpr int kFewest = 5;
  TraceInput input{.rows = modelRows(table, base.model), .options = options};
  input.options.fit_soil = !base.soil_given;
  const Trial& trial = input.rows.trial;
  if (trial.rows() < kFewest)
    throw InputError({table.source,
                      std::to_string(trial.rows()) +
                          " usable rows with sinkage below the wheel radius; tracing needs at least 5",
                      ""});
  // The rows of a drive do not determine both soil and effects.
  if (base.soil_given && trial.moment.empty()) giveDefaultDeviations(input.rows.model);
  return input;
}

}  // namespace talus::terramech
