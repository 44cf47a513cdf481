#include <cmath>
#include <numbers>
#include <optional>

#include <talus/costmap/cost/cost_model.hpp>
#include <talus/costmap/surface/surface_shape.hpp>

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

}  // namespace talus::costmap
