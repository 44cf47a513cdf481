#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <talus/common/parallel_for.hpp>
#include <talus/maps/maps.hpp>
#include <talus/maps/terrain/plane_fit.hpp>
#include <talus/maps/terrain/step_height.hpp>

namespace talus::maps {
namespace {

constexpr float kNoValue = std::numeric_limits<float>::quiet_NaN();

// Computes the metrics of strips of rows from copies of the heights with a margin of NaN.
class Strips {
 public:
  Strips(const Raster<float>& elevation_m, const Footprint& footprint, const StepReach& steps,
         TerrainMetrics& out)
      : elevation_m_(elevation_m),
        footprint_(footprint),
        steps_(steps),
        out_(out),
        margin_(std::max(footprint.reach, steps.cells())),
        stride_(static_cast<std::size_t>(elevation_m.grid().width + 2 * margin_ +
                                         std::max(kPlaneLanes, 2 * kStepLanes))) {}

  void measure(Rows strip) const {
    const auto [first, last] = strip;
    std::vector<float> buffer;
    copyRows(first - margin_, last + margin_, buffer);
    std::vector<const float*> rows(static_cast<std::size_t>(last - first + 2 * margin_));
    for (std::size_t i = 0; i < rows.size(); ++i)
      rows[i] = buffer.data() + i * stride_ + static_cast<std::size_t>(margin_);
    std::vector<float*> steps;
    for (int row = first; row < last; ++row) steps.push_back(out_.step_m.row(row));
    const float* const* here = rows.data() + margin_;
    const int width = elevation_m_.grid().width;
    step_kernel_(steps_, {.heights = here, .step_m = steps.data(), .width = width, .count = last - first});
    for (int row = first; row < last; ++row) {
      kernel_(footprint_, planeRow(here + (row - first) - footprint_.reach, row));
      fitRowEdges(row);
    }
  }

 private:
  PlaneRow planeRow(const float* const* heights, int row) const {
    return {.heights = heights,
            .width = elevation_m_.grid().width,
            .cells_per_metre = static_cast<float>(1 / elevation_m_.grid().resolution_m),
            .dz_dx = out_.dz_dx.row(row),
            .dz_dy = out_.dz_dy.row(row),
            .roughness_m = out_.roughness_m.row(row),
            .relief_m = out_.relief_m.row(row)};
  }

  void copyRows(int first, int last, std::vector<float>& buffer) const {
    buffer.assign(stride_ * static_cast<std::size_t>(last - first), kNoValue);
    const Grid& grid = elevation_m_.grid();
    for (int row = std::max(first, 0); row < std::min(last, grid.height); ++row)
      std::copy_n(elevation_m_.row(row), grid.width,
                  buffer.data() + static_cast<std::size_t>(row - first) * stride_ +
                      static_cast<std::size_t>(margin_));
  }

  // Fits the cells with an incomplete footprint by the cells of the footprint that have data.
  void fitRowEdges(int row) const {
    const float* heights = elevation_m_.row(row);
    const float* gradient = out_.dz_dx.row(row);
    for (int column = 0; column < elevation_m_.grid().width; ++column) {
      if (!std::isnan(gradient[column])) continue;
      const Cell cell{column, row};
      const auto fit =
          std::isnan(heights[column]) ? std::nullopt : fitPartialPlane(elevation_m_, footprint_, cell);
      set(cell, fit);
    }
  }

  void set(Cell c, const std::optional<PlaneFit>& fit) const {
    out_.dz_dx[c] = fit ? static_cast<float>(fit->dz_dx) : kNoValue;
    out_.dz_dy[c] = fit ? static_cast<float>(fit->dz_dy) : kNoValue;
    out_.roughness_m[c] = fit ? static_cast<float>(fit->roughness_m) : kNoValue;
    out_.relief_m[c] = fit ? static_cast<float>(fit->relief_m) : kNoValue;
    if (!fit) out_.step_m[c] = kNoValue;
  }

  const Raster<float>& elevation_m_;
  const Footprint& footprint_;
  const StepReach& steps_;
  TerrainMetrics& out_;
  int margin_;  // width of the NaN margin [cells]
  std::size_t stride_;
  PlaneKernel kernel_ = planeKernel();
  StepKernel step_kernel_ = stepKernel();
};

void check(const FootprintOptions& options) {
  if (!std::isfinite(options.radius_m) || options.radius_m < 0)
    throw std::invalid_argument("footprint: radius_m = " + std::to_string(options.radius_m) +
                                ", must be finite and >= 0");
  if (!std::isfinite(options.step_span_m) || options.step_span_m < 0)
    throw std::invalid_argument("footprint: step_span_m = " + std::to_string(options.step_span_m) +
                                ", must be finite and >= 0");
  if (options.threads < 1)
    throw std::invalid_argument("footprint: threads = " + std::to_string(options.threads) + ", must be >= 1");
}

// Standard error of a gradient for n residuals of root mean square 1, with n - 3 degrees of freedom.
double gradientStd(const Footprint& footprint, double resolution_m) {
  const auto n = static_cast<double>(footprint.offsets.size());
  return std::sqrt(n / (n - 3)) / (resolution_m * std::sqrt(footprint.sum_xx));
}

// A length in cells, limited to the longer side of the map.
double inCells(double length_m, const Grid& grid) {
  return std::min<double>(length_m / grid.resolution_m, std::max(grid.width, grid.height));
}

int spanCells(double span_cells) {
  return std::max(1, static_cast<int>(span_cells * (1 + 1e-9)));
}

}  // namespace

int metricsReach(const FootprintOptions& options, double resolution_m) {
  const int radius = static_cast<int>(std::ceil(options.radius_m / resolution_m));
  return radius + 2 * spanCells(options.step_span_m / resolution_m);
}

float TerrainMetrics::slope_rad(Cell c) const {
  return std::atan(std::hypot(dz_dx[c], dz_dy[c]));
}

float TerrainMetrics::aspect_rad(Cell c) const {
  return std::atan2(-dz_dy[c], -dz_dx[c]);
}

TerrainMetrics terrainMetrics(const Raster<float>& elevation_m, const FootprintOptions& options,
                              const ProgressMonitor& watch) {
  check(options);
  const Grid& grid = elevation_m.grid();
  const double radius_cells = inCells(options.radius_m, grid);
  const Footprint footprint = discFootprint(radius_cells);
  const StepReach steps = StepReach::of(radius_cells, spanCells(inCells(options.step_span_m, grid)));
  TerrainMetrics out{.dz_dx = Raster<float>(grid, kNoValue),
                     .dz_dy = Raster<float>(grid, kNoValue),
                     .roughness_m = Raster<float>(grid, kNoValue),
                     .relief_m = Raster<float>(grid, kNoValue),
                     .step_m = Raster<float>(grid, kNoValue),
                     .footprint_cells = static_cast<int>(footprint.offsets.size()),
                     .fell_back = options.radius_m / grid.resolution_m < std::sqrt(2.0) * (1 - 1e-12),
                     .gradient_std_per_roughness = gradientStd(footprint, grid.resolution_m)};
  const Strips strips(elevation_m, footprint, steps, out);
  forEachStrip({.rows = grid.height, .threads = options.threads}, watch,
               [&](Rows rows) { strips.measure(rows); });
  return out;
}

}  // namespace talus::maps
