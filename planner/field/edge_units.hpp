#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include <talus/costmap/cost/travel_cost.hpp>
#include <talus/planner/field/grid_heading.hpp>

namespace talus::planner {

/// Costs of half steps, from a cell's centre to its edge or corner, for all eight headings, as integer
/// multiples of an energy unit, so that sums do not depend on their order. An edge is the sum of two half
/// steps and fits in 16 bits. Headings refused by TravelCurve::price() have kBlocked; costs above kHighest
/// are stored as kHighest. Interpolation weights are rounded to 1/128, so a half step differs from the exact
/// cost by at most one unit plus 1/256 of the difference of neighbouring nodes.
class EdgeUnits {
 public:
  static constexpr std::uint16_t kBlocked = 0xffff;
  static constexpr std::uint16_t kHighest = 0x7ffe;

  using Halves = std::array<std::uint16_t, 8>;  ///< indexed by GridHeading

  /// Units for cells of side resolution_m [m] and the given cost. `coarsening` >= 1 enlarges the unit (for
  /// huge maps).
  EdgeUnits(const costmap::TravelCost& cost, double resolution_m, double coarsening = 1.0);

  /// Unit only, for edges whose costs are computed elsewhere; halves() returns blocked headings only.
  EdgeUnits(double unit_J, std::uint32_t cheapest_edge) : unit_J_(unit_J), cheapest_edge_(cheapest_edge) {}

  /// Joules per unit.
  double unit_J() const noexcept { return unit_J_; }

  /// Returns a lower bound of every allowed edge in units; >= 1.
  std::uint32_t cheapestEdge() const noexcept { return cheapest_edge_; }

  /// Returns true if these units assign the same cost to every cell that the older units cover (curves were
  /// only added).
  bool extends(const EdgeUnits& older) const noexcept;

  /// Half-step costs of all headings in a cell.
  Halves halves(costmap::CellCode cell) const noexcept;

  /// Half-step costs of `count` consecutive cells. The AVX2 version returns identical values.
  void halves(const costmap::CellCode* cells, std::size_t count, Halves* out, bool by_vectors) const noexcept;

 private:
  void halvesByVector(const costmap::CellCode* cells, std::size_t count, Halves* out) const noexcept;

  // Interpolation weights in 1/kShares. A coordinate between two nodes never has a weight of 0 or kShares.
  static constexpr int kShareBits = 7, kShares = 1 << kShareBits;
  // Fractional node index of a gradient: the lower 32 bits are an offset into pairs_, the upper two 16-bit
  // fields are the weights of the next bin and the next row. A gradient beyond the limit has the highest bit
  // of its weight set. Positions along and across are added.
  using Place = std::uint64_t;
  static constexpr Place kRefusedAlong = Place{1} << 47, kRefusedAcross = Place{1} << 63;
  struct Places {
    std::vector<Place> along, across;  // by CellCode steps; `middle` is the index of zero
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

  // Half-step costs [units] of all nodes, ordered by curve, row, kind of step (straight, diagonal) and bin
  // (-reach_ to reach_, then a blocked entry). The upper 16 bits are the cost in the opposite heading. Rows
  // beyond the last row of a curve repeat the last row, so that all curves have equally many rows.
  std::vector<std::uint32_t> pairs_;
  std::vector<std::uint32_t> first_;  // by curve
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
