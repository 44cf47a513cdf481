#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include <talus/costmap/cost/cost_model.hpp>
#include <talus/maps/maps.hpp>
#include <talus/planner/route/kernels.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// The eight headings of a grid, counter-clockwise from east.
enum GridHeading : int { kEast, kNorthEast, kNorth, kNorthWest, kWest, kSouthWest, kSouth, kSouthEast };

/// Column and row offset of a step along each heading.
inline constexpr std::array<maps::Cell, 8> kStep{
    {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};

/// Returns the opposite heading.
constexpr int opposite(int heading) noexcept {
  return heading ^ 4;
}

/// Lowest and highest cost per metre over all cost curves (kinds of ground, costmap::TravelCurve) and all
/// allowed gradients along and across the heading.
struct CostRange {
  /// Lowest cost; infinite if no motion is allowed.
  double least_J_per_m = std::numeric_limits<double>::infinity();
  double most_J_per_m = 0.0;  ///< highest finite cost
};
/// Returns the cost range of a cost function.
CostRange costRange(const costmap::TravelCost& cost);

/// Costs of half steps as integer multiples of an energy unit, so that sums do not depend on their order. A
/// half step leads from the centre of a cell to a side or corner of the cell, in one of the eight headings of
/// the grid. The cost of a step between cells is the sum of two half steps and fits in 16 bits. A heading
/// that TravelCurve::price() does not allow has the cost kBlocked; costs above kHighest are stored as
/// kHighest. Interpolation weights are rounded to 1/128. Therefore the cost of a half step differs from the
/// exact cost by at most one unit plus 1/256 of the difference of neighbouring table nodes.
class EdgeUnits {
 public:
  static constexpr std::uint16_t kBlocked = 0xffff;
  static constexpr std::uint16_t kHighest = 0x7ffe;

  using Halves = std::array<std::uint16_t, 8>;  ///< indexed by GridHeading

  /// Computes the costs of half steps in cells of side length `resolution_m` [m]. `coarsening` >= 1 is a
  /// factor of the unit (for huge maps).
  EdgeUnits(const costmap::TravelCost& cost, double resolution_m, double coarsening = 1.0);

  /// Sets only the unit, for steps whose costs are computed elsewhere; halves() then returns blocked
  /// headings.
  EdgeUnits(double unit_J, std::uint32_t cheapest_edge) : unit_J_(unit_J), cheapest_edge_(cheapest_edge) {}

  /// Returns the energy unit [J].
  double unit_J() const noexcept { return unit_J_; }

  /// Returns a lower bound, in units, of the cost of all allowed steps; >= 1.
  std::uint32_t cheapestEdge() const noexcept { return cheapest_edge_; }

  /// Returns true if these units give the same cost as the older units to every cell for which the older
  /// units are defined, that is, if cost curves were only added.
  bool extends(const EdgeUnits& older) const noexcept;

  /// Returns the half-step costs of all headings in a cell.
  Halves halves(costmap::CellCode cell) const noexcept;

  /// Writes the half-step costs of `count` consecutive cells to `out`. `by_vectors` selects the AVX2
  /// implementation, which writes identical values.
  void halves(const costmap::CellCode* cells, std::size_t count, Halves* out, bool by_vectors) const noexcept;

 private:
  void halvesByVector(const costmap::CellCode* cells, std::size_t count, Halves* out) const noexcept;

  // Interpolation weights are in 1/kShares. A coordinate between two nodes has no weight of 0 or kShares.
  static constexpr int kShareBits = 7, kShares = 1 << kShareBits;
  // Fractional node index of a gradient: the lower 32 bits are an offset into pairs_, the upper two 16-bit
  // fields are the weights of the next bin and the next row. A gradient beyond the limit of the rover has the
  // highest bit of its weight set. The indices along and across the heading are added.
  using Place = std::uint64_t;
  static constexpr Place kRefusedAlong = Place{1} << 47, kRefusedAcross = Place{1} << 63;
  struct Places {
    // By gradient in steps of CellCode; `middle` is the index of gradient 0.
    std::vector<Place> along, across;
    int middle = 0;
  };
  Places places(const costmap::TravelCost::Limits& limits, double per_step, int shift) const;
  int width() const noexcept { return 2 * reach_ + 2; }

  // Returns the fractional node indices along and across of the headings from east to north-west.
  std::array<Place, 4> placesOf(costmap::CellCode cell) const noexcept {
    const int x = cell.stepsX(), y = cell.stepsY();
    const Place* straight_along = straight_.along.data() + straight_.middle;
    const Place* straight_across = straight_.across.data() + straight_.middle;
    const Place* diagonal_along = diagonal_.along.data() + diagonal_.middle;
    const Place* diagonal_across = diagonal_.across.data() + diagonal_.middle;
    return {straight_along[x] + straight_across[y], diagonal_along[x + y] + diagonal_across[y - x],
            straight_along[y] + straight_across[x], diagonal_along[y - x] + diagonal_across[x + y]};
  }

  // Half-step costs [units] of all nodes, ordered by cost curve, row, kind of step (straight, diagonal) and
  // bin (-reach_ to reach_, then a blocked entry). The upper 16 bits are the cost in the opposite heading.
  // Rows beyond the last row of a curve repeat the last row, so that all curves have the same number of rows.
  std::vector<std::uint32_t> pairs_;
  std::vector<std::uint32_t> first_;  // index of the first node of each cost curve
  int reach_ = 0;
  Places straight_, diagonal_;
  double unit_J_ = 1.0;
  std::uint32_t cheapest_edge_ = 1;
};

inline EdgeUnits::Halves EdgeUnits::halves(costmap::CellCode cell) const noexcept {
  Halves halves;
  halves.fill(kBlocked);
  if (cell.curve() >= first_.size()) return halves;
  const std::uint32_t* curve = pairs_.data() + first_[cell.curve()];
  const std::array<Place, 4> places = placesOf(cell);
  constexpr std::array<GridHeading, 4> kHeadings{kEast, kNorthEast, kNorth, kNorthWest};
  for (std::size_t k = 0; k < places.size(); ++k) {
    if ((places[k] & (kRefusedAlong | kRefusedAcross)) != 0) continue;
    const std::uint32_t* pair = curve + static_cast<std::uint32_t>(places[k]);
    const auto of_bin = static_cast<std::uint32_t>(places[k] >> 32) & 0xffffU,
               of_row = static_cast<std::uint32_t>(places[k] >> 48);
    std::uint32_t ahead = 0, back = 0;
    bool blocked = false, back_blocked = false;
    for (const std::uint32_t up : {0U, 1U})
      for (const std::uint32_t right : {0U, 1U}) {
        const std::uint32_t weight =
            (up == 1 ? of_row : kShares - of_row) * (right == 1 ? of_bin : kShares - of_bin);
        if (weight == 0) continue;
        const std::uint32_t node = pair[2 * static_cast<std::uint32_t>(width()) * up + right];
        ahead += weight * (node & 0xffffU);
        back += weight * (node >> 16);
        blocked = blocked || (node & 0xffffU) == kBlocked;
        back_blocked = back_blocked || node >> 16 == kBlocked;
      }
    constexpr int kBits = 2 * kShareBits;
    constexpr std::uint32_t kHalf = 1U << (kBits - 1);
    if (!blocked) halves[kHeadings[k]] = static_cast<std::uint16_t>((ahead + kHalf) >> kBits);
    if (!back_blocked)
      halves[static_cast<std::size_t>(opposite(kHeadings[k]))] =
          static_cast<std::uint16_t>((back + kHalf) >> kBits);
  }
  return halves;
}

/// Indexing of cells in an array with a border of one cell on every side, so that every cell of the grid has
/// eight neighbours. The index is here called the padded index.
struct PaddedGrid {
  int width = 0;   ///< number of columns without the border
  int height = 0;  ///< number of rows without the border

  std::size_t stride() const noexcept { return static_cast<std::size_t>(width) + 2; }
  std::size_t size() const noexcept { return stride() * (static_cast<std::size_t>(height) + 2); }
  /// Returns the padded index of a cell.
  std::size_t index(maps::Cell c) const noexcept {
    return static_cast<std::size_t>(c.row + 1) * stride() + static_cast<std::size_t>(c.column + 1);
  }
  /// Returns the cell with a padded index.
  maps::Cell cell(std::size_t index) const noexcept {
    return {static_cast<int>(index % stride()) - 1, static_cast<int>(index / stride()) - 1};
  }
  /// Returns the padded index of the neighbour in `heading` minus the padded index of a cell.
  std::ptrdiff_t offset(int heading) const noexcept {
    const maps::Cell step = kStep[static_cast<std::size_t>(heading)];
    return static_cast<std::ptrdiff_t>(step.row) * static_cast<std::ptrdiff_t>(stride()) + step.column;
  }
};

using maps::CellBox;

/// Returns the box extended by `cells` cells on every side and clipped to the grid.
inline CellBox grown(CellBox box, int cells, const PaddedGrid& grid) noexcept {
  return {
      {std::max(box.first.column - cells, 0), std::max(box.first.row - cells, 0)},
      {std::min(box.last.column + cells, grid.width - 1), std::min(box.last.row + cells, grid.height - 1)}};
}

/// Costs of all steps from a cell centre to its eight neighbours, on one version of the map, in units of
/// EdgeUnits; 16 bytes per cell. A step consists of two half steps, one in the cell that it leaves and one in
/// the cell that it enters, both on the heading of the step. Its cost is that of MotionCost for the segment
/// between the centres. A diagonal step is blocked unless the two other cells at its corner also allow the
/// heading.
class EdgeLayer {
 public:
  static constexpr std::uint16_t kBlocked = EdgeUnits::kBlocked;

  /// Computes the layer with `threads` threads; the result does not depend on their number. The computation
  /// ends early when a stop is requested; complete() is then false.
  EdgeLayer(std::shared_ptr<const costmap::CostGrid> map, const EdgeUnits& units, int threads = 1,
            const StopCheck& stop = {}, Kernels kernels = Kernels::Best);

  /// Size of a grid of points other than the cells of the map, for a layer without step costs.
  struct Unfilled {
    int width;
    int height;
  };
  /// Creates a layer without step costs, which the caller writes through into().
  EdgeLayer(std::shared_ptr<const costmap::CostGrid> map, const EdgeUnits& units, Unfilled points);

  std::uint16_t* into(std::size_t index) noexcept { return edges_.get() + 8 * index; }

  /// Returns the costs of the eight steps into the cell with a padded index. The index of a step is the
  /// heading, seen from the cell, of the neighbour at which the step begins.
  const std::uint16_t* into(std::size_t index) const noexcept { return edges_.get() + 8 * index; }

  const PaddedGrid& padded() const noexcept { return padded_; }
  const EdgeUnits& units() const noexcept { return units_; }
  const costmap::CostGrid& map() const noexcept { return *map_; }
  const std::shared_ptr<const costmap::CostGrid>& mapPointer() const noexcept { return map_; }
  /// Returns false if a stop ended the computation.
  bool complete() const noexcept { return complete_; }

  /// Updates the layer to the newer version `newer` of the same grid. The units must extend the present units
  /// (EdgeUnits::extends()), and cells outside the box `changed` must be equal in both versions.
  void update(std::shared_ptr<const costmap::CostGrid> newer, const EdgeUnits& units, CellBox changed);

 private:
  void buildRows(CellBox box);
  void blockBorder();

  std::shared_ptr<const costmap::CostGrid> map_;
  EdgeUnits units_;
  PaddedGrid padded_;
  LargeArray<std::uint16_t> edges_;
  bool vectors_ = false;
  bool complete_ = false;
};

/// Returns the smallest box around all cells that differ between two versions of a map on the same grid;
/// empty if no cell differs. Tiles that both versions share are skipped.
std::optional<CellBox> changedCells(const costmap::CostGrid& old, const costmap::CostGrid& newer);

}  // namespace talus::planner
