#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <talus/cli/soil/trace_answer.hpp>

namespace talus::cli {
namespace {

using namespace terramech;

bool same(const Candidate& a, const Candidate& b) {
  const Effect &x = a.parts.front(), &y = b.parts.front();
  return x.name == y.name && a.covariate() == b.covariate() && x.only_value == y.only_value;
}

/// Returns true if the model's predictions for the trial's rows equal `a` within 1e-5.
bool agree(const Eigen::MatrixXd& a, const RefinedModel& model, const Trial& trial) {
  SolvedContacts solved;
  const Eigen::MatrixXd difference = a - predictRows(model, trial, solved);
  return difference.array().isNaN().select(0.0, difference).cwiseAbs().maxCoeff() <= 1e-5;
}

struct Term {
  const char* name;
  double Soil::*field;
};

/// Terms of the base model that an effect of the library may replace.
constexpr Term kTerms[] = {{"slip_sinkage_exponent", &Soil::slip_sinkage_exponent},
                           {"digging_exponent", &Soil::digging_exponent},
                           {"side_bulldozing", &Soil::side_bulldozing}};

EffectRole roleOf(const RefinedModel& refined, std::size_t effect, const Trial& trial) {
  SolvedContacts solved;
  const Eigen::MatrixXd with = predictRows(refined, trial, solved);
  RefinedModel without = refined;
  without.effects.erase(without.effects.begin() + static_cast<long>(effect));
  if (agree(with, without, trial)) return {.adds = false};
  for (const Term& term : kTerms) {
    RefinedModel less = without;
    less.soil.*term.field = 0.0;
    if (agree(with, less, trial)) return {.adds = false, .takes_back = {term.name}};
  }
  return {};
}

/// Empty if no sensor is inconsistent with its declared error.
std::string strainedText(const Answer& a) {
  std::string text;
  for (const StrainedSensor& s : a.strained)
    text += fmt::format("{}{} would have to err {:.1f} times as declared ({:.3g} in place of {:.3g})",
                        text.empty() ? "" : "; ", s.column, s.fitted / s.declared, s.fitted, s.declared);
  return text;
}

/// Returns the name, column and channel of each effect.
std::string causes(const TraceResult& result) {
  std::string text;
  for (const TracedEffect& e : result.effects)
    text += fmt::format("{}{} ({}) in {}", text.empty() ? "" : ", ", e.chosen.candidate.parts.front().name,
                        e.chosen.candidate.covariate(), name(e.channel));
  return text;
}

/// Returns the text on effects with several equivalent causes; empty if each effect has one cause.
std::string equalCauses(const TraceResult& result) {
  std::string text;
  for (const TracedEffect& e : result.effects) {
    if (e.equal.empty()) continue;
    text += fmt::format("; {} causes are equal: {} ({})", e.equal.size() + 1,
                        e.chosen.candidate.parts.front().name, e.chosen.candidate.covariate());
    for (const Explanation& other : e.equal)
      text += fmt::format(", {} ({})", other.candidate.parts.front().name, other.candidate.covariate());
  }
  return text;
}

}  // namespace

std::string refusal(const TraceResult& result, const Explanation& rejected) {
  if (rejected.gain <= result.threshold) return "gains no more than noise would";
  if (!result.effects.empty()) return "explains less than the selected effect";
  if (!result.trial.moment.empty())
    return "gains more than noise would, but carries less than an effect of a drive must";
  return "gains more than noise would, but not beside the others";
}

std::string refusal(const TraceResult& result) {
  if (result.last_promises.empty() || result.last_promises.front().gain <= 0.0) return "";
  const Promise& promise = result.last_promises.front();
  if (promise.gain <= result.threshold)
    return fmt::format("gain {:.1f}, below the {:.1f} that would be evidence", promise.gain,
                       result.threshold);
  const std::string first = fmt::format("gain {:.1f} to first order", promise.gain);
  const auto is_it = [&](const auto& e) { return same(e.candidate, promise.candidate); };
  const auto fitted = std::find_if(result.rejected.begin(), result.rejected.end(), is_it);
  if (fitted == result.rejected.end()) {
    const bool found = std::any_of(result.effects.begin(), result.effects.end(),
                                   [&](const TracedEffect& e) { return is_it(e.chosen); });
    return first + (found ? ", of which an effect was accepted; no further one was searched"
                          : "; accepted first, and left out as it gained too little beside the others");
  }
  if (fitted->gain <= result.threshold)
    return fmt::format("{}, {:.1f} when fitted, below the {:.1f} that would be evidence", first, fitted->gain,
                       result.threshold);
  return fmt::format("{}, {:.1f} when fitted: {}", first, fitted->gain, refusal(result, *fitted));
}

std::string verdictText(const TraceResult& result, const Answer& a) {
  const std::string rest = fmt::format("rms of {} on held-out rows {:.4f}, of the sensors alone {:.4f}",
                                       name(a.channel), a.rest, a.floor);
  if (a.verdict == Verdict::NothingMissing)
    return "nothing missing: the residuals are consistent with noise; " + rest;
  const std::string found =
      result.effects.empty()
          ? ""
          : fmt::format(
                "explained by {} effect{}, {}: {} on held-out rows from {:.2f} to {:.2f} noise floors{}",
                result.effects.size(), result.effects.size() == 1 ? "" : "s", causes(result), name(a.channel),
                a.base / a.floor, a.rest / a.floor, equalCauses(result));
  if (a.verdict == Verdict::Explained) return found;
  if (!a.inapplicable.empty())
    return "unexplained: the model does not apply: " + a.inapplicable + "; " + rest;
  const std::string start = found.empty() ? "unexplained: " + rest : "partly " + found;
  if (!a.strained.empty()) return start + "; " + strainedText(a);
  if (!a.at_bound.empty())
    return fmt::format("{}; at a bound of its range: {}", start, fmt::join(a.at_bound, ", "));
  if (a.strength_scatter + a.stiffness_scatter > 0.0)
    return fmt::format(
        "{}; the soil's strength scatters by {:.0f} % and its stiffness by {:.0f} % from {} to {}; {} would "
        "decide",
        start, 100.0 * a.strength_scatter, 100.0 * a.stiffness_scatter, a.unit, a.unit, a.measure);
  const std::string where = a.column.empty()
                                ? "it follows no column"
                                : fmt::format("it varies most with {} ({})", a.column, refusal(result));
  return fmt::format("{}; {}; {} would decide", start, where, a.measure);
}

std::vector<EffectRole> rolesOf(const TraceResult& result) {
  std::vector<EffectRole> roles;
  std::size_t at = result.base.effects.size();
  for (const TracedEffect& effect : result.effects) {
    const auto parts = effect.chosen.candidate.parts.size();
    const bool one = parts == 1 && at < result.refined.effects.size() &&
                     result.refined.effects[at].name == effect.chosen.candidate.parts.front().name;
    roles.push_back(one ? roleOf(result.refined, at, result.trial) : EffectRole{});
    at += parts;
  }
  return roles;
}

std::string roleText(const EffectRole& role) {
  if (role.adds) return "";
  if (role.takes_back.empty()) return "adds nothing, the refined model predicts the same without it";
  return fmt::format("takes back the base's {} and adds nothing in its place",
                     fmt::join(role.takes_back, ", "));
}

}  // namespace talus::cli
