#include <algorithm>
#include <cmath>
#include <cstring>

#include <talus/maps/terrain/plane_kernel.hpp>

namespace talus::maps {
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
