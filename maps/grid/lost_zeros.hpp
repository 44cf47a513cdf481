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

/// Finds the regions of exact zeros that stand for no ground, as a disk block of zero bytes leaves them in a file of numbers. Where
/// ground comes down to a plain or a sea of height 0, the step from 0 to the first cell is like the steps behind it. A region
/// is lost where more than half of the steps at its border are greater than three times the greatest of the three steps behind
/// them (ours, not from the literature). Ground that is level behind a step (a wall that somebody drew) speaks for the zeros, and so
/// does a step behind which no cell is known. Zeros without a border, as of a level map, are ground.
class LostZeros {
 public:
  explicit LostZeros(int width);

  /// The next row of `width` values, NaN where there is none; from either end of the raster.
  void add(std::span<const float> row);

  /// What all rows hold. Ends the search.
  LostCells finish();

 private:
  static constexpr int kBehind = 4;  // cells that are looked at from a border on

  struct Region {
    std::uint32_t parent = 0;
    std::size_t steps = 0, abrupt = 0;  // of its border
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
  std::uint32_t root(std::uint32_t region);

  int width_ = 0;
  int rows_ = 0;                         // that were added
  std::deque<std::vector<float>> near_;  // the last rows
  std::vector<Run> runs_;
  std::size_t above_ = 0, here_ = 0;  // where the runs of the row above and of this row begin
  std::vector<Region> regions_;
};

}  // namespace talus::maps
