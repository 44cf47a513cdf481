#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

namespace talus::maps {

/// A range of cells of one row, both ends included.
struct CellRun {
  int row = 0;
  int first = 0;
  int last = 0;
};

/// Cells whose value was lost.
struct LostCells {
  std::vector<CellRun> runs{};  ///< lost regions with a margin of one cell; runs may overlap
  std::size_t count = 0;        ///< number of cells with the value 0 (below 1e-37) in the lost regions
};

/// Finds connected regions of zeros that are lost data: a lost disk block becomes zero bytes in a file of
/// numbers. Method (ours, not from the literature): at each border cell of a region, the height step from 0
/// to the first cell outside is compared with the next three steps outwards. The border step is abrupt if it
/// exceeds three times the largest of these three steps. A region is lost if more than half of its border
/// steps are abrupt.
///   - Terrain that descends to a plain or a sea of height 0 has no abrupt border steps.
///   - A border step to level cells (a wall on a plain), or to a single known cell, is not abrupt.
///   - Border steps to unknown cells are omitted. A region without other border steps (a level map) is not
///     lost.
/// If 0 is an ordinary value, for example of rock abundance, a lost region must also have the shape of a lost
/// byte range: every row of the region spans the full width of the region; only its first row may begin later
/// and only its last row may end earlier.
class LostZeros {
 public:
  /// `zero_is_ordinary`: true if a lost region must also have the shape of a lost byte range.
  explicit LostZeros(int width, bool zero_is_ordinary = false);

  /// Adds the next row of `width` values, NaN for no data. Rows may be added from south to north or from
  /// north to south.
  void add(std::span<const float> row);

  /// Returns the lost cells of all rows. Call once, after the last row.
  LostCells finish();

 private:
  static constexpr int kBehind = 4;  // number of cells outside a border whose steps are compared

  struct Region {
    std::uint32_t parent = 0;
    std::size_t steps = 0, abrupt = 0;  // counted border steps, and the abrupt ones among them
    int first_row = 0, last_row = 0, west = 0, east = 0;
    bool follows = true;  // true if the cells are consecutive in the rows of a rectangle
  };
  struct Run {
    CellRun cells;
    std::uint32_t region = 0;
  };
  struct Step {
    int row, column, down, right;
  };

  void search(int row);
  void join(std::size_t run);
  void look(const Step& step, Region& region) const;
  float at(int row, int column) const;
  void boundRegions();
  std::uint32_t root(std::uint32_t region);

  int width_ = 0;
  bool zero_is_ordinary_ = false;
  int rows_ = 0;                         // number of rows added
  std::deque<std::vector<float>> near_;  // the most recent rows, at most 2 kBehind + 1
  std::vector<Run> runs_;
  std::size_t above_ = 0, here_ = 0;  // first run of the previous row and of the current row
  std::vector<Region> regions_;
};

}  // namespace talus::maps
