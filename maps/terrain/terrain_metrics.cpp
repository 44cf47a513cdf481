#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>

#include <talus/common/parallel_for.hpp>
#include <talus/maps/terrain/plane_fit.hpp>

namespace talus::maps {

Footprint discFootprint(double radius_cells) {
  // A radius of sqrt(2) includes the diagonal neighbours: the 3x3 block.
  const double squared = std::fmax(radius_cells * radius_cells, 2.0) * (1 + 1e-12);
  Footprint out;
  out.reach = static_cast<int>(std::sqrt(squared));
  for (int row = -out.reach; row <= out.reach; ++row)
    for (int column = -out.reach; column <= out.reach; ++column) {
      if (column * column + row * row > squared) continue;
      out.offsets.push_back({column, row});
      out.sum_xx += column * column;
    }
  return out;
}

namespace {

// Calls visit(dx, dy, height above the central cell) for each cell of the footprint with data.
void forEachValid(const Raster<float>& elevation_m, const Footprint& footprint, Cell cell,
                  const auto& visit) {
  const auto middle = static_cast<double>(elevation_m[cell]);
  for (const auto [dx, dy] : footprint.offsets) {
    const Cell c{cell.column + dx, cell.row + dy};
    if (!elevation_m.grid().contains(c) || std::isnan(elevation_m[c])) continue;
    visit(static_cast<double>(dx), static_cast<double>(dy), static_cast<double>(elevation_m[c]) - middle);
  }
}

struct Sums {
  double n = 0, x = 0, y = 0, h = 0, xx = 0, xy = 0, yy = 0, xh = 0, yh = 0;
};

Sums sums(const Raster<float>& elevation_m, const Footprint& footprint, Cell cell) {
  Sums s;
  forEachValid(elevation_m, footprint, cell, [&s](double x, double y, double h) {
    s.n += 1;
    s.x += x;
    s.y += y;
    s.h += h;
    s.xx += x * x;
    s.xy += x * y;
    s.yy += y * y;
    s.xh += x * h;
    s.yh += y * h;
  });
  return s;
}

}  // namespace

std::optional<PlaneFit> fitPartialPlane(const Raster<float>& elevation_m, const Footprint& footprint,
                                        Cell cell) {
  if (std::isnan(elevation_m[cell])) return std::nullopt;
  const Sums s = sums(elevation_m, footprint, cell);
  if (s.n < 4 || 4 * s.n < static_cast<double>(footprint.offsets.size())) return std::nullopt;
  // Normal equations relative to the mean.
  const double xx = s.xx - s.x * s.x / s.n;
  const double xy = s.xy - s.x * s.y / s.n;
  const double yy = s.yy - s.y * s.y / s.n;
  const double xh = s.xh - s.x * s.h / s.n;
  const double yh = s.yh - s.y * s.h / s.n;
  const double determinant = xx * yy - xy * xy;
  if (determinant < 1e-9) return std::nullopt;  // sums of integers: the determinant is 0 or of order 1
  const double east = (yy * xh - xy * yh) / determinant;
  const double north = (xx * yh - xy * xh) / determinant;
  const double base = (s.h - east * s.x - north * s.y) / s.n;
  double squares = 0;
  double highest = -std::numeric_limits<double>::infinity();
  double lowest = std::numeric_limits<double>::infinity();
  forEachValid(elevation_m, footprint, cell, [&](double x, double y, double h) {
    const double residual = h - base - east * x - north * y;
    squares += residual * residual;
    highest = std::max(highest, residual);
    lowest = std::min(lowest, residual);
  });
  const double resolution_m = elevation_m.grid().resolution_m;
  return PlaneFit{east / resolution_m, north / resolution_m, std::sqrt(squares / s.n), highest - lowest};
}

namespace {

// GCC compiles the lanes for the registers of the target processor. Each lane is rounded separately, without
// contraction or reordering, so that results are bitwise equal on all processors.
using Lanes = float __attribute__((vector_size(kPlaneLanes * sizeof(float))));

[[gnu::always_inline]] inline void load(Lanes& to, const float* from) {
  std::memcpy(&to, from, sizeof to);
}

[[gnu::always_inline]] inline void store(const Lanes& from, float* to, int count) {
  std::memcpy(to, &from, static_cast<std::size_t>(count) * sizeof(float));
}

// Heights are relative to the central cell and therefore small enough for single precision.
// a = sum(h) / n,  b = sum(x h) / sum(x^2),  c = sum(y h) / sum(y^2)       (sums of x, y, x y vanish)
[[gnu::always_inline]] inline void fitBlock(const Footprint& footprint, const PlaneRow& row, int column) {
  const auto count = static_cast<float>(footprint.offsets.size());
  const auto sum_xx = static_cast<float>(footprint.sum_xx);
  const float* const* middle = row.heights + footprint.reach;
  Lanes centre;
  load(centre, middle[0] + column);
  Lanes sum{};
  Lanes sum_x{};
  Lanes sum_y{};
  for (const auto [dx, dy] : footprint.offsets) {
    Lanes h;
    load(h, middle[dy] + column + dx);
    h -= centre;
    sum += h;
    sum_x += h * static_cast<float>(dx);
    sum_y += h * static_cast<float>(dy);
  }
  const Lanes mean = sum / count;
  const Lanes east = sum_x / sum_xx;
  const Lanes north = sum_y / sum_xx;
  Lanes squares{};
  Lanes highest{};
  Lanes lowest{};
  for (const auto [dx, dy] : footprint.offsets) {
    Lanes r;
    load(r, middle[dy] + column + dx);
    r -= centre;
    r -= mean + east * static_cast<float>(dx) + north * static_cast<float>(dy);
    squares += r * r;
    highest = r > highest ? r : highest;
    lowest = r < lowest ? r : lowest;
  }
  Lanes rms = squares / count;
  for (int lane = 0; lane < kPlaneLanes; ++lane) rms[lane] = std::sqrt(rms[lane]);
  const Lanes range = highest - lowest + mean * 0.0F;  // comparisons ignore NaN; the mean propagates NaN
  const int lanes = std::min(kPlaneLanes, row.width - column);
  store(east * row.cells_per_metre, row.dz_dx + column, lanes);
  store(north * row.cells_per_metre, row.dz_dy + column, lanes);
  store(rms, row.roughness_m + column, lanes);
  store(range, row.relief_m + column, lanes);
}

[[gnu::always_inline]] inline void fitRow(const Footprint& footprint, const PlaneRow& row) {
  for (int column = 0; column < row.width; column += kPlaneLanes) fitBlock(footprint, row, column);
}

}  // namespace

void fitPlanesBaseline(const Footprint& footprint, const PlaneRow& row) {
  fitRow(footprint, row);
}

#if defined(__x86_64__)
[[gnu::target("avx2")]] void fitPlanesAvx2(const Footprint& footprint, const PlaneRow& row) {
  fitRow(footprint, row);
}

PlaneKernel planeKernel() {
  return __builtin_cpu_supports("avx2") ? fitPlanesAvx2 : fitPlanesBaseline;
}
#else
void fitPlanesAvx2(const Footprint& footprint, const PlaneRow& row) {
  fitRow(footprint, row);
}

PlaneKernel planeKernel() {
  return fitPlanesBaseline;
}
#endif

namespace {

// GCC compiles the vector type for the target's registers, as in plane_kernel.cpp.
using StepLanes = float __attribute__((vector_size(kStepLanes * sizeof(float))));

[[gnu::always_inline]] inline void loadStep(StepLanes& to, const float* from) {
  std::memcpy(&to, from, sizeof to);
}

struct Offset {
  int column = 0, row = 0;
};

// The directions of pairs: east, north, and both diagonals.
constexpr std::array<Offset, 4> kLines{{{1, 0}, {0, 1}, {1, 1}, {-1, 1}}};

// Sets `out` to the maximum of `out` and |rise - minmod(before, after)|, the rise between two cells without
// the shared slope.
template <bool kHoles>
[[gnu::always_inline]] inline void excess(StepLanes& out, StepLanes rise, StepLanes before, StepLanes after,
                                          bool diagonal) {
  const StepLanes zero{};
  if constexpr (kHoles) {
    const StepLanes given = before;
    before = before == before ? before : after;
    after = after == after ? after : given;
    if (!diagonal) {
      before = before == before ? before : zero;
      after = after == after ? after : zero;
    }
  }
  const StepLanes lesser = before < after ? before : after;
  const StepLanes greater = before > after ? before : after;
  const StepLanes shared = (lesser > zero ? lesser : zero) + (greater < zero ? greater : zero);
  StepLanes found = rise - shared;
  if constexpr (kHoles) found += before * 0.0F;  // NaN for a diagonal without data on either side
  found = found < zero ? -found : found;
  out = found > out ? found : out;
}

// Steps of the pairs that end in eight cells. A pair with a NaN height has no effect, because NaN compares
// false.
template <bool kHoles>
[[gnu::always_inline]] inline void stepsAt(StepLanes& out, const float* const* rows, int column, int span) {
  out = StepLanes{};
  StepLanes middle;
  loadStep(middle, rows[0] + column);
  for (int apart = 1; apart <= span; ++apart)
#pragma GCC unroll 4
    for (const Offset line : kLines) {
      std::array<StepLanes, 5> heights;
#pragma GCC unroll 5
      for (int k = -2; k <= 2; ++k)
        loadStep(heights[static_cast<std::size_t>(k + 2)],
                 rows[k * apart * line.row] + column + k * apart * line.column);
      const StepLanes first = heights[1] - heights[0], second = middle - heights[1],
                      third = heights[3] - middle, fourth = heights[4] - heights[3];
      const bool diagonal = line.row != 0 && line.column != 0;
      excess<kHoles>(out, second, first, third, diagonal);
      excess<kHoles>(out, third, second, fourth, diagonal);
    }
}

[[gnu::always_inline]] inline bool anyHole(const float* heights, int from, int to) {
  StepLanes sum{};
  for (int column = from; column < to; column += kStepLanes) {
    StepLanes some;
    loadStep(some, heights + column);
    sum += some * 0.0F;
  }
  float total = 0.0F;
  for (int lane = 0; lane < kStepLanes; ++lane) total += sum[lane];
  return std::isnan(total);
}

// Columns whose steps depend on no missing height.
struct Clean {
  int from = 0, past = 0;
};

// Returns the columns for the faster variant without missing heights: in most rows all blocks except the
// outermost.
[[gnu::always_inline]] inline Clean cleanColumns(const float* const* rows, int width, int span) {
  if (width < kStepLanes) return {};
  for (int row = -2 * span; row <= 2 * span; ++row)
    if (anyHole(rows[row], 0, width - kStepLanes + 1) || anyHole(rows[row], width - kStepLanes, width))
      return {};
  return {2 * span, width - 2 * span};
}

// Returns the maximum over the half width `to` on either side, given the maximum over the smaller half width
// `from`.
[[gnu::always_inline]] inline void widen(const float* steps, float* wide, int from, int to, int width) {
  for (int column = 0; column < width; column += kStepLanes) {
    StepLanes best;
    loadStep(best, wide + column);
    for (int off = from + 1; off <= to; ++off)
      for (const int side : {-off, off}) {
        StepLanes other;
        loadStep(other, steps + column + side);
        best = other > best ? other : best;
      }
    std::memcpy(wide + column, &best, sizeof best);
  }
}

[[gnu::always_inline]] inline void raise(float* step_m, const float* wide, int width) {
  int column = 0;
  for (; column + kStepLanes <= width; column += kStepLanes) {
    StepLanes best, other;
    loadStep(best, step_m + column);
    loadStep(other, wide + column);
    best = other > best ? other : best;
    std::memcpy(step_m + column, &best, sizeof best);
  }
  for (; column < width; ++column) step_m[column] = std::max(step_m[column], wide[column]);
}

// Each row of steps is computed once and applied to all rows that its disc reaches.
[[gnu::always_inline]] inline void measureStrip(const StepReach& reach, const StepRows& rows,
                                                std::vector<float>& steps, std::vector<float>& wide) {
  const int radius = static_cast<int>(reach.half_widths.size()) - 1;
  for (int row = 0; row < rows.count; ++row) std::fill_n(rows.step_m[row], rows.width, 0.0F);
  for (int row = -radius; row < rows.count + radius; ++row) {
    const Clean clean = cleanColumns(rows.heights + row, rows.width, reach.span);
    for (int column = -radius; column < rows.width + radius; column += kStepLanes) {
      StepLanes found;
      if (column >= clean.from && column + kStepLanes <= clean.past)
        stepsAt<false>(found, rows.heights + row, column, reach.span);
      else
        stepsAt<true>(found, rows.heights + row, column, reach.span);
      std::memcpy(steps.data() + column + radius, &found, sizeof found);
    }
    std::copy_n(steps.data() + radius, rows.width, wide.data());
    int half_width = 0;
    for (int off = radius; off >= 0; --off) {
      widen(steps.data() + radius, wide.data(), half_width, reach.half_widths[static_cast<std::size_t>(off)],
            rows.width);
      half_width = reach.half_widths[static_cast<std::size_t>(off)];
      for (const int to : {row - off, row + off})
        if (to >= 0 && to < rows.count && (off != 0 || to == row))
          raise(rows.step_m[to], wide.data(), rows.width);
    }
  }
}

std::vector<float> buffer(const StepReach& reach, int width) {
  return std::vector<float>(static_cast<std::size_t>(width + 2 * reach.cells() + 2 * kStepLanes));
}

}  // namespace

StepReach StepReach::of(double radius_cells, int span_cells) {
  StepReach out{.half_widths = {}, .span = std::max(1, span_cells)};
  const double squared = radius_cells * radius_cells * (1 + 1e-12);
  for (int row = 0; row * row <= squared; ++row)
    out.half_widths.push_back(static_cast<int>(std::sqrt(squared - row * row)));
  return out;
}

void measureStepsBaseline(const StepReach& reach, const StepRows& rows) {
  std::vector<float> steps = buffer(reach, rows.width), wide = steps;
  measureStrip(reach, rows, steps, wide);
}

#if defined(__x86_64__)
[[gnu::target("avx2")]] void measureStepsAvx2(const StepReach& reach, const StepRows& rows) {
  std::vector<float> steps = buffer(reach, rows.width), wide = steps;
  measureStrip(reach, rows, steps, wide);
}

StepKernel stepKernel() {
  return __builtin_cpu_supports("avx2") ? measureStepsAvx2 : measureStepsBaseline;
}
#else
void measureStepsAvx2(const StepReach& reach, const StepRows& rows) {
  measureStepsBaseline(reach, rows);
}

StepKernel stepKernel() {
  return measureStepsBaseline;
}
#endif

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
