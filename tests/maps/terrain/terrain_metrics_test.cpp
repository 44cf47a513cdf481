#include <cmath>
#include <limits>
#include <random>

#include <Eigen/Dense>
#include <refused.hpp>

#include <talus/maps/maps.hpp>

namespace talus::maps {
namespace terrain_metrics_test {

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

Raster<float> noise(const Grid& grid, double share_of_holes) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  return surface(grid, [&](double x, double y) {
    const double z = -4500 + 0.3 * x - 0.1 * y + uniform(random);
    return uniform(random) < share_of_holes ? std::numeric_limits<double>::quiet_NaN() : z;
  });
}

struct Expected {
  double dz_dx, dz_dy, roughness_m, relief_m;
};

// Measured by others: least squares by Eigen's QR on the cells of the disc; slow.
Expected leastSquares(const Raster<float>& z, Cell middle, double radius_m) {
  const Grid& grid = z.grid();
  std::vector<Eigen::Vector3d> points;
  for (int r = 0; r < grid.height; ++r)
    for (int c = 0; c < grid.width; ++c) {
      const double dx = (c - middle.column) * grid.resolution_m;
      const double dy = (r - middle.row) * grid.resolution_m;
      if (std::hypot(dx, dy) > radius_m + 1e-9 || std::isnan(z[{c, r}])) continue;
      points.emplace_back(dx, dy, static_cast<double>(z[{c, r}]));
    }
  const auto n = static_cast<Eigen::Index>(points.size());
  Eigen::MatrixX3d a(n, 3);
  Eigen::VectorXd b(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Vector3d& p = points[static_cast<std::size_t>(i)];
    a.row(i) << p.x(), p.y(), 1.0;
    b(i) = p.z();
  }
  const Eigen::Vector3d plane = a.colPivHouseholderQr().solve(b);
  const Eigen::VectorXd residual = b - a * plane;
  return {plane.x(), plane.y(), std::sqrt(residual.squaredNorm() / static_cast<double>(n)),
          residual.maxCoeff() - residual.minCoeff()};
}

TEST(TerrainMetrics, TiltedPlaneIsExactIncludingEdges) {
  const Grid grid{.width = 37, .height = 21, .resolution_m = 0.5, .south_west = {1000, -300}};
  const Raster<float> z = surface(grid, [](double x, double y) { return 0.25 * x - 0.5 * y; });
  for (double radius_m : {0.0, 1.0, 2.6}) {
    const TerrainMetrics m = terrainMetrics(z, {.radius_m = radius_m});
    for (int r = 0; r < grid.height; ++r)
      for (int c = 0; c < grid.width; ++c) {
        // Closed form: a plane. Heights are multiples of 1/16 m, so that nothing is rounded.
        ASSERT_NEAR((m.dz_dx[{c, r}]), 0.25, 1e-6);
        ASSERT_NEAR((m.dz_dy[{c, r}]), -0.5, 1e-6);
        ASSERT_NEAR((m.roughness_m[{c, r}]), 0.0, 1e-6);
        ASSERT_NEAR((m.relief_m[{c, r}]), 0.0, 2e-6);
        ASSERT_EQ((m.step_m[{c, r}]), 0.0F);
        ASSERT_NEAR((m.slope_rad({c, r})), std::atan(std::hypot(0.25, 0.5)), 1e-6);
        ASSERT_NEAR((m.aspect_rad({c, r})), std::atan2(0.5, -0.25), 1e-6);
      }
  }
}

TEST(TerrainMetrics, MatchesLeastSquaresOnRoughGroundWithHoles) {
  const Grid grid{.width = 45, .height = 33, .resolution_m = 2.0};
  for (double holes : {0.0, 0.02})
    for (double radius_m : {2.83, 4.0, 7.3}) {
      const Raster<float> z = noise(grid, holes);
      const TerrainMetrics m = terrainMetrics(z, {.radius_m = radius_m, .threads = 2});
      for (Cell c : {Cell{0, 0}, Cell{44, 32}, Cell{3, 1}, Cell{20, 16}, Cell{31, 8}, Cell{10, 31}}) {
        if (std::isnan(z[c])) continue;
        const Expected e = leastSquares(z, c, radius_m);
        // Single precision of heights about -4500 m: 2.4e-4 m.
        EXPECT_NEAR(m.dz_dx[c], e.dz_dx, 1e-6);
        EXPECT_NEAR(m.dz_dy[c], e.dz_dy, 1e-6);
        EXPECT_NEAR(m.roughness_m[c], e.roughness_m, 1e-5);
        EXPECT_NEAR(m.relief_m[c], e.relief_m, 1e-5);
      }
    }
}

TEST(TerrainMetrics, SmallFootprintFallsBackToThreeByThreeAndReportsIt) {
  const Raster<float> z = noise({.width = 9, .height = 9, .resolution_m = 5.0}, 0.0);
  const TerrainMetrics small = terrainMetrics(z, {.radius_m = 0.6});
  const TerrainMetrics block = terrainMetrics(z, {.radius_m = 5.0 * std::sqrt(2.0)});
  EXPECT_TRUE(small.fell_back);
  EXPECT_FALSE(block.fell_back);
  EXPECT_EQ(small.footprint_cells, 9);
  EXPECT_EQ(small.dz_dx.values(), block.dz_dx.values());
}

TEST(TerrainMetrics, ReliefOfARockEqualsItsHeight) {
  // Closed form: over many cells a single rock has little influence on the plane.
  Raster<float> z(Grid{.width = 41, .height = 41, .resolution_m = 0.1});
  z[{20, 20}] = 0.4F;
  const TerrainMetrics m = terrainMetrics(z, {.radius_m = 0.8});
  EXPECT_NEAR((m.relief_m[{20, 20}]), 0.4, 1e-6);
  EXPECT_NEAR((m.relief_m[{16, 20}]), 0.4, 0.02);
  EXPECT_EQ((m.relief_m[{5, 5}]), 0.0F);
}

TEST(TerrainMetrics, NoDataIsPreserved) {
  Raster<float> z(Grid{.width = 20, .height = 12, .resolution_m = 1.0}, kNaN);
  // A single cell, three in a corner, and a line of cells define no plane; a block of four does.
  z[{2, 2}] = 1.0F;
  for (int i = 0; i < 3; ++i) z[{6 + i, 9}] = 1.0F;
  for (Cell c : {Cell{15, 5}, Cell{16, 5}, Cell{15, 6}, Cell{16, 6}}) z[c] = 3.0F;
  const TerrainMetrics m = terrainMetrics(z, {});
  EXPECT_TRUE(std::isnan(m.dz_dx[{2, 2}]));
  EXPECT_TRUE(std::isnan(m.roughness_m[{7, 9}]));
  EXPECT_TRUE(std::isnan(m.dz_dx[{0, 0}]));
  EXPECT_TRUE(std::isnan(m.relief_m[{14, 5}]));
  EXPECT_TRUE(std::isnan(m.step_m[{14, 5}]));
  EXPECT_EQ((m.step_m[{15, 5}]), 0.0F);
  EXPECT_EQ((m.dz_dx[{15, 5}]), 0.0F);
}

TEST(TerrainMetrics, ResultIsIndependentOfThreadCount) {
  const Raster<float> z = noise({.width = 133, .height = 301, .resolution_m = 1.0}, 0.01);
  const auto bits = [&](int threads) {
    const TerrainMetrics m = terrainMetrics(z, {.radius_m = 2.0, .threads = threads});
    std::vector<std::uint32_t> out;
    for (const Raster<float>* layer : {&m.dz_dx, &m.dz_dy, &m.roughness_m, &m.relief_m, &m.step_m})
      for (float v : layer->values()) out.push_back(std::bit_cast<std::uint32_t>(v));
    return out;
  };
  EXPECT_EQ(bits(1), bits(2));
  EXPECT_EQ(bits(1), bits(5));
}

TEST(TerrainMetrics, GradientStdMatchesScatterUnderWhiteNoise) {
  // Property: the stated standard error equals the spread of gradients from white noise.
  const TerrainMetrics m =
      terrainMetrics(noise({.width = 300, .height = 300, .resolution_m = 2.0}, 0.0), {.radius_m = 5.0});
  double spread = 0;
  double stated = 0;
  int n = 0;
  for (int r = 5; r < 295; ++r)
    for (int c = 5; c < 295; ++c, ++n) {
      spread += std::pow(static_cast<double>(m.dz_dx[{c, r}]) - 0.3, 2);
      stated += std::pow(static_cast<double>(m.roughness_m[{c, r}]) * m.gradient_std_per_roughness, 2);
    }
  EXPECT_NEAR(std::sqrt(spread / stated), 1.0, 0.02);
}

TEST(TerrainMetrics, StopsOnRequest) {
  std::stop_source source;
  source.request_stop();
  const TerrainMetrics m = terrainMetrics(noise({.width = 50, .height = 50}, 0.0), {},
                                          {.progress = {}, .stop = source.get_token()});
  EXPECT_TRUE(std::isnan(m.dz_dx[{25, 25}]));
}

TEST(TerrainMetrics, InvalidOptionsAreRejected) {
  const Raster<float> z(Grid{.width = 4, .height = 4});
  EXPECT_REFUSED(terrainMetrics(z, {.radius_m = -1}), std::invalid_argument,
                 "radius_m = -1.000000, must be finite and >= 0");
  EXPECT_REFUSED(terrainMetrics(z, {.radius_m = std::nan("")}), std::invalid_argument,
                 "radius_m = nan, must be finite and >= 0");
  EXPECT_REFUSED(terrainMetrics(z, {.step_span_m = -1}), std::invalid_argument,
                 "step_span_m = -1.000000, must be finite and >= 0");
  EXPECT_REFUSED(terrainMetrics(z, {.threads = 0}), std::invalid_argument, "threads = 0, must be >= 1");
}

}  // namespace terrain_metrics_test
}  // namespace talus::maps
