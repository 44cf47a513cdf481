#include <algorithm>
#include <cmath>

#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/costmap/surface/surface_shape.hpp>

namespace talus::costmap {
namespace {

constexpr int kBandRows = 4 * CostTile::kSide;

double footprintWidth(const maps::TerrainMetrics& metrics, double resolution_m, double radius_m) {
  return metrics.fell_back ? 2.0 * resolution_m : 2.0 * radius_m;
}

}  // namespace

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
