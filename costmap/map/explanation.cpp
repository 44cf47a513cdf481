#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include <talus/costmap/costmap.hpp>
#include <talus/costmap/evidence/class_evidence.hpp>
#include <talus/costmap/ground/cost_curve_table.hpp>
#include <talus/costmap/map/ground_curves.hpp>

namespace talus::costmap {
namespace {

constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

// Terrain metrics of a cell, computed in the smallest sufficient window around the cell.
maps::TerrainMetrics measuredAround(const TraversabilityMap& map, maps::Cell cell, maps::Cell& inside) {
  const maps::Grid& grid = map.grid();
  const int halo = maps::metricsReach(map.surface().footprint(1), grid.resolution_m) + 1;
  const maps::Cell from{std::max(0, cell.column - halo), std::max(0, cell.row - halo)};
  const maps::Cell to{std::min(grid.width, cell.column + halo + 1),
                      std::min(grid.height, cell.row + halo + 1)};
  maps::Raster<float> window(maps::Grid{.width = to.column - from.column,
                                        .height = to.row - from.row,
                                        .resolution_m = grid.resolution_m,
                                        .south_west = {}});
  for (int row = from.row; row < to.row; ++row)
    for (int column = from.column; column < to.column; ++column)
      window[{column - from.column, row - from.row}] = map.elevation().elevation_m[{column, row}];
  inside = {cell.column - from.column, cell.row - from.row};
  return maps::terrainMetrics(window, map.surface().footprint(1));
}

std::string limitRemark(double value, double limit) {
  if (std::isnan(value)) return "not known";
  return value > limit ? "above the limit " + std::to_string(limit)
                       : "within the limit " + std::to_string(limit);
}

const char* hazardText(Hazard hazard) {
  switch (hazard) {
    case Hazard::Unknown:
      return "elevation or terrain class unknown";
    case Hazard::Slope:
      return "too steep for the rover at any heading";
    case Hazard::Step:
      return "step above the ground clearance";
    case Hazard::Roughness:
      return "roughness above the ground clearance";
    case Hazard::Rocks:
      return "probability of a rock above the ground clearance too high";
    case Hazard::KeepOut:
      return "inside a keep-out polygon";
    case Hazard::Obstacle:
      return "terrain class without a soil, treated as an obstacle";
    case Hazard::Near:
      return "an excluded cell lies within the rover's width";
    case Hazard::None:
      break;
  }
  return "";
}

constexpr std::array<Hazard, 8> kHazards{Hazard::Unknown, Hazard::KeepOut, Hazard::Obstacle,  Hazard::Slope,
                                         Hazard::Step,    Hazard::Rocks,   Hazard::Roughness, Hazard::Near};

void addShape(const TraversabilityMap& map, maps::Cell cell, Explanation& out) {
  maps::Cell inside;
  const maps::TerrainMetrics m = measuredAround(map, cell, inside);
  const double roughness = static_cast<double>(m.roughness_m[inside]);
  const double footprint_m =
      m.fell_back ? 2.0 * map.grid().resolution_m : 2.0 * map.surface().footprintRadius_m();
  const double share = reliefShare(map.surface().limits(), footprint_m);
  const std::string plane =
      "plane through " + std::to_string(m.footprint_cells) + " cells of " + map.elevation().source;
  out.causes.push_back({"elevation_m", static_cast<double>(map.elevation().elevation_m[cell]), kNotKnown,
                        map.elevation().source, ""});
  const double slope = static_cast<double>(m.slope_rad(inside));
  out.causes.push_back({"slope_rad", slope, m.gradient_std_per_roughness * roughness, plane,
                        limitRemark(slope, std::atan(map.surface().limits().max_gradient))});
  out.causes.push_back({"aspect_rad", static_cast<double>(m.aspect_rad(inside)), kNotKnown, plane, ""});
  out.causes.push_back({"roughness_m", share * roughness, kNotKnown, plane + ", within one wheelbase",
                        limitRemark(share * roughness, map.surface().limits().max_roughness_m)});
  const double relief = share * static_cast<double>(m.relief_m[inside]);
  out.causes.push_back({"relief_m", relief, kNotKnown, plane + ", within one wheelbase",
                        limitRemark(relief, map.surface().limits().max_step_m)});
  const double step =
      reliefShare(map.surface().limits(), map.grid().resolution_m) * static_cast<double>(m.step_m[inside]);
  out.causes.push_back(
      {"step_m", step, kNotKnown,
       "differences of heights in " + map.elevation().source + " beyond the slope on both sides",
       limitRemark(step, map.surface().limits().max_step_m)});
}

void addLayers(const TraversabilityMap& map, maps::Cell cell, Explanation& out) {
  for (const CostLayer& layer : map.surface().costLayers()) {
    const auto added = static_cast<double>(layer.added_J_per_m[cell]);
    const bool open = map.model().parts().policy.allow_unknown;
    out.causes.push_back({"layer_" + layer.name + "_J_per_m",
                          std::isnan(added) && open ? static_cast<double>(layer.unseen_J_per_m) : added,
                          kNotKnown, "layer '" + layer.name + "'",
                          std::isinf(added)    ? "excluded for any soil"
                          : !std::isnan(added) ? "part of energy and cost, rounded up by at most a fifth"
                          : open               ? "no data: costs as the highest cell of the layer"
                                               : "no data: excluded as unknown"});
  }
}

// Returns the text of a hazard of a cell, with the name of the layer that causes the hazard.
std::string hazardText(const TraversabilityMap& map, maps::Cell cell, Hazard hazard) {
  for (const CostLayer& layer : map.surface().costLayers()) {
    const float added = layer.added_J_per_m[cell];
    if (hazard == Hazard::KeepOut && std::isinf(added)) return "refused by layer '" + layer.name + "'";
    if (hazard == Hazard::Unknown && std::isnan(added) && !map.model().parts().policy.allow_unknown)
      return "no data in layer '" + layer.name + "'";
  }
  const bool opened =
      map.surface().hazards(cell) == Hazard::Unknown && map.model().parts().policy.allow_unknown;
  if (opened)
    return std::string(
               "elevation or terrain class unknown; allowed on request, at the slope between the heights "
               "beside it, as ") +
           (map.surface().classIndex(cell) >= 0 ? "its class" : "the first class");
  return hazardText(hazard);
}

void addSoil(const TraversabilityMap& map, maps::Cell cell, Explanation& out) {
  const int index = map.surface().classIndex(cell);
  out.causes.push_back({"terrain_class", static_cast<double>(map.surface().classNumber(cell)), kNotKnown,
                        map.model().parts().classes.size() > 1 ? "class raster" : "soil of the map",
                        index < 0 ? "no soil defined for this class" : ""});
  if (index < 0) return;
  const GroundClass& ground = map.model().parts().classes[static_cast<std::size_t>(index)];
  const GroundBelief prior = map.model().prior(index);
  std::string effects;
  for (const terramech::Effect& e : ground.effects) effects += " + " + e.name;
  const std::string source = "soil '" + ground.soil.name + "'" + effects + " under rover '" +
                             map.model().rover().name + "', slip 0.5";
  out.causes.push_back({"prior_drawbar_pull_over_load", prior.pull.value, prior.pull.std, source, ""});
  const CellBelief belief = map.belief(cell);
  const bool of_prior = belief.evidence <= 0.0F && belief.pull_mean == static_cast<float>(prior.pull.value) &&
                        belief.sinkage_mean == static_cast<float>(prior.sinkage.value);
  const std::string wheels = of_prior ? source : "prior and wheel telemetry";
  out.causes.push_back({"evidence_samples", static_cast<double>(belief.evidence), kNotKnown,
                        "wheel telemetry nearby",
                        belief.evidence > 0.0F ? ""
                        : of_prior             ? "no telemetry here; prior only"
                                   : "none counted here: a bound of this place, or telemetry of its class"});
  out.causes.push_back({"drawbar_pull_over_load", static_cast<double>(belief.pull_mean),
                        static_cast<double>(belief.pull_std), wheels, ""});
  out.causes.push_back({"sinkage_over_radius", static_cast<double>(belief.sinkage_mean),
                        static_cast<double>(belief.sinkage_std), wheels, ""});
  const auto published = map.costs().ground(cell);
  if (!published) return;
  const std::string swath = "weakest standing of the wheels about the cell, rounded towards danger";
  out.causes.push_back({"swath_drawbar_pull_over_load", published->pull.value, published->pull.std, swath,
                        "cost is made from it"});
  out.causes.push_back(
      {"swath_sinkage_over_radius", published->sinkage.value, published->sinkage.std, swath, ""});
}

void addDrive(const TraversabilityMap& map, maps::Cell cell, const Direction& heading, Explanation& out) {
  const auto grid = map.published();
  const CellCode code = grid->at(cell);
  const auto [along, across] = gradientOf(code, heading);
  const double margin = map.model().parts().policy.slope_margin_rad;
  const TravelState state = grid->cost().detail(code, heading);
  const std::string asks = "slope along the heading";
  const std::string drives = "mobility curve at the estimated DP/W";
  out.causes.push_back({"slope_along_rad", std::atan(along), kNotKnown, asks, ""});
  out.causes.push_back({"slope_across_rad", std::atan(across), kNotKnown, "slope across the heading", ""});
  out.causes.push_back({"dangerous_below", std::tan(std::atan(along) - margin), kNotKnown, asks,
                        "DP/W below this is dangerous (thesis 3.5)"});
  out.causes.push_back({"safe_above", std::tan(std::atan(along) + margin), kNotKnown, asks,
                        "DP/W above this is safe (thesis 3.5)"});
  if (code.curve() >= CellCode::kUnknown) return;
  out.causes.push_back(
      {"drawbar_pull_margin", static_cast<double>(state.pull_margin), kNotKnown, drives, ""});
  out.causes.push_back({"slip", static_cast<double>(state.slip), kNotKnown, drives, ""});
  const std::string balance = "rover equilibrium on the soil of the class";
  const auto add = [&](const char* name, float value) {
    out.causes.push_back({name, static_cast<double>(value), kNotKnown, balance, ""});
  };
  add("slip_angle_rad", state.slip_angle_rad);
  add("side_force_over_load", state.side_force_over_load);
  if (std::isfinite(state.stability_margin_rad)) add("stability_margin_rad", state.stability_margin_rad);
  out.causes.push_back({"sinkage_m", static_cast<double>(state.sinkage_m), kNotKnown, drives,
                        limitRemark(static_cast<double>(state.sinkage_m), map.model().rover().clearance_m)});
  out.causes.push_back(
      {"torque_Nm", static_cast<double>(state.torque_Nm), kNotKnown, drives,
       limitRemark(static_cast<double>(state.torque_Nm), map.model().rover().max_torque_Nm)});
  out.causes.push_back({"energy_J_per_m", static_cast<double>(state.energy_J_per_m), kNotKnown, drives, ""});
  out.causes.push_back({"immobilisation_per_m", static_cast<double>(state.risk_per_m), kNotKnown,
                        "estimated DP/W compared with required DP/W", ""});
  out.causes.push_back({"cost_J_per_m", static_cast<double>(grid->cost().costPerMetre(code, heading)),
                        kNotKnown, "weighted sum of energy, time and risk", toText(state.refusal)});
}

// Sets category and probability for the requested heading if `asked`, otherwise for the worst heading, from
// the map.
void judge(const TraversabilityMap& map, maps::Cell cell, const Direction& heading, bool asked,
           Explanation& out) {
  const Hazard hazards = map.surface().hazards(cell);
  const bool opened = hazards == Hazard::Unknown && map.model().parts().policy.allow_unknown;
  for (const Hazard one : kHazards)
    if (has(hazards, one))
      out.causes.push_back({"hazard", 1.0, kNotKnown, hazardText(map, cell, one),
                            opened ? "not excluded" : "excluded for any soil"});
  const CellBelief belief = map.belief(cell);
  out.category = static_cast<terramech::Category>(belief.category);
  out.probability = out.category == terramech::Category::Unknown ? kNotKnown : belief.confidence / 16.0;
  out.verdict = std::string(terramech::name(out.category));
  // If the policy allows unknown ground, only hazards other than Unknown exclude the cell.
  const bool unseen = map.model().parts().policy.allow_unknown;
  for (const Hazard one : kHazards)
    if (has(hazards, one) && !opened && !(unseen && one == Hazard::Unknown)) {
      out.verdict += ": " + hazardText(map, cell, one);
      return;
    }
  const auto ground = map.costs().ground(cell);
  if (!ground) {
    out.verdict += map.published()->at(cell).curve() == CellCode::kUnknown
                       ? ": a wheel may touch ground without a soil class"
                       : ": no cost curve is left for this ground";
    return;
  }
  // Uses the cost and the gradient that planners read.
  const CellCode code = map.published()->at(cell);
  const double along = gradientOf(code, heading).along, climb = map.published()->cost().climb(code, heading);
  const TravelState state = map.published()->cost().detail(code, heading);
  const RankedCategory here = judged(map.model(), *ground, state, climb);
  if (asked) out.category = here.category;
  if (here.category == out.category) out.probability = here.probability;
  out.verdict = std::string(terramech::name(out.category)) + ": available DP/W " +
                std::to_string(ground->pull.value) + ", required DP/W " + std::to_string(along);
  if (climb > along + 1.0 / 256)
    out.verdict +=
        climb < 1.0 ? ", with the side force " + std::to_string(climb) : ", side force out of reach";
  if (state.refusal != Refusal::None) out.verdict += std::string("; refused: ") + toText(state.refusal);
  if (opened) out.verdict += "; " + hazardText(map, cell, Hazard::Unknown);
}

// Ground of one block: its class, the standard deviation of its estimate, and the most accurate reading there.
struct Sampled {
  maps::Cell cell;
  int class_index = 0;
  double std = 0.0;
  double error = std::numeric_limits<double>::infinity();  // of a reading; infinite: no heading is allowed
  Direction heading{};
};

// Sets the heading of the most accurate reading of an allowed motion, and its error (B4).
void readIn(const TraversabilityMap& map, Sampled& at) {
  constexpr int kHeadings = 16;
  constexpr double kLeastShare = 0.15;
  const ReadingNoise noise;
  const auto grid = map.published();
  const CellCode code = grid->at(at.cell);
  const auto steady = [&](double slip) { return map.model().steady(at.class_index, {.slip = slip}); };
  for (int k = 0; k < kHeadings; ++k) {
    const double turn = 2.0 * std::numbers::pi * k / kHeadings;
    const Direction heading{std::cos(turn), std::sin(turn)};
    if (!std::isfinite(grid->cost().costPerMetre(code, heading))) continue;
    const auto slip = static_cast<double>(grid->cost().detail(code, heading).slip);
    const double share = steady(slip).torque_over_load_radius /
                         map.model().reference(at.class_index, false).torque_over_load_radius;
    const double rise = (steady(slip + noise.slip).drawbar_pull_over_load -
                         steady(slip - noise.slip).drawbar_pull_over_load) /
                        2.0;
    const double error = std::hypot(noise.model_pull, std::hypot(noise.gradient, rise) / share);
    if (share < kLeastShare || error >= at.error) continue;
    at.error = error;
    at.heading = heading;
  }
}

}  // namespace

Explanation explain(const TraversabilityMap& map, maps::Cell cell, const std::optional<Direction>& heading) {
  Explanation out;
  const Direction direction =
      heading.value_or(worstHeading(map.published()->cost(), map.published()->at(cell)));
  judge(map, cell, direction, heading.has_value(), out);
  addShape(map, cell, out);
  addLayers(map, cell, out);
  addSoil(map, cell, out);
  addDrive(map, cell, direction, out);
  return out;
}

std::optional<NextDrive> nextDrive(const TraversabilityMap& map, maps::Cell around) {
  const double length_m = map.model().parts().policy.correlation_length_m;
  const maps::Grid& grid = map.grid();
  const auto between_m = [&](maps::Cell a, maps::Cell b) {
    return grid.resolution_m * std::hypot(a.column - b.column, a.row - b.row);
  };
  PlaceBeliefs beliefs(map);
  std::vector<Sampled> allowed, uncertain;
  const int side = map.evidence().blockCells();
  for (maps::Cell cell{0, side / 2}; cell.row < grid.height; cell.row += side)
    for (cell.column = side / 2; cell.column < grid.width; cell.column += side) {
      const auto ground = beliefs.ground(cell);
      if (!ground || between_m(cell, around) > 3.0 * length_m || map.surface().hazards(cell) != Hazard::None)
        continue;
      Sampled at{cell, map.surface().classIndex(cell), ground->pull.std};
      if (map.costs().category(cell) != static_cast<std::uint8_t>(terramech::Category::Safe))
        uncertain.push_back(at);
      readIn(map, at);
      if (std::isfinite(at.error)) allowed.push_back(at);
    }
  std::optional<NextDrive> best;
  double variance = 0.0, most = 0.0;
  for (const Sampled& x : uncertain) variance += x.std * x.std;
  for (const Sampled& a : allowed) {
    const double p = map.model().parts().classes[static_cast<std::size_t>(a.class_index)].pull_std,
                 of_class = map.evidence().classBelief(a.class_index).pull.std;
    double gain = 0.0;
    for (const Sampled& x : uncertain) {
      if (x.class_index != a.class_index) continue;
      const double common = std::max(of_class * of_class - p * p, 0.0) +
                            p * p * sparseKernel(between_m(a.cell, x.cell), length_m);
      gain += std::pow(std::min(common, a.std * x.std), 2) / (a.std * a.std + a.error * a.error);
    }
    if (gain <= most) continue;
    most = gain;
    const auto count = static_cast<double>(uncertain.size());
    best = {a.cell, a.heading, uncertain.size(), std::sqrt(variance / count),
            std::sqrt((variance - gain) / count)};
  }
  return best;
}

}  // namespace talus::costmap
