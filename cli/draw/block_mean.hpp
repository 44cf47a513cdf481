#pragma once

#include <algorithm>
#include <cmath>

#include <talus/maps/maps.hpp>

namespace talus::cli {

/// A coarser version of a grid: each coarse cell is a block of factor x factor fine cells. Blocks at the
/// eastern and northern edges may have fewer cells.
class Blocks {
 public:
  /// Divides the grid `fine` by the smallest factor for which no side of the coarse grid exceeds max_side
  /// cells.
  Blocks(const maps::Grid& fine, int max_side)
      : fine_(fine), factor_(std::max(1, (std::max(fine.width, fine.height) + max_side - 1) / max_side)) {
    const auto count = [this](int cells) { return (cells + factor_ - 1) / factor_; };
    coarse_ = {count(fine.width), count(fine.height), fine.resolution_m * factor_, fine.south_west};
  }

  const maps::Grid& coarse() const noexcept { return coarse_; }

  /// Returns the number of fine cells per side of a block.
  int factor() const noexcept { return factor_; }

  /// Returns the fine cell at the centre of a block.
  maps::Cell middle(maps::Cell block) const noexcept {
    return {std::min(fine_.width - 1, block.column * factor_ + factor_ / 2),
            std::min(fine_.height - 1, block.row * factor_ + factor_ / 2)};
  }

  /// Calls visit(cell) for a regular sample of at most 8 x 8 cells of the block.
  template <typename Visit>
  void forEach(maps::Cell block, Visit visit) const {
    const int stride = std::max(1, factor_ / 8);
    const int right = std::min(fine_.width, (block.column + 1) * factor_);
    const int top = std::min(fine_.height, (block.row + 1) * factor_);
    for (int row = block.row * factor_; row < top; row += stride)
      for (int column = block.column * factor_; column < right; column += stride)
        visit(maps::Cell{column, row});
  }

  /// Returns a raster with the mean of value(cell) over each block, without NaN values; NaN for a block whose
  /// values are all NaN.
  template <typename Value>
  maps::Raster<float> mean(Value value) const {
    maps::Raster<float> out(coarse_, std::nanf(""));
    for (int row = 0; row < coarse_.height; ++row) {
      for (int column = 0; column < coarse_.width; ++column) {
        double sum = 0.0;
        int count = 0;
        forEach({column, row}, [&](maps::Cell cell) {
          const auto v = static_cast<double>(value(cell));
          if (std::isnan(v)) return;
          sum += v;
          ++count;
        });
        if (count > 0) out[{column, row}] = static_cast<float>(sum / count);
      }
    }
    return out;
  }

 private:
  maps::Grid fine_;
  int factor_;
  maps::Grid coarse_;
};

}  // namespace talus::cli
