#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <talus/planner/route/polyline.hpp>

namespace talus::planner {
namespace polyline_test {

Polyline wandering(unsigned seed, int points) {
  std::mt19937 random(seed);
  const auto unit = [&random] { return static_cast<double>(random()) / 4294967296.0; };
  Polyline line{{0.0, 0.0}};
  while (static_cast<int>(line.size()) < points)
    line.push_back({line.back().x_m + 5.0 * unit(), line.back().y_m + 8.0 * (unit() - 0.5)});
  return line;
}

// Property: the pieces join, keep the length, and end where the remaining length is a multiple of the piece.
TEST(Polyline, PiecesAreMeasuredFromTheEnd) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Polyline line = wandering(seed, 30);
    const auto pieces = cutFromEnd(line, 7.0, 3.0);
    double left_m = 0.0;
    for (std::size_t k = pieces.size(); k-- > 0; left_m += length_m(pieces[k])) {
      if (k + 1 < pieces.size()) {
        EXPECT_EQ(pieces[k].back(), pieces[k + 1].front());
        EXPECT_NEAR(std::remainder(left_m - 3.0, 7.0), 0.0, 1e-9);
      }
    }
    EXPECT_NEAR(left_m, length_m(line), 1e-9);
    EXPECT_EQ(pieces.front().front(), line.front());
    EXPECT_GT(length_m(pieces.front()), 3.5 - 1e-9);
    EXPECT_LE(length_m(pieces.front()), 10.5 + 1e-9);
  }
}

TEST(Polyline, SplitLeavesTheGivenLength) {
  const Polyline line{{0.0, 0.0}, {10.0, 0.0}, {10.0, 5.0}};
  for (const double left_m : {0.5, 5.0, 7.0, 14.5}) {
    const auto [before, behind] = splitAt(line, left_m);
    EXPECT_NEAR(length_m(behind), left_m, 1e-12);
    EXPECT_NEAR(length_m(before) + length_m(behind), 15.0, 1e-12);
    EXPECT_EQ(before.back(), behind.front());
    EXPECT_EQ(before.front(), line.front());
    EXPECT_EQ(behind.back(), line.back());
  }
}

TEST(Polyline, LineIsCutWhereItEntersACircle) {
  const Polyline line{{0, 0}, {10, 0}, {10, 10}};
  const auto near = [](const Polyline& got, const Polyline& want) {
    ASSERT_EQ(got.size(), want.size());
    for (std::size_t i = 0; i < got.size(); ++i)
      EXPECT_NEAR(std::hypot(got[i].x_m - want[i].x_m, got[i].y_m - want[i].y_m), 0.0, 1e-7);
  };
  near(cutWithin(line, {10, 10}, 4.0), {{0, 0}, {10, 0}, {10, 6}});
  near(cutWithin(line, {5, 3}, 5.0), {{0, 0}, {1, 0}});  // 3-4-5, between two places outside
  near(cutWithin(line, {5, 3}, 2.9), line);              // outside the circle
  near(cutWithin(line, {-1, 0}, 1.5), {{0, 0}});         // begins inside
  near(cutWithin(line, {10, 10}, 0.0), line);
}

// Property: the pieces together are the line and long enough, and a line with one changed point is cut at
// the same points elsewhere.
TEST(Polyline, CutPointsDependOnTheNeighbourhoodOnly) {
  constexpr double kApart = 40.0;
  std::size_t common = 0, all = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Polyline line = wandering(seed, 400);
    Polyline other = line;
    other.insert(other.begin() + 200, {line[200].x_m + 0.5, line[200].y_m + 9.0});
    const auto pieces = cutAtMarks(line, kApart), others = cutAtMarks(other, kApart);
    Polyline joined;
    for (const Polyline& piece : pieces) {
      append(joined, piece);
      if (&piece != &pieces.front() && &piece != &pieces.back()) {
        EXPECT_GT(length_m(piece), kApart);
      }
    }
    EXPECT_EQ(joined, line);
    EXPECT_GT(pieces.size(), 5U);
    for (const Polyline& piece : pieces)
      common += static_cast<std::size_t>(std::count(others.begin(), others.end(), piece));
    all += pieces.size();
  }
  EXPECT_GE(common, all - 20 * 4);
}

}  // namespace polyline_test
}  // namespace talus::planner
