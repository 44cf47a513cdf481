#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

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

}  // namespace talus::maps
