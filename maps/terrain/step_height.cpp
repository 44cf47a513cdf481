#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include <talus/maps/terrain/step_height.hpp>

namespace talus::maps {
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

}  // namespace talus::maps
