#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <talus/terramech/calibration.hpp>
#include <talus/terramech/calibration/noise/sensor_noise.hpp>
#include <talus/terramech/numerics/functions.hpp>

namespace talus::terramech {
namespace {

/// Stated errors of the sensors if some fitted errors are far larger, otherwise the fitted errors.
const ChannelErrors& statedFloor(const TraceResult& result) {
  return result.strained.empty() ? result.noise_floor : result.declared_floor;
}

/// Variance of a channel above its floor and `known`; 0 if the excess is within three standard errors.
double excess(const ChannelErrors& rmse, const TraceResult& result, const ChannelErrors& of_sensors,
              std::size_t channel, double known = 0.0) {
  const double floor = of_sensors[channel] * of_sensors[channel] + known;
  const double variance = rmse[channel] * rmse[channel];
  const auto count = static_cast<double>(
      result.trial.measured.col(static_cast<Eigen::Index>(channel)).array().isFinite().count());
  // (T51)
  return variance > floor * (1.0 + 3.0 * std::sqrt(2.0 / std::max(count, 1.0))) ? variance - floor : 0.0;
}

/// Greatest error on held-out rows, in floors, of a model that explains the rows.
constexpr double kExplainedFloors = 1.3;

/// Sets the channel whose error on held-out rows, or the fall of the error by the effects, is the largest in
/// floors, with the errors of both models.
void setChannel(Answer& answer, const TraceResult& result, const ChannelErrors& floors, bool fall) {
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < kChannels; ++c) {
    if (!result.trial.has(static_cast<Channel>(c))) continue;
    const double base = result.held_out.base_rmse[c], rest = result.held_out.refined_rmse[c];
    const double size = (fall ? base - rest : rest) / floors[c];
    if (!(size > most)) continue;
    most = size;
    answer.channel = static_cast<Channel>(c);
    answer.base = base;
    answer.rest = rest;
    answer.floor = floors[c];
  }
}

/// True if each unit with a shared error is a run.
bool unitsAreRuns(const TraceResult& result) {
  const std::vector<int>&unit = result.shared.unit, &run = result.trial.run;
  std::set<std::pair<int, int>> pairs;
  for (std::size_t row = 0; row < unit.size(); ++row) pairs.insert({unit[row], run[row]});
  return pairs.size() == std::set<int>(run.begin(), run.end()).size();
}

std::string unrecorded(const Answer& answer) {
  return "rows that record what else changed from " + answer.unit + " to " + answer.unit;
}

std::string furtherRows(const Answer& answer) {
  return answer.column.empty()
             ? unrecorded(answer)
             : "rows over a wider range of " + answer.column + ", the other columns the same";
}

}  // namespace

const char* name(Verdict verdict) {
  constexpr const char* kNames[] = {"explained", "nothing_missing", "unexplained"};
  return kNames[static_cast<std::size_t>(verdict)];
}

Answer answerOf(const TraceResult& result) {
  Answer answer;
  const ChannelErrors& floors = statedFloor(result);
  bool above_noise = false;
  for (std::size_t c = 0; c < kChannels; ++c)
    above_noise |=
        result.trial.has(static_cast<Channel>(c)) && excess(result.refined_rmse, result, floors, c) > 0.0;
  setChannel(answer, result, floors, false);
  for (const TracedEffect& e : result.effects)
    for (const Effect& part : e.chosen.candidate.parts)
      for (const std::string& name : atBounds(part)) answer.at_bound.push_back(part.name + " " + name);
  for (const std::string& name : soilAtBounds(result.refined)) answer.at_bound.push_back("soil " + name);
  answer.strained = result.strained;
  answer.unstated = unstatedSensors(result.trial, result.refined.stated);
  const bool reached = answer.rest < kExplainedFloors * answer.floor,  // (T52)
      promised = !result.last_promises.empty() && result.last_promises.front().gain > result.threshold;
  if (result.strained.empty() && !result.effects.empty() && reached && answer.at_bound.empty())
    answer.verdict = Verdict::Explained;
  else if (result.strained.empty() && result.effects.empty() && !above_noise && (reached || !promised))
    answer.verdict = Verdict::NothingMissing;
  else
    answer.verdict = Verdict::Unexplained;
  if (answer.verdict == Verdict::Explained) setChannel(answer, result, floors, true);
  if (!result.shared.unit.empty() && !unitsAreRuns(result)) answer.unit = "stretch of time";
  const auto c = static_cast<int>(answer.channel);
  const bool open = answer.verdict == Verdict::Unexplained;
  // (T53)
  if (open && 2.0 * result.shared.soilVariance(c) > squared(answer.rest) - squared(answer.floor)) {
    answer.strength_scatter = std::sqrt(result.shared.run(kChannels, kChannels));
    answer.stiffness_scatter = std::sqrt(result.shared.run(kChannels + 1, kChannels + 1));
    answer.measure = unrecorded(answer);
  }
  for (const Promise& p : result.last_promises) {
    if (p.gain <= 0.0) break;
    answer.column = p.candidate.covariate();
    answer.gain = p.gain;
    break;
  }
  if (open && answer.measure.empty()) answer.measure = furtherRows(answer);
  return answer;
}

double MovedParameter::away() const {
  return (value - prior) / prior_std;
}

std::vector<MovedParameter> movedSoil(const TraceResult& result) {
  std::vector<MovedParameter> moved;
  const RefinedModel& model = result.refined;
  for (const auto& [field, std] : model.soil_prior_std) {
    const auto found = std::find_if(soilParameters().begin(), soilParameters().end(),
                                    [&name = field](const SoilParameter& p) { return name == p.name; });
    const auto mean = model.soil_prior_mean.find(field);
    if (found == soilParameters().end() || mean == model.soil_prior_mean.end() || std <= 0.0) continue;
    MovedParameter p{field, found->get(model.soil), mean->second, std};
    if (field == "log_stiffness") {
      const Soil &now = model.soil, &base = result.given;
      p.value = std::log((now.cohesive_modulus + now.frictional_modulus) /
                         (base.cohesive_modulus + base.frictional_modulus));
    }
    if (std::abs(p.away()) > 3.0) moved.push_back(p);
  }
  return moved;
}

namespace {

bool isAtBound(double value, double low, double high) {
  const double close = 1e-9 * (1.0 + std::abs(high) + std::abs(low));
  return value >= high - close || value <= low + close;
}

}  // namespace

std::vector<std::string> soilAtBounds(const RefinedModel& model) {
  std::vector<std::string> names;
  for (const FittedParameter& f : model.fitted) {
    if (f.effect >= 0) continue;
    const SoilParameter& p = soilParameters()[static_cast<std::size_t>(f.index)];
    if (std::string_view(p.name) != "log_stiffness" && isAtBound(p.get(model.soil), p.low, p.high))
      names.emplace_back(p.name);
  }
  return names;
}

std::vector<std::string> atBounds(const Effect& effect) {
  std::vector<std::string> names;
  const EffectForm* form = findEffect(effect.name);
  for (std::size_t k = 0; form && k < form->parameters.size(); ++k) {
    const EffectParameter& p = form->parameters[k];
    if (p.fitted && isAtBound(effect.parameters[k], p.low, p.high)) names.emplace_back(p.name);
  }
  return names;
}

RefinedModel forPrediction(const TraceResult& result) {
  RefinedModel model = result.refined;
  for (int c = 0; c < kChannels; ++c) {
    if (!result.trial.has(static_cast<Channel>(c))) continue;
    const double run = std::max(0.0, result.shared.variance(c));
    const double shared = run + excess(result.held_out.refined_rmse, result, result.noise_floor,
                                       static_cast<std::size_t>(c), run);
    double unit = 0.0;
    for (int row = 0; row < result.trial.rows(); ++row)
      unit += std::pow(result.trial.denominator(row, static_cast<Channel>(c)), 2) / result.trial.rows();
    double& absolute = model.noise.absolute[static_cast<std::size_t>(c)];
    absolute = std::sqrt(absolute * absolute + shared * unit);  // (T54)
  }
  return model;
}

}  // namespace talus::terramech
