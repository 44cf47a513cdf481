#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

namespace talus::maps {

/// A range of cells of one row, from column `first` to column `last`, both included.
struct CellRun {
  int row = 0;
  int first = 0;
  int last = 0;
};

/// Cells whose value was lost, because a damaged file contains zeros there.
struct LostCells {
  /// Cells of the lost regions, with a margin of one cell around each region; runs may overlap.
  std::vector<CellRun> runs{};
  std::size_t count = 0;  ///< number of cells of the lost regions with the value 0 (magnitude below 1e-37)
};

/// Finds connected regions of zeros that are lost data: a lost disk block becomes zero bytes in a file of
/// numbers. The method (ours, not from the literature) examines each border cell of a region. The border step
/// is the height step from the region's 0 to the first cell outside. It is abrupt if it exceeds three times
/// the largest of the next three steps outwards. A region is lost if more than half of its border steps are
/// abrupt.
///   - Terrain that descends to a plain or a sea of height 0 has no abrupt border steps.
///   - A border step to level cells (a wall on a plain), or to a single known cell, is not abrupt.
///   - Border steps to cells without data are omitted. A region without other border steps (a level map) is
///     not lost.
/// If 0 is an ordinary value of the layer, e.g. of rock abundance, a lost region must also have the shape of
/// a lost byte range: every row of the region spans the full width of the region, except that the first row
/// may begin later and the last row may end earlier.
class LostZeros {
 public:
  /// Finds lost regions in rows of `width` cells. If `zero_is_ordinary`, a lost region must also have the
  /// shape of a lost byte range.
  explicit LostZeros(int width, bool zero_is_ordinary = false);

  /// Adds the next row of `width` values; NaN marks cells without data. Rows may be added from south to north
  /// or from north to south.
  void add(std::span<const float> row);

  /// Returns the lost cells of all rows. Must be called once, after the last row.
  LostCells finish();

 private:
  static constexpr int kBehind = 4;  // number of cells outside a border whose steps are compared

  struct Region {
    std::uint32_t parent = 0;
    std::size_t steps = 0, abrupt = 0;  // number of counted border steps, and number of abrupt ones
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
