#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

namespace talus::maps {

/// Cells of one row, both ends included.
struct CellRun {
  int row = 0;
  int first = 0;
  int last = 0;
};

/// Cells whose value was lost.
struct LostCells {
  std::vector<CellRun> runs{};  ///< with a cell around each region; they may overlap
  std::size_t count = 0;        ///< cells of exactly 0 among them
};

/// Finds connected regions of exact zeros that are lost data: a disk block of zero bytes leaves such a region in a file of numbers.
/// At a border step from 0 to the first cell outside, the three steps behind it are compared. The border step is abrupt if it exceeds
/// three times the greatest of them. A region is lost if more than half of its border steps are abrupt (ours, not from the
/// literature). Where terrain descends to a plain or a sea of height 0, border steps are not abrupt. A border step counts as not
/// abrupt, too, if the cells behind it are level (a drawn wall) or unknown. A region without a border (a level map) is ground.
/// Where 0 is an ordinary value, as of rock abundance, a region must also have the shape that a file loses: cells that follow
/// each other in rows of equal width, of a strip or a tile.
class LostZeros {
 public:
  /// `zero_is_ordinary`: whether only regions of the shape that a file loses are lost.
  explicit LostZeros(int width, bool zero_is_ordinary = false);

  /// The next row of `width` values, NaN where there is none; from either end of the raster.
  void add(std::span<const float> row);

  /// What all rows hold. Ends the search.
  LostCells finish();

 private:
  static constexpr int kBehind = 4;  // cells that are looked at from a border on

  struct Region {
    std::uint32_t parent = 0;
    std::size_t steps = 0, abrupt = 0;  // of its border
    int first_row = 0, last_row = 0, west = 0, east = 0;
    bool follows = true;  // whether its cells follow each other in rows
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
  int rows_ = 0;                         // that were added
  std::deque<std::vector<float>> near_;  // the last rows
  std::vector<Run> runs_;
  std::size_t above_ = 0, here_ = 0;  // where the runs of the row above and of this row begin
  std::vector<Region> regions_;
};

}  // namespace talus::maps
