#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include <talus/costmap/cost/drive_cost.hpp>
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

  // Steps of CellCode, as the sums and differences of dz/dx and dz/dy along a diagonal, to bins and rows of a curve.
  struct Scale {
    double bins, rows;  // of a step
    int along, across;  // most steps that the limits allow
  };
  int bin(const Scale& scale, int along) const noexcept {
    const int size = static_cast<int>(std::abs(along) * scale.bins + 0.5);
    return along < 0 ? -size : size;
  }
  int row(const Scale& scale, int across) const noexcept {
    return static_cast<int>(std::ceil(std::abs(across) * scale.rows - costmap::DriveCurve::kSame));
  }

  // Of each curve, by row: halves of a straight step by bin from -reach_ to reach_, each with its opposite in the
  // upper half, then those of a diagonal step.
  std::vector<std::uint32_t> pairs_;
  std::vector<std::int32_t> first_, last_row_;  // by curve
  int reach_ = 0;
  Scale straight_{}, diagonal_{};
  double unit_J_ = 1.0;
  std::uint32_t cheapest_edge_ = 1;
};

inline EdgeUnits::Halves EdgeUnits::halves(costmap::CellCode cell) const noexcept {
  Halves halves;
  halves.fill(kBlocked);
  if (cell.curve() >= first_.size()) return halves;
  const int x = cell.stepsX(), y = cell.stepsY();
  const int width = 2 * reach_ + 1, last = last_row_[cell.curve()];
  const std::uint32_t* middle = pairs_.data() + first_[cell.curve()] + reach_;
  const auto fill = [&](const Scale& scale, int shift, GridHeading heading, int along, int across) {
    if (std::abs(across) > scale.across || std::abs(along) > scale.along) return;
    const std::uint32_t pair =
        middle[std::min(row(scale, across), last) * 2 * width + shift + bin(scale, along)];
    halves[heading] = static_cast<std::uint16_t>(pair);
    halves[static_cast<std::size_t>(opposite(heading))] = static_cast<std::uint16_t>(pair >> 16);
  };
  fill(straight_, 0, kEast, x, y);
  fill(straight_, 0, kNorth, y, x);
  fill(diagonal_, width, kNorthEast, x + y, y - x);
  fill(diagonal_, width, kNorthWest, y - x, x + y);
  return halves;
}

}  // namespace talus::planner
