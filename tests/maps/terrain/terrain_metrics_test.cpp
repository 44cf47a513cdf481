#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <refused.hpp>

#include <talus/common/common.hpp>
#include <talus/maps/maps.hpp>
#include <talus/maps/terrain/plane_fit.hpp>

namespace talus::maps {
namespace terrain_metrics_test {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

TEST(ElevationMap, ValidFractionIsTheShareOfCellsWithData) {
  Raster<float> z({.width = 4, .height = 2, .resolution_m = 1.0, .south_west = {}}, 1.0F);
  EXPECT_EQ(validFraction(z), 1.0);
  z[{1, 1}] = z[{3, 0}] = kNaN;
  EXPECT_EQ(validFraction(z), 0.75);
}

TEST(ElevationMap, InterpolationIsBilinear) {
  const Grid grid{.width = 6, .height = 5, .resolution_m = 2.0, .south_west = {100.0, 50.0}};
  Raster<float> z(grid);
  // Closed form: bilinear interpolation reproduces a + b x + c y + d x y.
  const auto height = [](Point p) { return 3.0 + 0.5 * p.x_m - 0.25 * p.y_m + 0.125 * p.x_m * p.y_m; };
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column)
      z[{column, row}] = static_cast<float>(height(grid.centre({column, row})));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> x(101.0, 111.0), y(51.0, 59.0);
  for (int i = 0; i < 200; ++i) {
    const Point p{x(random), y(random)};
    const auto seen = elevationAt(z, p);
    ASSERT_TRUE(seen);
    EXPECT_NEAR(*seen, height(p), 1e-3);  // tolerance: float storage of some 700 m
  }
}

// Closed form: between the outermost centres and the edge of the map the elevation is not extrapolated.
TEST(ElevationMap, ElevationIsConstantBeyondTheOutermostCentres) {
  Raster<float> z(Grid{.width = 3, .height = 2, .resolution_m = 2.0});
  for (int r = 0; r < 2; ++r)
    for (int c = 0; c < 3; ++c) z[{c, r}] = static_cast<float>(10 * c + r);
  EXPECT_EQ(elevationAt(z, {0.1, 0.1}), 0.0);
  EXPECT_EQ(elevationAt(z, {5.9, 3.9}), 21.0);
  EXPECT_EQ(elevationAt(z, {2.0, 3.9}), 6.0);
  EXPECT_FALSE(elevationAt(z, {6.0, 1.0}));
}

TEST(ElevationMap, OutsideTheMapAndNextToNoDataThereIsNoElevation) {
  Raster<float> z({.width = 4, .height = 4, .resolution_m = 1.0, .south_west = {}}, 5.0F);
  z[{1, 1}] = kNaN;
  EXPECT_FALSE(elevationAt(z, {-0.1, 2.0}));
  EXPECT_FALSE(elevationAt(z, {2.0, 4.1}));
  EXPECT_FALSE(elevationAt(z, {1.6, 1.6}));
  EXPECT_EQ(elevationAt(z, {3.2, 3.2}), 5.0);
}

using testing::HasSubstr;

std::string refusal(const auto& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

ElevationMap localMap() {
  return {.elevation_m =
              Raster<float>(Grid{.width = 10, .height = 20, .resolution_m = 2.0, .south_west = {100, -50}}),
          .georeference = std::nullopt,
          .source = "yard.tif",
          .notes = {}};
}

TEST(Place, ParsesMetresAndDegrees) {
  EXPECT_EQ(std::get<Point>(parsePlace("12.5,-3e2")), (Point{12.5, -300}));
  EXPECT_EQ(std::get<Point>(parsePlace(" +1 , 2")), (Point{1, 2}));
  const GeoPoint place = std::get<GeoPoint>(parsePlace("-4.59d,137.44d"));
  EXPECT_DOUBLE_EQ(place.latitude_rad, -4.59 * kDegree);
  EXPECT_DOUBLE_EQ(place.longitude_rad, 137.44 * kDegree);
}

TEST(Place, InvalidTextIsQuotedInTheError) {
  for (const char* text : {"", "1", "1,2,3", "a,b", "1,", "nan,1", "1d,2", "91d,0d", "0d,361d", "1,2x",
                           "inf,0", "1;2", "010,1", "1d,-007d"}) {
    const std::string line = refusal([&] { parsePlace(text); });
    EXPECT_THAT(line, testing::AllOf(testing::StartsWith("'"), HasSubstr(text)));
    EXPECT_THAT(line, HasSubstr("write x,y in map metres"));
  }
}

TEST(Place, PositionOutsideTheMapIsRejectedWithTheMapExtent) {
  EXPECT_EQ(locate(Point{119.9, -50}, localMap(), "--start"), (Point{119.9, -50}));
  EXPECT_THAT(refusal([] {
                locate(Point{5, 900}, localMap(), "--start 5,900");
              }),
              HasSubstr("--start 5,900: x 5 m, y 900 m lies outside the map; the map spans x 100 to 120 m, y "
                        "-50 to -10 m"));
  EXPECT_THAT(refusal([] { locate(GeoPoint{}, localMap(), "--goal"); }), HasSubstr("'yard.tif' has no CRS"));
}

// Property: points on the border of the map, as stated in the message about its extent, are inside the map.
TEST(Place, MapBorderIsInsideTheMap) {
  const ElevationMap map = localMap();
  for (const Point corner : {Point{100, -50}, Point{120, -50}, Point{100, -10}, Point{120, -10}}) {
    const Point at = locate(corner, map, "--goal");
    EXPECT_TRUE(map.grid().cellAt(at));
    EXPECT_NEAR(at.x_m, corner.x_m, 1e-5);
    EXPECT_NEAR(at.y_m, corner.y_m, 1e-5);
  }
  EXPECT_THAT(refusal([&] {
                locate(Point{120.0001, -20}, map, "--goal");
              }),
              HasSubstr("lies outside the map"));
}

TEST(Place, DegreesAreConvertedByTheMapGeoreference) {
  ElevationMap map = localMap();
  map.georeference.emplace(CoordinateSystem{.name = "Moon", .ellipsoid = kMoon});
  const GeoPoint place = map.georeference->reverse({110, -30});
  const Point point = locate(place, map, "--goal");
  EXPECT_NEAR(point.x_m, 110, 1e-6);
  EXPECT_NEAR(point.y_m, -30, 1e-6);
  EXPECT_EQ(describe(point, map), "x 110.00 m, y -30.00 m (-0.000989d,0.003628d)");
  EXPECT_THAT(refusal([&] {
                locate(GeoPoint{0.5, 0.5}, map, "--goal");
              }),
              HasSubstr("at 28.647890d,28.647890d lies outside"));
  // Degrees without their suffix, in either order.
  for (const Point bare : {Point{-0.000989, 0.003628}, Point{0.003628, -0.000989}})
    EXPECT_THAT(refusal([&] { locate(bare, map, "--goal"); }), HasSubstr("write -0.000989d,0.003628d"));
  EXPECT_EQ(locate(Point{110, -30}, map, "--goal"), (Point{110, -30}));
}

TEST(Place, WindowRequiresFourNumbersOfOneUnit) {
  const Window window = parseWindow("1,2,3,4");
  EXPECT_EQ(std::get<Point>(window.second), (Point{3, 4}));
  for (const char* mixed : {"5,5,65d,65d", "5d,5d,65,65"})
    EXPECT_THAT(refusal([&] { parseWindow(mixed); }), HasSubstr("one corner is in metres")) << mixed;
  EXPECT_THAT(refusal([] { parseWindow("1,2,3"); }), HasSubstr("has not 4 numbers"));
}

// Height of a step under a rover, independent of the plane over the footprint.

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
