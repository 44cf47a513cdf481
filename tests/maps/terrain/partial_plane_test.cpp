#include <limits>
#include <random>

#include <Eigen/Dense>

#include <talus/maps/terrain/plane_fit.hpp>

namespace talus::maps {
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
}  // namespace talus::maps
