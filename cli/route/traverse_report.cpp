#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include <talus/cli/draw/route_summary.hpp>
#include <talus/cli/route/traverse_report.hpp>

namespace talus::cli {
namespace {

using nlohmann::ordered_json;
using planner::Outcome;
using planner::SoilKnowledge;

constexpr std::array<Outcome, 5> kOutcomes{Outcome::Reached, Outcome::Immobilised, Outcome::Tipped,
                                           Outcome::GaveUp, Outcome::Slid};

ordered_json asJson(const planner::Sampled& sampled) {
  return {{"rate", sampled.value}, {"interval_95", sampled.interval_95}};
}

void addRates(ordered_json& out, const planner::Rates& rates) {
  for (const auto outcome : kOutcomes)
    out[std::string(planner::name(outcome))] = asJson(rates.outcome[static_cast<std::size_t>(outcome)]);
}

// A share with its 95 % interval, such as "12.5 % [8.1, 18.7]".
std::string percent(const planner::Sampled& share) {
  if (std::isnan(share.value)) return "-";
  return fmt::format("{:.1f} % [{:.1f}, {:.1f}]", 100.0 * share.value, 100.0 * share.interval_95[0],
                     100.0 * share.interval_95[1]);
}

std::string line(const std::string& name, const std::string& value) {
  return fmt::format("{:<24} {}\n", name, value);
}

std::size_t safeWorlds(const std::vector<planner::WorldResult>& perfect) {
  return static_cast<std::size_t>(
      std::count_if(perfect.begin(), perfect.end(),
                    [](const planner::WorldResult& r) { return r.drive.outcome == Outcome::Reached; }));
}

}  // namespace

std::string label(SoilKnowledge belief) {
  return belief == SoilKnowledge::PerfectKnowledge ? "perfect knowledge" : std::string(planner::name(belief));
}

std::string label(Outcome outcome) {
  return outcome == Outcome::GaveUp ? "no feasible route" : std::string(planner::name(outcome));
}

ordered_json asJson(const planner::WorldResult& result) {
  return {{"outcome", planner::name(result.drive.outcome)},
          {"cause", result.drive.cause},
          {"energy_J", result.drive.energy_J},
          {"length_m", result.drive.length_m},
          {"time_s", result.drive.time_s},
          {"replans", result.drive.replans},
          {"alarms", result.drive.alarms},
          {"max_slip", result.drive.max_slip},
          {"categories_changed", result.categories_changed}};
}

planner::WorldResult worldResult(const ordered_json& json) {
  planner::WorldResult result;
  const auto outcome = json.at("outcome").get<std::string>();
  result.drive.outcome = *std::find_if(kOutcomes.begin(), kOutcomes.end(),
                                       [&](Outcome o) { return planner::name(o) == outcome; });
  json.at("cause").get_to(result.drive.cause);
  json.at("energy_J").get_to(result.drive.energy_J);
  json.at("length_m").get_to(result.drive.length_m);
  json.at("time_s").get_to(result.drive.time_s);
  json.at("replans").get_to(result.drive.replans);
  json.at("alarms").get_to(result.drive.alarms);
  json.at("max_slip").get_to(result.drive.max_slip);
  json.at("categories_changed").get_to(result.categories_changed);
  return result;
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

ordered_json asJson(const BeliefResults& beliefs) {
  const auto& perfect = beliefs[static_cast<std::size_t>(SoilKnowledge::PerfectKnowledge)];
  ordered_json out{{"worlds", perfect.size()}, {"worlds_with_a_safe_route", safeWorlds(perfect)}};
  const std::string energy_key = "energy_over_" + std::string(planner::name(SoilKnowledge::PerfectKnowledge));
  for (std::size_t b = 0; b < beliefs.size(); ++b) {
    const planner::Comparison against = planner::compared(beliefs[b], perfect);
    ordered_json one;
    addRates(one, against.rates);
    one[energy_key] = {{"mean", against.energy_over_perfect_knowledge.value},
                       {"interval_95", against.energy_over_perfect_knowledge.interval_95}};
    out[std::string(planner::name(static_cast<SoilKnowledge>(b)))] = one;
  }
  return out;
}

std::string asText(const planner::WorldResult& result) {
  const planner::TraverseSimulation& drive = result.drive;
  return line("outcome", label(drive.outcome)) + (drive.cause.empty() ? "" : line("cause", drive.cause)) +
         line("energy", energyText(drive.energy_J)) +
         line("distance", fmt::format("{:.1f} m", drive.length_m)) +
         line("time", durationText(drive.time_s)) +
         line("maximum slip", fmt::format("{:.2f}", drive.max_slip)) +
         line("alarms, replans", fmt::format("{}, {}", drive.alarms, drive.replans)) +
         line("cells reclassified", std::to_string(result.categories_changed));
}

std::string asText(const std::vector<planner::WorldResult>& results) {
  const planner::Rates rates = planner::ratesOf(results);
  std::string text = line("worlds", std::to_string(rates.worlds));
  for (const Outcome outcome : kOutcomes)
    text += line(label(outcome), percent(rates.outcome[static_cast<std::size_t>(outcome)]));
  if (!std::isnan(rates.energy_J)) text += line("mean energy (if reached)", energyText(rates.energy_J));
  return text;
}

std::string asText(const BeliefResults& beliefs) {
  const auto& perfect = beliefs[static_cast<std::size_t>(SoilKnowledge::PerfectKnowledge)];
  std::string text =
      fmt::format("{} worlds; perfect knowledge reaches the goal in {} of them; energy is compared there.\n",
                  perfect.size(), safeWorlds(perfect));
  text += fmt::format("{:<18}", "soil knowledge");
  for (const Outcome outcome : kOutcomes) text += fmt::format(" {:<22}", label(outcome));
  text += " energy relative to perfect knowledge\n";
  for (std::size_t b = 0; b < beliefs.size(); ++b) {
    const planner::Comparison against = planner::compared(beliefs[b], perfect);
    text += fmt::format("{:<18}", label(static_cast<SoilKnowledge>(b)));
    for (const planner::Sampled& share : against.rates.outcome)
      text += fmt::format(" {:<22}", percent(share));
    const planner::Sampled& energy = against.energy_over_perfect_knowledge;
    text += std::isnan(energy.value) ? std::string(" -\n")
                                     : fmt::format(" {:.3f} [{:.3f}, {:.3f}]\n", energy.value,
                                                   energy.interval_95[0], energy.interval_95[1]);
  }
  return text + "95 % confidence intervals in brackets.\n";
}

}  // namespace talus::cli
