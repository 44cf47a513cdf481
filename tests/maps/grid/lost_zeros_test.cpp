#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <talus/maps/grid/lost_zeros.hpp>

namespace talus::maps {
namespace lost_zeros_test {

constexpr int kWidth = 60, kHeight = 50;

using Height = std::function<double(int column, int row)>;

// One letter for each cell: '#' lost, '.' kept.
std::vector<std::string> lost(const Height& height, std::size_t* count = nullptr) {
  LostZeros search(kWidth);
  for (int row = 0; row < kHeight; ++row) {
    std::vector<float> values;
    for (int column = 0; column < kWidth; ++column) values.push_back(static_cast<float>(height(column, row)));
    search.add(values);
  }
  const LostCells found = search.finish();
  if (count != nullptr) *count = found.count;
  std::vector<std::string> drawing(kHeight, std::string(kWidth, '.'));
  for (const CellRun& run : found.runs)
    for (int column = run.first; column <= run.last; ++column)
      drawing[static_cast<std::size_t>(run.row)][static_cast<std::size_t>(column)] = '#';
  return drawing;
}

std::size_t lostCount(const Height& height) {
  std::size_t count = 0;
  lost(height, &count);
  return count;
}

double rough(int column, int row) {
  return 0.3 * std::sin(0.7 * column) + 0.2 * std::cos(0.9 * row + 0.1 * column);
}

// Sets the cells begin to end - 1, in file order, to 0.
Height zeroed(const Height& height, int begin, int end) {
  return [=](int column, int row) {
    const int at = row * kWidth + column;
    return at >= begin && at < end ? 0.0 : height(column, row);
  };
}

// Property: a block of zeros in ground away from 0 is lost as a whole, with one cell around the block, at any
// position.
TEST(LostZeros, BlockOfZerosWithinOtherElevationsIsLost) {
  for (const double level : {-2500.0, -3.0, 2.0, 150.0})
    for (const int cells : {1, 7, 128, 1024})
      for (int begin = 0; begin + cells <= kWidth * kHeight; begin += 331) {
        std::size_t count = 0;
        const auto drawing =
            lost(zeroed([&](int c, int r) { return level + rough(c, r); }, begin, begin + cells), &count);
        EXPECT_EQ(count, static_cast<std::size_t>(cells)) << level << ' ' << begin;
        for (int at = std::max(begin - 1, 0); at <= std::min(begin + cells, kWidth * kHeight - 1); ++at)
          EXPECT_EQ(drawing[static_cast<std::size_t>(at / kWidth)][static_cast<std::size_t>(at % kWidth)],
                    '#')
              << level << ' ' << cells << ' ' << begin << ' ' << at;
      }
}

// Property: a number across the edge of the lost block, whose upper bytes are 0, is lost.
TEST(LostZeros, PartiallyZeroedNumberIsLost) {
  EXPECT_EQ(lostCount([](int c, int r) {
              return r == 20 && c >= 20 && c <= 30 ? (c == 20 ? 1e-39 : 0.0) : 150 + rough(c, r);
            }),
            11U);
}

TEST(LostZeros, ContinuousTerrainAtZeroElevationIsKept) {
  // Property: no cell of a sea beside a shore, a plain beside dunes, a lake between hills, a crater in a
  // plain or a level map at height 0 is lost.
  EXPECT_EQ(lostCount([](int c, int r) { return std::max(0.0, 0.1 * (c - 25) + 0.3 * rough(c, r)); }), 0U);
  EXPECT_EQ(
      lostCount([](int c, int r) { return std::max(0.0, 2.0 * std::sin(0.2 * c) * std::cos(0.15 * r)); }),
      0U);
  EXPECT_EQ(lostCount([](int c, int r) { return std::max(0.0, std::hypot(c - 30, r - 25) - 10) * 0.4; }), 0U);
  EXPECT_EQ(lostCount([](int c, int r) { return std::min(0.0, std::hypot(c - 30, r - 25) - 10) * 0.4; }), 0U);
  EXPECT_EQ(lostCount([](int c, int r) { return std::round(100 * rough(c, r)) / 100; }), 0U);
}

TEST(LostZeros, LevelMapsWallsSpikesAndHolesAreKept) {
  EXPECT_EQ(lostCount([](int, int) { return 0.0; }), 0U);
  EXPECT_EQ(lostCount([](int c, int) { return c / 2 == 12 ? 5.0 : 0.0; }), 0U);         // a wall of two cells
  EXPECT_EQ(lostCount([](int c, int) { return c > 30 ? 5.0 : 0.0; }), 0U);              // an edge
  EXPECT_EQ(lostCount([](int c, int r) { return c == 9 && r == 9 ? 0.7 : 0.0; }), 0U);  // a rock
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(lostCount([=](int c, int) { return c > 30 ? nan : 0.0; }), 0U);
  EXPECT_EQ(lostCount([=](int, int) { return nan; }), 0U);
}

// Property: regions of zeros are classified separately, also if they meet in a later row.
TEST(LostZeros, RegionsAreClassifiedSeparately) {
  std::size_t count = 0;
  const auto drawing = lost(
      [](int c, int r) {
        const bool horseshoe = r >= 5 && r < 20 && (c == 40 || c == 50 || (r == 19 && c > 40 && c < 50));
        return horseshoe ? 0.0 : std::max(0.0, 0.5 * (c - 12.4) + 0.3 * rough(c, r));
      },
      &count);
  EXPECT_EQ(count, 39U);
  EXPECT_EQ(drawing[10].find('#'), 39U);
  EXPECT_EQ(drawing[40].find('#'), std::string::npos);
}

// Share of each cell that rocks cover: round fields of several cells, 0 in between.
double rockFields(int column, int row) {
  const double x = column % 15 - 7.0, y = row % 12 - 6.0, away = std::hypot(x, y);
  return away < 5.5 ? 0.4 + 0.01 * std::sin(3.0 * column + row) : 0.0;
}

std::size_t lostRocks(const Height& share) {
  LostZeros search(kWidth, true);
  for (int row = 0; row < kHeight; ++row) {
    std::vector<float> values;
    for (int column = 0; column < kWidth; ++column) values.push_back(static_cast<float>(share(column, row)));
    search.add(values);
  }
  return search.finish().count;
}

// Property: if 0 is a frequent value, zeros between rock fields are kept for any border. Cells that follow
// each other in file order are lost if rocks surround them.
TEST(LostZeros, InMapsWithManyZerosOnlyRunsInFileOrderAreLost) {
  EXPECT_GT(lostCount(rockFields), 1000U);
  EXPECT_EQ(lostRocks(rockFields), 0U);
  EXPECT_EQ(lostRocks([](int c, int r) { return r < 20 ? 0.0 : rockFields(c, r); }), 0U);
  const Height dense = [](int c, int r) { return 0.5 + rough(c, r); };
  for (const int cells : {1, 7, 59, 60, 61, 128, 1024})
    for (int begin = 0; begin + cells <= kWidth * kHeight; begin += 331)
      EXPECT_EQ(lostRocks(zeroed([&](int c, int r) { return 2.0 + dense(c, r); }, begin, begin + cells)),
                static_cast<std::size_t>(cells))
          << begin << ' ' << cells;
}

}  // namespace lost_zeros_test
}  // namespace talus::maps
