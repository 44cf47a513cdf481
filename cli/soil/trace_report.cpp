#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <talus/cli/soil/channel_report.hpp>
#include <talus/cli/soil/trace_answer.hpp>
#include <talus/cli/soil/trace_report.hpp>

namespace talus::cli {
namespace {

using nlohmann::ordered_json;
using namespace terramech;

/// Parameters of an effect by name; curves as knots and values per channel.
ordered_json parametersJson(const Candidate& candidate) {
  ordered_json out = ordered_json::object();
  for (const Effect& part : candidate.parts) {
    if (part.empirical()) {
      out[name(part.channel)] = {{"knots", part.knots}, {"values", part.parameters}};
      continue;
    }
    const EffectForm* form = findEffect(part.name);
    for (std::size_t k = 0; k < part.parameters.size(); ++k)
      out[form->parameters[k].name] = part.parameters[k];
  }
  return out;
}

ordered_json stdJson(const TracedEffect& effect) {
  ordered_json out = ordered_json::object();
  const Effect& part = effect.chosen.candidate.parts.front();
  if (part.empirical()) return effect.parameter_std;
  const EffectForm* form = findEffect(part.name);
  std::size_t at = 0;
  for (const EffectParameter& p : form->parameters)
    if (p.fitted && at < effect.parameter_std.size()) out[p.name] = effect.parameter_std[at++];
  return out;
}

ordered_json rivalJson(const Explanation& e) {
  const Effect& part = e.candidate.parts.front();
  ordered_json out{{"name", part.name}, {"covariate", covariateOf(part)}};
  if (!part.only_column.empty()) out["only"] = {{part.only_column, part.only_value}};
  out["log_likelihood_gain"] = 0.5 * e.chi2_gain;
  out["gain"] = e.gain;
  return out;
}

ordered_json evidenceJson(const TableTrace& trace, const TracedEffect& effect) {
  ordered_json rivals = ordered_json::array();
  for (const Explanation& e : effect.equal) rivals.push_back(rivalJson(e));
  return {{"log_likelihood_gain", 0.5 * effect.chosen.chi2_gain},
          {"gain", effect.chosen.gain},
          {"alternatives", rivals},
          {"confounded_with", confounded(trace.result.trial, effect.chosen.candidate.covariate())},
          {"to_tell_apart", separatingMeasurement(trace.result.trial, effect)}};
}

ordered_json effectJson(const TableTrace& trace, const TracedEffect& effect, const EffectRole& role) {
  const Effect& part = effect.chosen.candidate.parts.front();
  ordered_json out{{"name", part.name},
                   {"family", effect.chosen.candidate.family},
                   {"covariate", covariateOf(part)},
                   {"channel", name(effect.channel)}};
  if (!part.only_column.empty()) out["only"] = {{part.only_column, part.only_value}};
  out["parameters"] = parametersJson(effect.chosen.candidate);
  out["parameters_std"] = stdJson(effect);
  out["at_bound"] = atBounds(part);
  out["adds"] = role.adds;
  out["takes_back"] = role.takes_back;
  out["p_value"] = effect.p_value;
  out["equal_to"] = ordered_json::array();
  for (const Explanation& e : effect.equal)
    out["equal_to"].push_back(
        {{"name", e.candidate.parts.front().name}, {"covariate", e.candidate.covariate()}});
  out["evidence"] = evidenceJson(trace, effect);
  if (const EffectForm* form = findEffect(part.name)) {
    out["formula"] = form->formula;
    out["source"] = form->source;
    out["signature"] = form->signature;
  } else {
    out["formula"] = "natural cubic spline through (knots, values), fitted; no physical cause is claimed";
  }
  return out;
}

ordered_json rejectedJson(const TraceResult& result) {
  ordered_json out = ordered_json::array();
  for (const Explanation& e : result.rejected) {
    ordered_json one = rivalJson(e);
    one["reason"] = refusal(result, e);
    out.push_back(one);
  }
  return out;
}

double correlation(const Eigen::VectorXd& x, const Eigen::VectorXd& y) {
  double n = 0.0, mx = 0.0, my = 0.0;
  for (Eigen::Index i = 0; i < x.size(); ++i)
    if (std::isfinite(x[i]) && std::isfinite(y[i])) n += 1.0, mx += x[i], my += y[i];
  double xx = 0.0, yy = 0.0, xy = 0.0;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i])) continue;
    const double a = x[i] - mx / n, b = y[i] - my / n;
    xx += a * a;
    yy += b * b;
    xy += a * b;
  }
  return xx > 0.0 && yy > 0.0 ? xy / std::sqrt(xx * yy) : 0.0;
}

std::string effectLine(const Trial& trial, const TracedEffect& effect, const EffectRole& role) {
  const Effect& part = effect.chosen.candidate.parts.front();
  std::string line =
      fmt::format("  {} in {} (covariate {}{})", part.name, name(effect.channel), covariateOf(part),
                  part.only_column.empty() ? "" : ", only for the value " + part.only_value);
  if (!role.adds) line += ": " + roleText(role);
  if (const EffectForm* form = findEffect(part.name)) {
    line += fmt::format("\n    {}   [{}]", form->formula, form->source);
    for (const FittedNumber& p : fittedNumbers(effect))
      line += fmt::format("\n    {} = {:.4g} +- {:.2g} [{}]{}", p.name, p.value, p.std, p.unit,
                          p.at_bound ? ", at its bound" : "");
  } else {
    line +=
        "\n"
        "    curve fitted to the residual; it matches no known effect";
  }
  line += fmt::format(
      "\n"
      "    {}, log-likelihood gain {:.1f}",
      "p " + pText(effect.p_value), 0.5 * effect.chosen.chi2_gain);
  if (!effect.equal.empty())
    line += fmt::format("\n    {}: {}", equalText(effect), separatingMeasurement(trial, effect));
  return line + "\n";
}

}  // namespace

std::string pText(double p) {
  const double least = 1.0 / (TraceOptions{}.draws + 1.0);
  if (p <= least * (1.0 + 1e-9)) return fmt::format("< {:.2g}", std::max(0.001, 1.01 * least));
  return fmt::format("= {:.2g}", p);
}

std::vector<FittedNumber> fittedNumbers(const TracedEffect& effect) {
  const Effect& part = effect.chosen.candidate.parts.front();
  const EffectForm* form = findEffect(part.name);
  const std::vector<std::string> bounds = atBounds(part);
  std::vector<FittedNumber> numbers;
  for (std::size_t k = 0; form && k < form->parameters.size(); ++k) {
    const EffectParameter& p = form->parameters[k];
    if (!p.fitted) continue;
    const std::size_t at = numbers.size();
    numbers.push_back({.name = p.name,
                       .unit = p.unit,
                       .value = part.parameters[k],
                       .std = at < effect.parameter_std.size() ? effect.parameter_std[at] : 0.0,
                       .at_bound = std::find(bounds.begin(), bounds.end(), p.name) != bounds.end()});
  }
  return numbers;
}

std::string equalText(const TracedEffect& effect) {
  std::string causes;
  for (const Explanation& e : effect.equal)
    causes += fmt::format("{}{} ({})", causes.empty() ? "" : " or ", e.candidate.parts.front().name,
                          e.candidate.covariate());
  return "these rows cannot separate it from " + causes;
}

const std::string& covariateOf(const Effect& effect) {
  return effect.only_column.empty() ? effect.covariate : effect.only_column;
}

std::vector<std::string> confounded(const Trial& trial, const std::string& covariate) {
  std::vector<std::string> close;
  const Eigen::VectorXd x = covariateValues(trial, covariate, Eigen::VectorXd::Zero(trial.rows()));
  for (const std::string& other : trial.covariates)
    if (other != covariate &&
        std::abs(correlation(x, covariateValues(trial, other, Eigen::VectorXd::Zero(trial.rows())))) > 0.9)
      close.push_back(other);
  return close;
}

std::string separatingMeasurement(const Trial& trial, const TracedEffect& effect) {
  const std::string& own = effect.chosen.candidate.covariate();
  for (const Explanation& rival : effect.equal)
    if (rival.candidate.covariate() != own)
      return "measure rows in which " + own + " and " + rival.candidate.covariate() +
             " vary independently, to discriminate " + effect.chosen.candidate.parts.front().name + " from " +
             rival.candidate.parts.front().name;
  const auto close = confounded(trial, own);
  if (!close.empty())
    return own + " is correlated with " + close.front() +
           " in these rows; vary one and keep the other constant";
  if (!effect.equal.empty())
    return "measure rows over a wider range of " + own + ", to discriminate " +
           effect.chosen.candidate.parts.front().name + " from " +
           effect.equal.front().candidate.parts.front().name;
  return "no close alternative";
}

namespace {

ordered_json schemeJson(const HeldOut& held) {
  return {{"scheme", held.scheme},
          {"base_rmse", errorsJson(held.base_rmse)},
          {"refined_rmse", errorsJson(held.refined_rmse)}};
}

ordered_json heldOutJson(const TableTrace& trace) {
  ordered_json out = schemeJson(trace.held_out.front());
  out["noise_floor"] = errorsJson(trace.result.noise_floor);
  ordered_json others = ordered_json::array();
  for (std::size_t k = 1; k < trace.held_out.size(); ++k) others.push_back(schemeJson(trace.held_out[k]));
  out["others"] = others;
  ordered_json ends = ordered_json::array();
  for (const EndLevel& end : trace.result.ends)
    ends.push_back({{"column", end.column},
                    {"end", end.high ? "high" : "low"},
                    {"rows", end.rows},
                    {"distance", end.distance},
                    {"base_rmse", errorsJson(end.base_rmse)},
                    {"refined_rmse", errorsJson(end.refined_rmse)}});
  out["end_levels"] = ends;
  return out;
}

/// Errors at the end levels, predicted from the other levels.
std::string endLines(const TraceResult& r) {
  if (r.ends.empty()) return "";
  std::string out = "held out: end levels, predicted from the others (base -> refined)\n";
  for (const EndLevel& end : r.ends) {
    out += fmt::format("  {:26s} {:3d} rows:{}\n", (end.high ? "greatest " : "least ") + end.column, end.rows,
                       changeText(end.base_rmse, end.refined_rmse));
  }
  return out;
}

ordered_json answerJson(const TraceResult& result, const Answer& a) {
  ordered_json moved = ordered_json::array();
  for (const MovedParameter& p : movedSoil(result))
    moved.push_back({{"name", p.name},
                     {"value", p.value},
                     {"prior", p.prior},
                     {"prior_std", p.prior_std},
                     {"standard_deviations", p.away()}});
  ordered_json strained = ordered_json::array();
  for (const StrainedSensor& s : a.strained)
    strained.push_back({{"column", s.column}, {"declared", s.declared}, {"fitted", s.fitted}});
  return {{"channel", name(a.channel)},
          {"base_rmse", a.base},
          {"rmse", a.rest},
          {"noise_floor", a.floor},
          {"varies_with", a.column},
          {"gain", a.gain},
          {"threshold", result.threshold},
          {"refused", refusal(result)},
          {"rows_that_decide", a.measure},
          {"soil_scatter", {{"strength", a.strength_scatter}, {"stiffness", a.stiffness_scatter}}},
          {"sensors_beyond_declared", strained},
          {"sensors_undeclared", a.unstated},
          {"soil_off_prior", moved},
          {"at_bound", a.at_bound},
          {"soil_at_bound", soilAtBounds(result.refined)}};
}

ordered_json beyondAxleJson(const TableTrace& trace) {
  if (trace.beyond_axle == 0) return {{"rows", 0}};
  return {{"rows", trace.beyond_axle}, {"refined_rmse", errorsJson(trace.beyond_axle_rmse)}};
}

}  // namespace

ordered_json traceJson(const TableTrace& trace) {
  const TraceResult& r = trace.result;
  ordered_json effects = ordered_json::array();
  const std::vector<EffectRole> roles = rolesOf(r);
  for (std::size_t k = 0; k < roles.size(); ++k) effects.push_back(effectJson(trace, r.effects[k], roles[k]));
  ordered_json tests = ordered_json::array();
  for (std::size_t k = 0; k < r.first_promises.size() && k < 12; ++k) {
    const Promise& p = r.first_promises[k];
    const Effect& front = p.candidate.parts.front();
    tests.push_back({{"what", front.name},
                     {"covariate", p.candidate.covariate()},
                     {"channel", name(front.channel)},
                     {"gain", p.gain},
                     {"p_value", p.p_value}});
  }
  return {{"verdict", name(trace.answer.verdict)},
          {"answer", answerJson(r, trace.answer)},
          {"base", {{"rmse", errorsJson(r.base_rmse)}}},
          {"effects", effects},
          {"rejected", rejectedJson(r)},
          {"refined", {{"rmse", errorsJson(r.refined_rmse)}}},
          {"held_out", heldOutJson(trace)},
          {"tests", tests},
          {"applies", trace.applies.applies},
          {"applies_reason", trace.applies.reason},
          {"rows_used", trace.rowsUsed()},
          {"rows_rejected", trace.rejected.size()},
          {"searched", searchedJson(r)},
          {"beyond_axle", beyondAxleJson(trace)}};
}

std::string beyondAxleText(const TableTrace& trace) {
  std::string errors;
  for (Channel c : kAllChannels)
    if (const double e = trace.beyond_axle_rmse[static_cast<std::size_t>(c)]; std::isfinite(e))
      errors += fmt::format("{}{} {:.3f}", errors.empty() ? "" : ", ", name(c), e);
  return fmt::format(
      "{} rows with sinkage at or above the axle are excluded, outside the range of the contact model; rmse "
      "of the refined model on them: {}",
      trace.beyond_axle, errors);
}

std::string movedText(const MovedParameter& p) {
  return fmt::format(
      "warning: {} of the soil is fitted {:.1f} standard deviations from its prior ({:.4g}, prior {:.4g} +- "
      "{:.2g})",
      p.name, p.away(), p.value, p.prior, p.prior_std);
}

std::string traceText(const TableTrace& trace) {
  const TraceResult& r = trace.result;
  std::string out =
      verdictText(r, trace.answer) + "\n" +
      fmt::format("{}: {} rows used, {} rejected\n", trace.source, trace.rowsUsed(), trace.rejected.size()) +
      searchedText(r);
  if (!trace.answer.unstated.empty())
    out += fmt::format("no standard deviation declared under sensors: in the base file; fitted instead: {}\n",
                       fmt::join(trace.answer.unstated, ", "));
  for (const MovedParameter& p : movedSoil(r)) out += movedText(p) + "\n";
  for (const std::string& name : soilAtBounds(r.refined))
    out += "warning: " + name + " (soil) is at the bound of its range\n";
  const std::vector<EffectRole> roles = rolesOf(r);
  for (std::size_t k = 0; k < roles.size(); ++k) out += effectLine(r.trial, r.effects[k], roles[k]);
  for (const HeldOut& held : trace.held_out) {
    out += fmt::format(
        "held out: {}\n"
        "  {:26s} {:>10s} {:>10s} {:>12s}\n",
        held.scheme, "rmse", "base", "refined", "noise floor");
    for (Channel c : kAllChannels) {
      const auto k = static_cast<std::size_t>(c);
      if (!r.trial.has(c)) continue;
      out += fmt::format("  {:26s} {:10.4f} {:10.4f} {:12.4f}\n", name(c), held.base_rmse[k],
                         held.refined_rmse[k], r.noise_floor[k]);
    }
  }
  out += endLines(r);
  if (trace.beyond_axle > 0) out += beyondAxleText(trace) + '\n';
  return out;
}

}  // namespace talus::cli
