#include <algorithm>
#include <string>

#include <cli/drive_report.hpp>

namespace talus::cli {
namespace {

using nlohmann::ordered_json;
using planner::Outcome;

ordered_json asJson(const planner::Sampled& sampled) {
  return {{"rate", sampled.value}, {"interval_95", sampled.interval_95}};
}

void addRates(ordered_json& out, const planner::Rates& rates) {
  for (const auto outcome : {Outcome::Reached, Outcome::Immobilised, Outcome::Tipped, Outcome::GaveUp})
    out[std::string(planner::name(outcome))] = asJson(rates.outcome[static_cast<std::size_t>(outcome)]);
}

}  // namespace

ordered_json asJson(const planner::WorldResult& result) {
  return {{"outcome", planner::name(result.drive.outcome)},
          {"energy_J", result.drive.energy_J},
          {"length_m", result.drive.length_m},
          {"time_s", result.drive.time_s},
          {"replans", result.drive.replans},
          {"alarms", result.drive.alarms},
          {"max_slip", result.drive.max_slip},
          {"categories_changed", result.categories_changed}};
}

ordered_json asJson(const std::vector<planner::WorldResult>& results) {
  const planner::Rates rates = planner::ratesOf(results);
  ordered_json out{{"worlds", rates.worlds}};
  addRates(out, rates);
  out["mean_energy_J_where_reached"] = rates.energy_J;
  out["each"] = ordered_json::array();
  for (const planner::WorldResult& r : results) out["each"].push_back(asJson(r));
  return out;
}

ordered_json asJson(const std::array<std::vector<planner::WorldResult>, 4>& beliefs) {
  const auto& clairvoyant = beliefs[static_cast<std::size_t>(planner::Belief::Clairvoyant)];
  const auto safe = std::count_if(clairvoyant.begin(), clairvoyant.end(), [](const planner::WorldResult& r) {
    return r.drive.outcome == Outcome::Reached;
  });
  ordered_json out{{"worlds", clairvoyant.size()}, {"worlds_with_a_safe_route", safe}};
  for (std::size_t b = 0; b < beliefs.size(); ++b) {
    const planner::Comparison against = planner::compared(beliefs[b], clairvoyant);
    ordered_json one;
    addRates(one, against.rates);
    one["energy_over_clairvoyant"] = {{"mean", against.energy_over_clairvoyant.value},
                                      {"interval_95", against.energy_over_clairvoyant.interval_95}};
    out[std::string(planner::name(static_cast<planner::Belief>(b)))] = one;
  }
  return out;
}

}  // namespace talus::cli
