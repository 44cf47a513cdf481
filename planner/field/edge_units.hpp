#pragma once

#include <array>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include <talus/costmap/drive_cost.hpp>
#include <talus/planner/field/grid_heading.hpp>

namespace talus::planner {

/// The cost of half a step, from a cell's centre to its edge or corner, for all eight headings: whole numbers
/// of a unit of energy, so that sums do not depend on their order. 16 bits: an edge is the sum of two halves.
/// kBlocked where the heading may not enter; any higher cost than kDearest is stored as kDearest, so a sum
/// never exceeds the true cost by more than half a unit a half step.
class EdgeUnits {
 public:
  static constexpr std::uint16_t kBlocked = 0xffff;
  static constexpr std::uint16_t kDearest = 0x7ffe;

  using Halves = std::array<std::uint16_t, 8>;  ///< by GridHeading

  /// For cells of this side [m] under this cost. `coarsening` >= 1 makes the unit larger (for huge maps).
  EdgeUnits(const costmap::DriveCost& cost, double resolution_m, double coarsening = 1.0);

  /// A unit alone, for edges that are priced in another way; halves() are all blocked.
  EdgeUnits(double unit_J, std::uint32_t cheapest_edge) : unit_J_(unit_J), cheapest_edge_(cheapest_edge) {}

  /// Joules of one unit.
  double unit_J() const noexcept { return unit_J_; }

  /// A lower bound of any edge that is allowed, in units; >= 1.
  std::uint32_t cheapestEdge() const noexcept { return cheapest_edge_; }

  /// Whether every cell that the older units can price is priced the same by these: curves were only added.
  bool extends(const EdgeUnits& older) const noexcept;

  /// Halves of all headings in a cell.
  Halves halves(costmap::CellCode cell) const noexcept;

  /// The same for cells that follow each other; by vectors (AVX2) the same bits.
  void halves(const costmap::CellCode* cells, std::size_t count, Halves* out, bool by_vectors) const noexcept;

 private:
  void halvesByVector(const costmap::CellCode* cells, std::size_t count, Halves* out) const noexcept;

  // Half costs of one curve over the gradient along the heading in steps of CellCode, from -reach_ to reach_.
  std::vector<std::uint16_t> straight_, diagonal_;
  std::vector<std::uint32_t> pairs_;  // straight_, then diagonal_, each with its opposite in the upper half
  int reach_ = 0;                     // most steps along a diagonal heading that the limit allows
  int across_straight_ = 0;           // most steps across a straight heading
  int across_diagonal_ = 0;           // the same for |dz/dx -+ dz/dy|
  std::size_t curves_ = 0;
  double unit_J_ = 1.0;
  std::uint32_t cheapest_edge_ = 1;
};

inline EdgeUnits::Halves EdgeUnits::halves(costmap::CellCode cell) const noexcept {
  Halves halves;
  halves.fill(kBlocked);
  if (cell.curve() >= curves_) return halves;
  const int x = cell.stepsX(), y = cell.stepsY();
  const auto middle = static_cast<std::size_t>(cell.curve()) * static_cast<std::size_t>(2 * reach_ + 1) +
                      static_cast<std::size_t>(reach_);
  const std::uint16_t* straight = straight_.data() + middle;
  const std::uint16_t* diagonal = diagonal_.data() + middle;
  const auto fill = [&](const std::uint16_t* level, GridHeading heading, int along, int across, int limit) {
    if (std::abs(across) > limit || std::abs(along) > reach_) return;
    halves[heading] = level[along];
    halves[static_cast<std::size_t>(opposite(heading))] = level[-along];
  };
  fill(straight, kEast, x, y, across_straight_);
  fill(straight, kNorth, y, x, across_straight_);
  fill(diagonal, kNorthEast, x + y, y - x, across_diagonal_);
  fill(diagonal, kNorthWest, y - x, x + y, across_diagonal_);
  return halves;
}

}  // namespace talus::planner
