// Height of a step under a rover, independent of the plane over the footprint.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <talus/maps/maps.hpp>
#include <talus/maps/terrain/step_height.hpp>

namespace talus::maps {
namespace step_height_test {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

Raster<float> surface(const Grid& grid, const auto& height) {
  Raster<float> z(grid);
  for (int r = 0; r < grid.height; ++r)
    for (int c = 0; c < grid.width; ++c) {
      const Point p = grid.centre({c, r});
      z[{c, r}] = static_cast<float>(height(p.x_m, p.y_m));
    }
  return z;
}

// The definition, pair by pair, in double precision.
class SlowSteps {
 public:
  SlowSteps(const Raster<float>& z, double radius_cells, int span)
      : z_(z), radius_(radius_cells), span_(span) {}

  double at(Cell middle) const {
    double highest = 0.0;
    for (int row = 0; row < z_.grid().height; ++row)
      for (int column = 0; column < z_.grid().width; ++column)
        for (int apart = 1; apart <= span_; ++apart)
          for (const Cell line : {Cell{1, 0}, Cell{0, 1}, Cell{1, 1}, Cell{1, -1}}) {
            const Cell first{column, row}, last{column + apart * line.column, row + apart * line.row};
            if (near(first, middle) || near(last, middle))
              highest = std::max(highest, pair(first, {last.column - column, last.row - row}));
          }
    return highest;
  }

 private:
  bool near(Cell a, Cell b) const { return std::hypot(a.column - b.column, a.row - b.row) <= radius_ + 1e-9; }

  double height(Cell c) const { return z_.grid().contains(c) ? static_cast<double>(z_[c]) : std::nan(""); }

  double pair(Cell first, Cell by) const {
    const auto at = [&](int k) { return height({first.column + k * by.column, first.row + k * by.row}); };
    const double rise = at(1) - at(0);
    double before = at(0) - at(-1), after = at(2) - at(1);
    if (std::isnan(rise)) return 0.0;
    if (std::isnan(before) && std::isnan(after)) {
      if (by.column != 0 && by.row != 0) return 0.0;
      before = after = 0.0;
    }
    if (std::isnan(before)) before = after;
    if (std::isnan(after)) after = before;
    double shared = 0.0;
    if (before * after > 0.0) shared = std::abs(before) < std::abs(after) ? before : after;
    return std::abs(rise - shared);
  }

  const Raster<float>& z_;
  double radius_;
  int span_;
};

// Property: the kernel equals the definition on rough ground with holes, for any footprint and span.
TEST(StepHeight, MatchesThePairwiseDefinition) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int trial = 0; trial < 24; ++trial) {
    const Grid grid{.width = 5 + trial, .height = 29 - trial, .resolution_m = 0.5, .south_west = {}};
    const double holes = trial % 3 == 0 ? 0.0 : 0.04 * (trial % 5);
    const Raster<float> z = surface(grid, [&](double x, double y) {
      return uniform(random) < holes ? std::nan("") : 0.4 * x - 0.2 * y + 0.3 * uniform(random);
    });
    const double radius = 0.7 * (trial % 6);
    const int span = 1 + trial % 4;
    const TerrainMetrics m = terrainMetrics(z, {.radius_m = 0.5 * radius, .step_span_m = 0.5 * span});
    const SlowSteps slow(z, radius, span);
    for (int row = 0; row < grid.height; ++row)
      for (int column = 0; column < grid.width; ++column) {
        const Cell c{column, row};
        ASSERT_EQ(std::isnan(m.step_m[c]), std::isnan(m.dz_dx[c])) << trial;
        // Heights below 20 m in single precision: four errors of 1e-6 m.
        if (!std::isnan(m.step_m[c])) {
          ASSERT_NEAR(static_cast<double>(m.step_m[c]), slow.at(c), 1e-5)
              << trial << ' ' << column << ' ' << row;
        }
      }
  }
}

// Property: the step at a vertical edge in any direction on any slope is at least the height of the edge.
TEST(StepHeight, VerticalStepHasItsHeightForAnyCellSizeSlopeAndDirection) {
  for (const double cell_m : {0.1, 0.25, 0.5, 1.0})
    for (const double slope : {0.0, 0.2, -0.45})
      for (int k = 0; k < 12; ++k) {
        const double turn = k * std::numbers::pi / 12 + 0.01;
        const Grid grid{.width = 25, .height = 25, .resolution_m = cell_m, .south_west = {}};
        const Point middle = grid.centre({12, 12});
        const auto across = [&](double x, double y) {
          return (x - middle.x_m) * std::cos(turn) + (y - middle.y_m) * std::sin(turn) - 0.3 * cell_m;
        };
        const Raster<float> z =
            surface(grid, [&](double x, double y) { return slope * x + (across(x, y) > 0 ? 0.4 : 0.0); });
        const TerrainMetrics m = terrainMetrics(z, {.radius_m = 0.7, .step_span_m = 0.25});
        for (int row = 5; row < 20; ++row)
          for (int column = 5; column < 20; ++column) {
            const Point p = grid.centre({column, row});
            if (std::abs(across(p.x_m, p.y_m)) > 0.7 * cell_m) continue;
            // Closed form: 0.4 m. Single precision.
            ASSERT_GE((m.step_m[{column, row}]), 0.4F - 1e-5F) << cell_m << ' ' << slope << ' ' << turn;
          }
      }
}

// Property: smooth ground has no step except the change of slope between cells, curvature times the square
// of the distance.
TEST(StepHeight, SmoothSteepGroundHasNoStep) {
  for (const double cell_m : {0.25, 1.0}) {
    const Grid grid{.width = 80, .height = 80, .resolution_m = cell_m, .south_west = {}};
    const Raster<float> plane = surface(grid, [](double x, double y) { return 0.466 * x + 0.1 * y; });
    const TerrainMetrics flat = terrainMetrics(plane, {.radius_m = 0.7, .step_span_m = 0.5});
    // Closed form: 25 degrees, 0. Heights up to 40 m in single precision.
    EXPECT_LT(*std::ranges::max_element(flat.step_m.values()), 2e-5F);
    // A dune of 25 degrees, 40 m from crest to crest: its curvature is 0.466 * 2 pi / 40 = 0.073 /m.
    const double k = 2 * std::numbers::pi / 40;
    const Raster<float> dune = surface(grid, [&](double x, double) { return 0.466 / k * std::sin(k * x); });
    const TerrainMetrics smooth = terrainMetrics(dune, {.radius_m = 0.7, .step_span_m = 0.5});
    const double distance_m = std::max(cell_m, 0.5);
    // For a diagonal pair the squared distance is doubled and the curvature along the pair is halved: the
    // product is equal.
    EXPECT_LT(*std::ranges::max_element(smooth.step_m.values()), 1.05 * 0.466 * k * distance_m * distance_m);
  }
}

// Property: a scarp that resampling spread over a wheel diameter has its full height.
TEST(StepHeight, ScarpWithinTheSpanHasItsFullHeight) {
  const Grid grid{.width = 61, .height = 5, .resolution_m = 0.1, .south_west = {}};
  const Raster<float> z =
      surface(grid, [](double x, double) { return 0.4 * std::clamp((x - 3.05) / 0.3, 0.0, 1.0); });
  EXPECT_NEAR((terrainMetrics(z, {.step_span_m = 0.3}).step_m[{30, 2}]), 0.4, 1e-6);
  // Closed form: adjacent cells differ by a third of the height.
  EXPECT_NEAR((terrainMetrics(z, {}).step_m[{30, 2}]), 0.4 / 3, 1e-6);
}

// Property: all kernels are bit-identical, with and without NaN, for wide and narrow maps.
TEST(StepHeight, KernelsAreBitIdentical) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> uniform(-4501.0F, -4499.0F);
  for (const int span : {1, 3})
    for (const double radius : {0.0, 1.0, 3.7}) {
      const StepReach reach = StepReach::of(radius, span);
      constexpr int kWidth = 43, kRows = 9;
      const int stride = kWidth + 2 * reach.cells() + 2 * kStepLanes;
      std::vector<float> heights(static_cast<std::size_t>(stride * (kRows + 2 * reach.cells())));
      for (float& z : heights) z = random() % 60 == 0 ? kNaN : uniform(random);
      std::vector<const float*> from;
      for (int r = 0; r < kRows + 2 * reach.cells(); ++r)
        from.push_back(heights.data() + r * stride + reach.cells());
      const auto bits = [&](StepKernel kernel) {
        std::vector<float> out(static_cast<std::size_t>(kWidth * kRows), kNaN);
        std::vector<float*> to;
        for (int r = 0; r < kRows; ++r) to.push_back(out.data() + r * kWidth);
        kernel(
            reach,
            {.heights = from.data() + reach.cells(), .step_m = to.data(), .width = kWidth, .count = kRows});
        std::vector<std::uint32_t> words;
        for (const float v : out) words.push_back(std::bit_cast<std::uint32_t>(v));
        return words;
      };
      EXPECT_EQ(bits(measureStepsBaseline), bits(stepKernel()));
    }
}

}  // namespace step_height_test
}  // namespace talus::maps
