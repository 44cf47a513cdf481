#include <algorithm>
#include <cmath>
#include <vector>

#include <costmap/hazards.hpp>
#include <costmap/rock_hazard.hpp>

namespace talus::costmap {
namespace {

constexpr auto kInflated = Hazard::KeepOut | Hazard::Obstacle | Hazard::Unknown;

bool touches(Hazard a, Hazard set) noexcept {
  return (static_cast<std::uint8_t>(a) & static_cast<std::uint8_t>(set)) != 0;
}

Hazard judged(const HazardLimits& limits, double gradient, double step_m, double roughness_m) {
  Hazard found = Hazard::None;
  if (gradient > limits.max_gradient) found |= Hazard::Slope;
  if (step_m > limits.max_step_m) found |= Hazard::Step;
  if (roughness_m > limits.max_roughness_m) found |= Hazard::Roughness;
  return found;
}

// Offsets of the cells whose nearest point lies closer than the radius to a cell at the origin.
std::vector<maps::Cell> discOffsets(double radius_cells) {
  std::vector<maps::Cell> disc;
  const int reach = static_cast<int>(std::ceil(radius_cells + 0.5));
  for (int row = -reach; row <= reach; ++row)
    for (int column = -reach; column <= reach; ++column) {
      const double dx = std::max(std::abs(column) - 0.5, 0.0);
      const double dy = std::max(std::abs(row) - 0.5, 0.0);
      if ((row != 0 || column != 0) && std::hypot(dx, dy) < radius_cells) disc.push_back({column, row});
    }
  return disc;
}

bool onEdge(const maps::Raster<Hazard>& hazards, maps::Cell cell) {
  for (const maps::Cell step : {maps::Cell{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
    const maps::Cell next{cell.column + step.column, cell.row + step.row};
    if (hazards.grid().contains(next) && !touches(hazards[next], kInflated)) return true;
  }
  return false;
}

}  // namespace

HazardLimits HazardLimits::of(const terramech::Rover& rover) {
  const double width_m = rover.track_m + rover.wheel.width_m;
  const double length_m = rover.wheelbase_m + 2.0 * rover.wheel.radius_m;
  return {.max_gradient = std::hypot(std::tan(rover.max_pitch_rad), std::tan(rover.max_roll_rad)),
          .max_step_m = rover.clearance_m,
          .max_roughness_m = rover.clearance_m / 3.0,
          .rock_diameter_m = 2.0 * rover.clearance_m,
          .rock_area_m2 = width_m * length_m,
          .wheelbase_m = rover.wheelbase_m,
          .inflation_m = 0.5 * width_m};
}

double reliefShare(const HazardLimits& limits, double footprint_m) {
  return std::min(1.0, limits.wheelbase_m / footprint_m);
}

maps::Raster<Hazard> findHazards(const HazardLayers& layers, const HazardLimits& limits) {
  const maps::Grid& grid = layers.elevation_m.grid();
  maps::Raster<Hazard> hazards(grid);
  const double footprint_m =
      2.0 * grid.resolution_m *
      std::max(1.0, std::sqrt(layers.metrics.footprint_cells / 3.14159265358979) - 0.5);
  const double share = reliefShare(limits, footprint_m);
  const RockCrossing crossing{.diameter_m = limits.rock_diameter_m, .area_m2 = limits.rock_area_m2};
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const auto& m = layers.metrics;
    const double gradient =
        std::hypot(static_cast<double>(m.dz_dx.values()[i]), static_cast<double>(m.dz_dy.values()[i]));
    Hazard& found = hazards.values()[i];
    if (std::isnan(layers.elevation_m.values()[i]) || std::isnan(gradient)) found |= Hazard::Unknown;
    found |= judged(limits, gradient, share * static_cast<double>(m.step_m.values()[i]),
                    share * static_cast<double>(m.roughness_m.values()[i]));
    if (!layers.rock_abundance.empty() && rockHazard(static_cast<double>(layers.rock_abundance.values()[i]),
                                                     crossing) > limits.max_rock_probability)
      found |= Hazard::Rocks;
    if (!layers.keep_out.empty() && layers.keep_out.values()[i] != 0) found |= Hazard::KeepOut;
  }
  return hazards;
}

void inflate(maps::Raster<Hazard>& hazards, const HazardLimits& limits) {
  const maps::Grid& grid = hazards.grid();
  const auto disc = discOffsets(limits.inflation_m / grid.resolution_m);
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column) {
      const maps::Cell cell{column, row};
      if (!touches(hazards[cell], kInflated) || !onEdge(hazards, cell)) continue;
      for (const maps::Cell offset : disc) {
        const maps::Cell near{column + offset.column, row + offset.row};
        if (grid.contains(near)) hazards[near] |= Hazard::Near;
      }
    }
}

}  // namespace talus::costmap
