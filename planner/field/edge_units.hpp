#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <vector>

#include <talus/costmap/cost/travel_cost.hpp>
#include <talus/maps/grid/grid.hpp>

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

}  // namespace talus::planner
