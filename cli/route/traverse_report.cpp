#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include <talus/cli/app/campaign.hpp>
#include <talus/cli/app/context.hpp>
#include <talus/cli/app/output_file.hpp>
#include <talus/cli/draw/page.hpp>
#include <talus/cli/draw/plot.hpp>
#include <talus/cli/draw/route_summary.hpp>
#include <talus/cli/route/route_reader.hpp>
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

// An empty field is a missing value.
std::string field(double value) {
  return std::isfinite(value) ? fmt::format("{:.9g}", value) : std::string();
}

std::size_t safeWorlds(const std::vector<planner::WorldResult>& perfect) {
  return static_cast<std::size_t>(
      std::count_if(perfect.begin(), perfect.end(),
                    [](const planner::WorldResult& r) { return r.drive.outcome == Outcome::Reached; }));
}

std::vector<Fact> factsOf(const planner::WorldResult& result) {
  const planner::TraverseSimulation& drive = result.drive;
  std::vector<Fact> facts{{"outcome", label(drive.outcome)},
                          {"cause", drive.cause},
                          {"energy", energyText(drive.energy_J)},
                          {"distance", fmt::format("{:.1f} m", drive.length_m)},
                          {"time", durationText(drive.time_s)},
                          {"maximum slip", fmt::format("{:.2f}", drive.max_slip)},
                          {"alarms, replans", fmt::format("{}, {}", drive.alarms, drive.replans)},
                          {"cells reclassified", std::to_string(result.categories_changed)}};
  std::erase_if(facts, [](const Fact& fact) { return fact.second.empty(); });
  return facts;
}

}  // namespace

std::string label(SoilKnowledge belief) {
  return belief == SoilKnowledge::PerfectKnowledge ? "perfect knowledge" : std::string(planner::name(belief));
}

std::string label(Outcome outcome) {
  return outcome == Outcome::GaveUp ? "no feasible route" : std::string(planner::name(outcome));
}

// Calls field(key, value) for the values of a result that JSON holds, but its outcome.
template <typename Result, typename Field>
void eachField(Result& result, Field field) {
  field("cause", result.drive.cause);
  field("energy_J", result.drive.energy_J);
  field("length_m", result.drive.length_m);
  field("time_s", result.drive.time_s);
  field("replans", result.drive.replans);
  field("alarms", result.drive.alarms);
  field("max_slip", result.drive.max_slip);
  field("categories_changed", result.categories_changed);
}

ordered_json asJson(const planner::WorldResult& result) {
  ordered_json json{{"outcome", planner::name(result.drive.outcome)}};
  eachField(result, [&](const char* key, const auto& value) { json[key] = value; });
  return json;
}

planner::WorldResult worldResult(const ordered_json& json) {
  planner::WorldResult result;
  const auto outcome = json.at("outcome").get<std::string>();
  result.drive.outcome =
      *std::ranges::find_if(kOutcomes, [&](Outcome o) { return planner::name(o) == outcome; });
  eachField(result, [&](const char* key, auto& value) { json.at(key).get_to(value); });
  return result;
}

ordered_json asJson(const std::vector<planner::WorldResult>& results) {
  const planner::Rates rates = planner::ratesOf(results);
  ordered_json out{{"worlds", rates.worlds}};
  addRates(out, rates);
  out["mean_energy_J_where_reached"] = rates.energy_J;
  out["each"] = jsonList(results, [](const planner::WorldResult& r) { return asJson(r); });
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
  std::string text;
  for (const auto& [name, value] : factsOf(result)) text += line(name, value);
  return text;
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
  Table table{{"soil knowledge"}};
  for (const Outcome outcome : kOutcomes) table.front().push_back(label(outcome));
  table.front().emplace_back("energy relative to perfect knowledge");
  for (std::size_t b = 0; b < beliefs.size(); ++b) {
    const planner::Comparison against = planner::compared(beliefs[b], perfect);
    table.push_back({label(static_cast<SoilKnowledge>(b))});
    for (const planner::Sampled& share : against.rates.outcome) table.back().push_back(percent(share));
    const planner::Sampled& energy = against.energy_over_perfect_knowledge;
    table.back().push_back(std::isnan(energy.value) ? "-" : fmt::format("{:.3f}", energy.value));
    if (!std::isnan(energy.interval_95[0]))  // one world has none
      table.back().back() += fmt::format(" [{:.3f}, {:.3f}]", energy.interval_95[0], energy.interval_95[1]);
  }
  return text + tableText(table) + "95 % confidence intervals in brackets.\n";
}

SimulatedWorlds simulatedWorlds(std::size_t beliefs, std::size_t worlds, const JobResults& jobs) {
  SimulatedWorlds out{.results = std::vector<std::vector<planner::WorldResult>>(beliefs), .failures = {}};
  for (std::size_t i = 0; i < worlds; ++i) {
    std::vector<nlohmann::ordered_json> each;
    for (std::size_t b = 0; b < beliefs && each.size() == b; ++b) {
      const auto found = jobs.find(b * worlds + i);
      if (found == jobs.end()) break;
      if (found->second.starts_with('{'))
        each.push_back(nlohmann::ordered_json::parse(found->second));
      else
        out.failures.push_back({i, found->second});  // the reason of a failed job
    }
    for (std::size_t b = 0; b < beliefs && each.size() == beliefs; ++b)
      out.results[b].push_back(worldResult(each[b]));
  }
  return out;
}

void saveTelemetry(const std::filesystem::path& path, const planner::TraverseSimulation& drive,
                   const terramech::Rover& rover) {
  std::string text =
      "run,wheel,pass_index,time_s,x_m,y_m,heading_rad,slope_rad,slip,rim_speed_mps,speed_mps,load_N,torque_"
      "Nm,"
      "sinkage_m,wheel_radius_m,wheel_width_m\n";
  for (const planner::WheelRecord& r : drive.records) {
    const costmap::TelemetryReading& w = r.reading;
    text += fmt::format(
        "simulation,w{},{},{}\n", r.wheel + 1, w.pass,
        fmt::join(std::vector{field(w.time_s), field(w.place.x_m), field(w.place.y_m), field(r.heading_rad),
                              field(std::atan(w.gradient)), field(w.slip), field(rover.max_speed_mps),
                              field(rover.max_speed_mps * (1.0 - w.speed_slip)), field(w.load_N),
                              field(w.torque_Nm), field(w.sinkage_m), field(rover.wheel.radius_m),
                              field(rover.wheel.width_m)},
                  ","));
  }
  writeFile(path, text);
}

namespace {

// Elevation, slip and energy over the steps of a drive. The energy includes reversing and turning; that of the
// prediction has the predicted energy of each forward step in place of the true one.
planner::Route profileOf(const RecordedTraverse& drive, const costmap::TraversabilityMap& map,
                         bool predicted) {
  planner::Route route;
  const auto& track = drive.result.drive.track;
  double error_J = 0.0;
  for (const planner::TraverseStep& step : drive.log.steps()) {
    const auto next = std::ranges::upper_bound(track, step.time_s, {}, &planner::TrackPoint::time_s);
    const double driven_J = next == track.begin() ? 0.0 : std::prev(next)->energy_J;
    planner::RouteVertex v{
        .x_m = step.place.x_m,
        .y_m = step.place.y_m,
        .slope_along_rad = std::nan(""),
        .slope_across_rad = std::nan(""),
        .slip = predicted ? step.expected_slip : step.truth.slip,
        .category = static_cast<terramech::Category>(map.costs().category(*map.grid().cellAt(step.place))),
        .energy_J = driven_J + (predicted ? error_J : 0.0),
        .time_s = step.time_s,
        .immobilisation_risk = std::nan("")};
    if (!predicted)
      v.elevation_m = maps::elevationAt(map.elevation().elevation_m, step.place).value_or(std::nan(""));
    error_J += (step.expected_energy_J_per_m - step.truth.energy_J_per_m) * step.length_m *
               std::hypot(1.0, step.gradient);
    route.vertices.push_back(v);
  }
  return route;
}

}  // namespace

RecordedTraverse recordedTraverse(const planner::SimulationSite& site, planner::SoilKnowledge belief,
                                  const ProgressMonitor& watch) {
  const planner::TrueWorld world = site.trueWorld(0);
  costmap::TraversabilityMap map = site.estimatedMap(belief, world);
  RecordedTraverse out{{}, {{}, {}, world.patches(), map.grid()}};
  const std::vector<std::uint8_t> before = map.costs().categories().values();
  std::vector<std::uint8_t> known = before;
  planner::SimulationOptions options = site.options(belief, 0);
  options.watch = {.progress = {}, .stop = watch.stop};
  options.record = true;
  options.on_step = [&](const planner::TraverseStep& step) { out.log.record(step); };
  options.on_learned = [&](double time_s) {
    std::vector<std::uint8_t> now = map.costs().categories().values();
    const int width = map.grid().width;
    for (std::size_t i = 0; i < now.size(); ++i)
      if (now[i] != known[i])
        out.story.changes.push_back(
            {time_s, {static_cast<int>(i) % width, static_cast<int>(i) / width}, now[i]});
    known = std::move(now);
  };
  out.result.drive = planner::simulateTraverse(map, world, options);
  for (std::size_t i = 0; i < before.size(); ++i)
    out.result.categories_changed += before[i] != known[i] ? 1U : 0U;
  out.story.drive = out.result.drive;
  return out;
}

std::string predictionText(const RecordedTraverse& drive) {
  const planner::PredictionErrors errors = drive.log.errors();
  return fmt::format("slip error {:.3f} rms, total energy error {:+.1f} %", errors.slip_rmse,
                     100.0 * errors.energy_error);
}

void saveTraversePage(const std::filesystem::path& path, const planner::SimulationSite& site,
                      planner::SoilKnowledge belief, const RecordedTraverse& drive,
                      const planner::RouteOrigin& origin) {
  const costmap::TraversabilityMap map = site.estimatedMap(belief, site.trueWorld(0));
  Scene scene =
      sceneOf(map, {.title = fmt::format("Simulated traverse: {}", label(drive.result.drive.outcome))});
  scene.subtitle = fmt::format("soil knowledge: {}; categories before the drive", label(belief));
  scene.facts = factsOf(drive.result);
  scene.story = drive.story;
  scene.facts.emplace_back("predicted", predictionText(drive));
  const planner::SimulationOptions options = site.options(belief, 0);
  scene.marks = {{"S", options.start}, {"G", options.goal}};
  for (const bool predicted : {false, true})
    scene.routes.push_back(
        {predicted ? "predicted before each step" : "driven", profileOf(drive, map, predicted)});
  addProvenance(scene, origin);
  saveScene(scene, path, "");
}

}  // namespace talus::cli
