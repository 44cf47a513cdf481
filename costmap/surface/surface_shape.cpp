#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <talus/costmap/cost/cost_model.hpp>
#include <talus/costmap/surface/surface_shape.hpp>
#include <talus/costmap/surface/surface_tree.hpp>

namespace talus::costmap {

namespace {

constexpr double kMostCounted = 0.5;

struct Sight {
  double height_m;
  int cells;  // distance of the height [cells]
};

std::optional<Sight> nearest(const maps::Raster<float>& elevation_m, maps::Cell cell, maps::Cell step) {
  for (int cells = 1; cells <= kUnseenReach; ++cells) {
    const maps::Cell there{cell.column + cells * step.column, cell.row + cells * step.row};
    if (!elevation_m.grid().contains(there)) return std::nullopt;
    if (const float z = elevation_m[there]; !std::isnan(z)) return Sight{static_cast<double>(z), cells};
  }
  return std::nullopt;
}

double between(const maps::Raster<float>& elevation_m, maps::Cell cell, maps::Cell step) {
  const auto ahead = nearest(elevation_m, cell, step),
             behind = nearest(elevation_m, cell, {-step.column, -step.row});
  if (!ahead || !behind) return 0.0;
  return (ahead->height_m - behind->height_m) /
         ((ahead->cells + behind->cells) * elevation_m.grid().resolution_m);
}

constexpr int kBandRows = 4 * CostTile::kSide;

double footprintWidth(const maps::TerrainMetrics& metrics, double resolution_m, double radius_m) {
  return metrics.fell_back ? 2.0 * resolution_m : 2.0 * radius_m;
}

}  // namespace

double rockHazard(double abundance, const RockCrossing& crossing) {
  if (!(abundance > 0.0)) return 0.0;
  if (abundance > kMostCounted) return 1.0;
  const double q = 1.79 + 0.152 / abundance;
  const double x = q * crossing.diameter_m;
  const double exponential_integral = -std::expint(-x);  // E1(x)
  const double rocks_per_m2 = 4.0 * abundance * q / std::numbers::pi *
                              (std::exp(-x) / crossing.diameter_m - q * exponential_integral);
  return -std::expm1(-rocks_per_m2 * crossing.area_m2);
}

UnseenSlope unseenSlope(const maps::Raster<float>& elevation_m, maps::Cell cell) {
  return {between(elevation_m, cell, {1, 0}), between(elevation_m, cell, {0, 1})};
}

int SurfaceShape::reach(const maps::Grid& grid) const {
  return std::min(maps::metricsReach(footprint_, grid.resolution_m), std::max(grid.width, grid.height));
}

void SurfaceShape::measure(const maps::Raster<float>& elevation_m, const maps::CellBox& box,
                           const HazardLimits& limits, const Visit& visit,
                           const ProgressMonitor& watch) const {
  const maps::Grid& grid = elevation_m.grid();
  for (int first = box.first.row; first <= box.last.row && !watch.stopped(); first += kBandRows) {
    const maps::CellBox band{{box.first.column, first},
                             {box.last.column, std::min(first + kBandRows - 1, box.last.row)}};
    const maps::CellBox seen = grown(band, reach(grid), grid);
    const maps::TerrainMetrics m = maps::terrainMetrics(cut(elevation_m, seen), footprint_);
    const ShapeJudge judge(limits, {.footprint_m = footprintWidth(m, grid.resolution_m, footprint_.radius_m),
                                    .cell_m = grid.resolution_m});
    forEachCell(band, [&](maps::Cell cell) {
      const std::size_t i =
          m.dz_dx.grid().index({cell.column - seen.first.column, cell.row - seen.first.row});
      const GroundShape shape{m.dz_dx.values()[i], m.dz_dy.values()[i], m.roughness_m.values()[i],
                              m.relief_m.values()[i], m.step_m.values()[i]};
      visit(cell, shape, judge(shape));
    });
    watch.report(static_cast<double>(band.last.row - box.first.row + 1) / box.height());
  }
}

namespace {

constexpr int kMostCells = 65536;
constexpr unsigned kLevels = 17;

int firstKey(int cells) noexcept {
  return kCentreKey - cells / 2;
}

}  // namespace

SurfaceKeys::SurfaceKeys(const maps::Grid& grid, double base_elevation_m)
    : grid_(grid), base_elevation_m_(base_elevation_m) {
  if (std::max(grid.width, grid.height) > kMostCells)
    throw std::invalid_argument("SurfaceKeys: " + std::to_string(std::max(grid.width, grid.height)) +
                                " cells on a side, must be <= 65536");
}

octomap::OcTreeKey SurfaceKeys::key(maps::Cell cell, double elevation_m) const noexcept {
  const double height = std::floor((elevation_m - base_elevation_m_) / grid_.resolution_m) + kCentreKey;
  return {static_cast<octomap::key_type>(firstKey(grid_.width) + cell.column),
          static_cast<octomap::key_type>(firstKey(grid_.height) + cell.row),
          static_cast<octomap::key_type>(std::clamp(height, 0.0, kMostCells - 1.0))};
}

maps::Point SurfaceKeys::origin() const noexcept {
  return {grid_.south_west.x_m + (kCentreKey - firstKey(grid_.width)) * grid_.resolution_m,
          grid_.south_west.y_m + (kCentreKey - firstKey(grid_.height)) * grid_.resolution_m};
}

SurfacePyramid::SurfacePyramid(const maps::Raster<float>& elevation_m, const SurfaceKeys& keys) {
  const maps::Grid& grid = elevation_m.grid();
  const octomap::OcTreeKey first = keys.key({0, 0}, keys.baseElevation_m());
  Level base{first[0], first[1], static_cast<unsigned>(grid.width), static_cast<unsigned>(grid.height), {}};
  base.ranges.resize(grid.size());
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column) {
      const float elevation = elevation_m[{column, row}];
      if (std::isnan(elevation)) continue;
      const auto height = keys.key({column, row}, static_cast<double>(elevation))[2];
      base.ranges[grid.index({column, row})] = {height, height};
    }
  levels_.push_back(std::move(base));
  for (unsigned level = 1; level < kLevels; ++level) {
    const Level& below = levels_.back();
    const unsigned x0 = below.first_x >> 1, y0 = below.first_y >> 1;
    Level next{x0,
               y0,
               ((below.first_x + below.width - 1) >> 1) - x0 + 1,
               ((below.first_y + below.height - 1) >> 1) - y0 + 1,
               {}};
    next.ranges.resize(static_cast<std::size_t>(next.width) * next.height);
    for (unsigned y = 0; y < below.height; ++y)
      for (unsigned x = 0; x < below.width; ++x) {
        const Range from = below.ranges[static_cast<std::size_t>(y) * below.width + x];
        Range& to = next.ranges[static_cast<std::size_t>(((below.first_y + y) >> 1) - y0) * next.width +
                                (((below.first_x + x) >> 1) - x0)];
        to = {std::min(to.low, from.low), std::max(to.high, from.high)};
      }
    levels_.push_back(std::move(next));
  }
}

SurfacePyramid::Range SurfacePyramid::range(unsigned level, unsigned x_key, unsigned y_key) const noexcept {
  const Level& at = levels_[level];
  const unsigned x = (x_key >> level) - at.first_x, y = (y_key >> level) - at.first_y;
  if (x >= at.width || y >= at.height) return {};
  return at.ranges[static_cast<std::size_t>(y) * at.width + x];
}

namespace {

bool touches(Hazard a, Hazard set) noexcept {
  return (static_cast<std::uint8_t>(a) & static_cast<std::uint8_t>(set)) != 0;
}

// Offsets of the cells that have a point closer than the radius to the cell at the origin.
std::vector<maps::Cell> discOffsets(double radius_cells) {
  std::vector<maps::Cell> disc;
  const int reach = static_cast<int>(std::ceil(radius_cells + 0.5));
  for (int row = -reach; row <= reach; ++row)
    for (int column = -reach; column <= reach; ++column) {
      const double dx = std::max(std::abs(column) - 1.0, 0.0);
      const double dy = std::max(std::abs(row) - 1.0, 0.0);
      if ((row != 0 || column != 0) && std::hypot(dx, dy) < radius_cells) disc.push_back({column, row});
    }
  return disc;
}

bool onEdge(const maps::Raster<Hazard>& hazards, maps::Cell cell, Hazard spreading) {
  for (const maps::Cell step : {maps::Cell{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
    const maps::Cell next{cell.column + step.column, cell.row + step.row};
    if (hazards.grid().contains(next) && !touches(hazards[next], spreading)) return true;
  }
  return false;
}

}  // namespace

HazardLimits HazardLimits::ofPoint() {
  return {.max_gradient = kInfinity,
          .max_step_m = kInfinity,
          .max_roughness_m = kInfinity,
          .rock_diameter_m = kInfinity,
          .max_rock_probability = 1.0};
}

HazardLimits HazardLimits::of(const terramech::Rover& rover) {
  const double width_m = rover.track_m + rover.wheel.width_m;
  const double length_m = rover.wheelbase_m + 2.0 * rover.wheel.radius_m;
  return {.max_gradient = std::hypot(std::tan(rover.max_pitch_rad), std::tan(rover.max_roll_rad)),
          .max_step_m = rover.clearance_m,
          .max_roughness_m = rover.clearance_m / 3.0,
          .rock_diameter_m = 2.0 * rover.clearance_m,
          .rock_area_m2 = width_m * length_m,
          .wheelbase_m = rover.wheelbase_m,
          .wheel_diameter_m = 2.0 * rover.wheel.radius_m,
          .inflation_m = 0.5 * width_m};
}

double reliefShare(const HazardLimits& limits, double span_m) {
  return std::min(1.0, limits.wheelbase_m / span_m);
}

ShapeJudge::ShapeJudge(const HazardLimits& limits, const ShapeSpans& spans)
    : gradient_squared_(static_cast<float>(limits.max_gradient * limits.max_gradient)),
      relief_m_(static_cast<float>(limits.max_step_m / reliefShare(limits, spans.footprint_m))),
      step_m_(static_cast<float>(limits.max_step_m / reliefShare(limits, spans.cell_m))),
      roughness_m_(static_cast<float>(limits.max_roughness_m / reliefShare(limits, spans.footprint_m))) {}

Hazard ShapeJudge::operator()(const GroundShape& shape) const noexcept {
  const float squared = shape.dz_dx * shape.dz_dx + shape.dz_dy * shape.dz_dy;
  if (std::isnan(squared)) return Hazard::Unknown;
  Hazard found = Hazard::None;
  if (squared > gradient_squared_) found |= Hazard::Slope;
  if (shape.step_m > step_m_ || shape.relief_m > relief_m_) found |= Hazard::Step;
  if (shape.roughness_m > roughness_m_) found |= Hazard::Roughness;
  return found;
}

namespace {

// Marks cells near the edge of the map as Near, because ground outside the map is unseen.
void keepOffEdge(maps::Raster<Hazard>& hazards, const maps::CellBox& box, int cells) {
  const maps::Grid& grid = hazards.grid();
  for (int row = box.first.row; row <= box.last.row; ++row)
    for (int column = box.first.column; column <= box.last.column; ++column) {
      const int off = std::min({column, row, grid.width - 1 - column, grid.height - 1 - row});
      if (off < cells) hazards[{column, row}] |= Hazard::Near;
    }
}

}  // namespace

int inflationReach(const HazardLimits& limits, double resolution_m) {
  int reach = 0;
  for (const maps::Cell offset : discOffsets(limits.inflation_m / resolution_m))
    reach = std::max(reach, offset.column);
  return reach;
}

void inflate(maps::Raster<Hazard>& hazards, const HazardLimits& limits, Hazard spreading,
             const maps::CellBox& box) {
  const maps::Grid& grid = hazards.grid();
  const auto disc = discOffsets(limits.inflation_m / grid.resolution_m);
  if (touches(Hazard::Unknown, spreading))
    keepOffEdge(hazards, box, static_cast<int>(std::ceil(limits.inflation_m / grid.resolution_m)));
  const maps::CellBox from = grown(box, inflationReach(limits, grid.resolution_m), grid);
  for (int row = from.first.row; row <= from.last.row; ++row)
    for (int column = from.first.column; column <= from.last.column; ++column) {
      const maps::Cell cell{column, row};
      if (!touches(hazards[cell], spreading) || !onEdge(hazards, cell, spreading)) continue;
      for (const maps::Cell offset : disc) {
        const maps::Cell near{column + offset.column, row + offset.row};
        if (contains(box, near)) hazards[near] |= Hazard::Near;
      }
    }
}

void inflate(maps::Raster<Hazard>& hazards, const HazardLimits& limits, Hazard spreading) {
  inflate(hazards, limits, spreading, allOf(hazards.grid()));
}

}  // namespace talus::costmap
