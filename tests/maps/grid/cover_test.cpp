#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include <talus/maps/grid/cover.hpp>

namespace talus::maps {
namespace polygon_cover_test {

const Grid kGrid{.width = 12, .height = 9, .resolution_m = 2.0, .south_west = {100, -50}};

Ring box(double west, double south, double east, double north) {
  return {{west, south}, {east, south}, {east, north}, {west, north}, {west, south}};
}

// Converts a ring in metres from the corner of the grid.
Ring placed(Ring ring) {
  for (Point& p : ring) p = {p.x_m + kGrid.south_west.x_m, p.y_m + kGrid.south_west.y_m};
  return ring;
}

Ring joined(Ring first, const Ring& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

std::size_t closed(const Polygon& polygon) {
  Raster<std::uint8_t> mask(kGrid);
  cover(polygon, mask);
  return static_cast<std::size_t>(std::ranges::count(mask.values(), 1));
}

// Winding number from the sum of angles, independent of the sweep over rows.
int windings(const Ring& ring, Point p) {
  double turned = 0.0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point &a = ring[i], &b = ring[(i + 1) % ring.size()];
    const double ax = a.x_m - p.x_m, ay = a.y_m - p.y_m, bx = b.x_m - p.x_m, by = b.y_m - p.y_m;
    turned += std::atan2(ax * by - ay * bx, ax * bx + ay * by);
  }
  return static_cast<int>(std::lround(turned / (2.0 * std::numbers::pi)));
}

bool isGround(const Polygon& polygon, Point p) {
  int holes = 0;
  for (const Ring& hole : polygon.holes) holes += windings(hole, p);
  return windings(polygon.outer, p) != 0 && holes % 2 == 0;
}

// True if a part of the edge lies in the closed cell (Liang and Barsky).
bool meets(Point a, Point b, Cell cell) {
  const Point middle = kGrid.centre(cell);
  const double half = 0.5 * kGrid.resolution_m;
  double from = 0.0, to = 1.0;
  for (const auto& [start, change, centre] :
       {std::array{a.x_m, b.x_m - a.x_m, middle.x_m}, std::array{a.y_m, b.y_m - a.y_m, middle.y_m}}) {
    if (change == 0.0) {
      if (std::abs(start - centre) > half) return false;
      continue;
    }
    const double enter = (centre - half - start) / change, leave = (centre + half - start) / change;
    from = std::max(from, std::min(enter, leave));
    to = std::min(to, std::max(enter, leave));
  }
  return from <= to + 1e-12;
}

bool boundaryMeets(const Polygon& polygon, Cell cell) {
  const auto any = [&](const Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i)
      if (meets(ring[i], ring[(i + 1) % ring.size()], cell)) return true;
    return false;
  };
  return any(polygon.outer) || std::ranges::any_of(polygon.holes, any);
}

Polygon drawnAtRandom(std::mt19937& random) {
  std::uniform_real_distribution<double> x(92.0, 132.0), y(-58.0, -24.0);
  std::uniform_int_distribution<int> corners(3, 9), holes(0, 2);
  const auto ring = [&] {
    Ring out;
    for (int i = corners(random); i > 0; --i) {
      Point p{x(random), y(random)};
      if (random() % 4 == 0) p = {std::round(p.x_m), std::round(p.y_m)};  // on the lines between cells
      out.push_back(p);
    }
    if (random() % 4 == 0) out = joined(out, out);  // drawn twice
    return out;
  };
  Polygon polygon{.outer = ring()};
  for (int i = holes(random); i > 0; --i) polygon.holes.push_back(ring());
  return polygon;
}

// Property: the cell of every point with a non-zero winding number is covered. A covered cell contains a part
// of the boundary or lies in the polygon; cells set before remain set. Rings may cross themselves.
TEST(PolygonCover, CoversCellsOfNonZeroWindingNumber) {
  std::mt19937 random(20);
  std::uniform_real_distribution<double> column(0.0, 24.0), row(0.0, 18.0);
  Raster<std::uint8_t> all(kGrid);
  for (int i = 0; i < 400; ++i) {
    const Polygon polygon = drawnAtRandom(random);
    if (i % 20 == 0) all = Raster<std::uint8_t>(kGrid);
    const auto before = all.values();
    cover(polygon, all);
    for (std::size_t c = 0; c < before.size(); ++c) ASSERT_LE(before[c], all.values()[c]);
    Raster<std::uint8_t> mask(kGrid);
    cover(polygon, mask);
    for (std::size_t c = 0; c < before.size(); ++c)
      ASSERT_EQ(all.values()[c], std::max(before[c], mask.values()[c]));
    for (int k = 0; k < 400; ++k) {
      const double x = column(random), y = row(random);
      const Cell cell{static_cast<int>(x / 2.0), static_cast<int>(y / 2.0)};
      if (isGround(polygon, {100.0 + x, -50.0 + y})) {
        ASSERT_EQ(mask[cell], 1) << i << ": " << x << ' ' << y;
      }
    }
    for (Cell cell{}; cell.row < kGrid.height; ++cell.row)
      for (cell.column = 0; cell.column < kGrid.width; ++cell.column)
        if (mask[cell] != 0) {
          ASSERT_TRUE(boundaryMeets(polygon, cell) || isGround(polygon, kGrid.centre(cell)))
              << i << ": " << cell.column << ' ' << cell.row;
        }
  }
}

// Closed form: a box of 3 x 2 cells, repeated in the same and in the opposite direction.
TEST(PolygonCover, RepeatedRingCountsOnce) {
  const Ring once = placed(box(2.5, 2.5, 7.5, 5.5));
  EXPECT_EQ(closed({once, {}}), 6U);
  EXPECT_EQ(closed({joined(once, once), {}}), 6U);
  EXPECT_EQ(closed({joined(once, placed(box(4.5, 2.5, 7.5, 5.5))), {}}), 6U);
  EXPECT_EQ(closed({Ring(once.rbegin(), once.rend()), {}}), 6U);
}

// Closed form: of 8 x 8 cells the 4 x 4 cells entirely in the hole are open; an island in the hole is
// covered.
TEST(PolygonCover, HolesStayOpenAndIslandsAreCovered) {
  const Ring outer = placed(box(0.5, 0.5, 15.5, 15.5)), hole = placed(box(3.5, 3.5, 12.5, 12.5));
  EXPECT_EQ(closed({outer, {hole}}), 64U - 16U);
  EXPECT_EQ(closed({outer, {hole, placed(box(6.5, 6.5, 7.5, 7.5))}}), 64U - 15U);
  EXPECT_EQ(closed({outer, {hole, hole}}), 64U);
}

TEST(PolygonCover, RingsWithoutAreaAreDetected) {
  const Ring outer = box(5e6, 5e6, 5e6 + 1.3, 5e6 + 0.7);
  Ring turned = outer;
  turned.pop_back();
  std::ranges::rotate(turned, turned.begin() + 2);
  EXPECT_TRUE(enclosesGround({outer, {}}));
  EXPECT_TRUE(enclosesGround({outer, {box(5e6, 5e6, 5e6 + 1.3, 5e6 + 0.5)}}));
  EXPECT_FALSE(enclosesGround({outer, {outer}}));
  EXPECT_FALSE(enclosesGround({outer, {turned}}));
  EXPECT_FALSE(enclosesGround({outer, {Ring(outer.rbegin(), outer.rend())}}));
  EXPECT_FALSE(enclosesGround({outer, {box(0, 0, 1e7, 1e7)}}));
  EXPECT_FALSE(enclosesGround(
      {outer, {box(5e6, 5e6, 5e6 + 1.3, 5e6 + 0.3), box(5e6, 5e6 + 0.3, 5e6 + 1.3, 5e6 + 0.7)}}));
  EXPECT_FALSE(enclosesGround({joined(outer, Ring(outer.rbegin(), outer.rend())), {}}));
  EXPECT_FALSE(enclosesGround({{{0, 0}, {1, 1}, {3, 3}, {0, 0}}, {}}));
  EXPECT_FALSE(enclosesGround({{{7, 7}, {7, 7}, {7, 7}, {7, 7}}, {}}));
  EXPECT_FALSE(enclosesGround({}));
}

}  // namespace polygon_cover_test
}  // namespace talus::maps
