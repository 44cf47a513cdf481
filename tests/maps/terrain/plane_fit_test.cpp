#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <Eigen/Dense>

#include <talus/maps/terrain/plane_fit.hpp>

namespace talus::maps {
namespace footprint_test {

TEST(Footprint, ContainsCellsWithCentresWithinTheRadius) {
  for (const double radius : {1.5, 2.0, 2.9, 5.0, 7.3}) {
    const Footprint disc = discFootprint(radius);
    std::set<std::pair<int, int>> held;
    for (const auto& o : disc.offsets) held.insert({o.column, o.row});
    ASSERT_EQ(held.size(), disc.offsets.size());
    // Closed form, by brute force: every cell of a larger square is checked.
    for (int row = -9; row <= 9; ++row)
      for (int column = -9; column <= 9; ++column)
        EXPECT_EQ(held.contains({column, row}), std::hypot(column, row) <= radius + 1e-9)
            << radius << ": " << column << ' ' << row;
  }
}

TEST(Footprint, SmallRadiusYieldsThreeByThreeCells) {
  EXPECT_EQ(discFootprint(0.1).offsets.size(), 9U);
  EXPECT_EQ(discFootprint(0.1).reach, 1);
}

TEST(Footprint, MomentsMatchTheOffsets) {
  for (const double radius : {1.0, 3.0, 6.4}) {
    const Footprint disc = discFootprint(radius);
    double x = 0.0, xy = 0.0, xx = 0.0, yy = 0.0;
    int reach = 0;
    for (const auto& o : disc.offsets) {
      x += o.column, xy += o.column * o.row;
      xx += o.column * o.column, yy += o.row * o.row;
      reach = std::max(reach, std::abs(o.column));
    }
    // Property: the footprint is symmetric, so that the plane's normal equations are diagonal.
    EXPECT_EQ(x, 0.0);
    EXPECT_EQ(xy, 0.0);
    EXPECT_EQ(xx, yy);
    EXPECT_EQ(disc.sum_xx, xx);
    EXPECT_EQ(disc.reach, reach);
  }
}

}  // namespace footprint_test

namespace partial_plane_test {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

TEST(PartialPlane, MatchesLeastSquaresOverCellsWithData) {
  const Grid grid{.width = 9, .height = 9, .resolution_m = 0.5, .south_west = {}};
  const Footprint disc = discFootprint(2.0);
  std::mt19937 random(11);
  std::uniform_real_distribution<float> height(-1.0F, 1.0F), chance(0.0F, 1.0F);
  int fitted = 0;
  for (int trial = 0; trial < 200; ++trial) {
    Raster<float> z(grid);
    for (float& value : z.values()) value = chance(random) < 0.4F ? kNaN : height(random);
    const Cell cell{static_cast<int>(random() % 9), static_cast<int>(random() % 9)};
    const auto fit = fitPartialPlane(z, disc, cell);
    if (!fit) continue;
    ++fitted;
    // Closed form: independent least squares by QR decomposition (Eigen) over the cells with data.
    std::vector<Eigen::Vector3d> seen;
    for (const auto& o : disc.offsets) {
      const Cell c{cell.column + o.column, cell.row + o.row};
      if (grid.contains(c) && !std::isnan(z[c]))
        seen.emplace_back(0.5 * o.column, 0.5 * o.row, static_cast<double>(z[c]));
    }
    Eigen::MatrixX3d a(static_cast<Eigen::Index>(seen.size()), 3);
    Eigen::VectorXd b(a.rows());
    for (Eigen::Index i = 0; i < a.rows(); ++i) {
      const Eigen::Vector3d& p = seen[static_cast<std::size_t>(i)];
      a.row(i) << p.x(), p.y(), 1.0;
      b(i) = p.z();
    }
    const Eigen::Vector3d plane = a.colPivHouseholderQr().solve(b);
    const Eigen::VectorXd residual = b - a * plane;
    // Tolerance: heights of 1 m as floats.
    EXPECT_NEAR(fit->dz_dx, plane.x(), 1e-5);
    EXPECT_NEAR(fit->dz_dy, plane.y(), 1e-5);
    EXPECT_NEAR(fit->roughness_m, std::sqrt(residual.squaredNorm() / static_cast<double>(b.size())), 1e-5);
    EXPECT_NEAR(fit->relief_m, residual.maxCoeff() - residual.minCoeff(), 1e-5);
  }
  EXPECT_GT(fitted, 60);
}

TEST(PartialPlane, TooFewOrCollinearCellsYieldNoPlane) {
  const Grid grid{.width = 5, .height = 5, .resolution_m = 1.0, .south_west = {}};
  Raster<float> z(grid, kNaN);
  const Footprint disc = discFootprint(1.5);
  EXPECT_FALSE(fitPartialPlane(z, disc, {2, 2}));
  for (int column = 0; column < 5; ++column) z[{column, 2}] = 1.0F;
  EXPECT_FALSE(fitPartialPlane(z, disc, {2, 2})) << "all in one line";
  EXPECT_FALSE(fitPartialPlane(z, disc, {2, 3})) << "the middle has no data";
}

}  // namespace partial_plane_test

namespace plane_kernel_test {

struct Fitted {
  std::vector<float> dz_dx, dz_dy, roughness_m, relief_m;
};

Fitted fitted(PlaneKernel kernel, const Footprint& disc, const std::vector<std::vector<float>>& rows,
              int width) {
  const auto n = static_cast<std::size_t>(width);
  Fitted out{std::vector<float>(n), std::vector<float>(n), std::vector<float>(n), std::vector<float>(n)};
  std::vector<const float*> heights;
  for (const auto& row : rows) heights.push_back(row.data() + disc.reach);
  kernel(disc, {.heights = heights.data(),
                .width = width,
                .cells_per_metre = 2.0F,
                .dz_dx = out.dz_dx.data(),
                .dz_dy = out.dz_dy.data(),
                .roughness_m = out.roughness_m.data(),
                .relief_m = out.relief_m.data()});
  return out;
}

std::vector<std::vector<float>> rowsOf(const Footprint& disc, int width, auto&& height) {
  std::vector<std::vector<float>> rows;
  for (int r = -disc.reach; r <= disc.reach; ++r) {
    auto& row = rows.emplace_back();
    for (int c = -disc.reach; c < width + disc.reach + kPlaneLanes; ++c) row.push_back(height(c, r));
  }
  return rows;
}

TEST(PlaneKernel, FitReproducesAPlane) {
  const Footprint disc = discFootprint(2.5);
  const auto rows = rowsOf(
      disc, 13, [](int c, int r) { return 0.125F * static_cast<float>(c) - 0.25F * static_cast<float>(r); });
  const Fitted out = fitted(planeKernel(), disc, rows, 13);
  for (std::size_t i = 0; i < 13; ++i) {
    // Closed form: cells of half a metre. Tolerance: float.
    EXPECT_NEAR(out.dz_dx[i], 0.25, 1e-6);
    EXPECT_NEAR(out.dz_dy[i], -0.5, 1e-6);
    EXPECT_NEAR(out.roughness_m[i], 0.0, 1e-6);
    EXPECT_NEAR(out.relief_m[i], 0.0, 2e-6);
  }
}

TEST(PlaneKernel, KernelsAreBitIdentical) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> height(-3.0F, 3.0F), chance(0.0F, 1.0F);
  for (const double radius : {1.0, 2.5, 4.0}) {
    const Footprint disc = discFootprint(radius);
    const auto rows = rowsOf(disc, 37, [&](int, int) {
      const float z = height(random);
      return chance(random) < 0.02F ? std::numeric_limits<float>::quiet_NaN() : z;
    });
    const Fitted plain = fitted(fitPlanesBaseline, disc, rows, 37),
                 fast = fitted(planeKernel(), disc, rows, 37);
    // Property: NaN occurs in the same places; other values are bit-identical.
    const auto same = [](float a, float b) {
      return (std::isnan(a) && std::isnan(b)) ||
             std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
    };
    for (std::size_t i = 0; i < 37; ++i) {
      EXPECT_TRUE(same(plain.dz_dx[i], fast.dz_dx[i])) << i;
      EXPECT_TRUE(same(plain.dz_dy[i], fast.dz_dy[i])) << i;
      EXPECT_TRUE(same(plain.roughness_m[i], fast.roughness_m[i])) << i;
      EXPECT_TRUE(same(plain.relief_m[i], fast.relief_m[i])) << i;
    }
  }
}

// Property: kernels are bit-identical for heights far below the datum, where single precision is coarse.
#if defined(__x86_64__)
TEST(PlaneKernel, KernelsAreBitIdenticalFarFromTheDatum) {
  if (!__builtin_cpu_supports("avx2")) GTEST_SKIP() << "this processor has no AVX2";
  const Footprint footprint = discFootprint(3.2);
  const int width = 61;
  const int stride = width + 2 * footprint.reach + kPlaneLanes;
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(-4501.0F, -4499.0F);
  std::vector<float> heights(static_cast<std::size_t>(stride * (2 * footprint.reach + 1)));
  for (float& h : heights) h = uniform(random);
  heights[200] = std::numeric_limits<float>::quiet_NaN();
  std::vector<const float*> rows;
  for (int r = 0; r <= 2 * footprint.reach; ++r)
    rows.push_back(heights.data() + r * stride + footprint.reach);
  const auto bits = [&](PlaneKernel kernel) {
    std::vector<float> out(static_cast<std::size_t>(4 * width));
    kernel(footprint, {.heights = rows.data(),
                       .width = width,
                       .cells_per_metre = 0.3F,
                       .dz_dx = out.data(),
                       .dz_dy = out.data() + width,
                       .roughness_m = out.data() + 2 * width,
                       .relief_m = out.data() + 3 * width});
    std::vector<std::uint32_t> words;
    for (float v : out) words.push_back(std::bit_cast<std::uint32_t>(v));
    return words;
  };
  EXPECT_EQ(bits(fitPlanesBaseline), bits(fitPlanesAvx2));
}
#endif

}  // namespace plane_kernel_test

}  // namespace talus::maps
