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
/// kBlocked where the heading may not enter, as DriveCurve::price() says; any higher cost than kDearest is stored as kDearest.
/// Between nodes of the curve shares are rounded to 1/128, so that a half step is off by a unit and by 1/256 of what nodes
/// side by side differ.
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
  // A place between nodes, its share in 1/kShares; between nodes it is never on one.
  static constexpr int kShareBits = 7, kShares = 1 << kShareBits;
  struct Between {
    int whole, share;
  };
  static Between between(double place) noexcept {
    const int whole = static_cast<int>(place + costmap::DriveCurve::kSame);
    const double rest = place - whole;
    const int share = std::clamp(static_cast<int>(rest * kShares + 0.5), 1, kShares - 1);
    return {whole, rest > costmap::DriveCurve::kSame ? share : 0};
  }
  int width() const noexcept { return 2 * reach_ + 2; }

  // Of each curve, by row: halves of a straight step by bin from -reach_ to reach_, each with its opposite in the
  // upper half, and a blocked one; then those of a diagonal step.
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
  const int last = last_row_[cell.curve()];
  const std::uint32_t* first = pairs_.data() + first_[cell.curve()];
  const auto fill = [&](const Scale& scale, int shift, GridHeading heading, int along, int across) {
    if (std::abs(across) > scale.across || std::abs(along) > scale.along) return;
    const Between bin = between(along * scale.bins + reach_), row = between(std::abs(across) * scale.rows);
    std::uint32_t ahead = 0, back = 0;
    bool blocked = false, opposite_blocked = false;
    for (const int next : {0, 1}) {
      const std::uint32_t* pair = first + std::min(row.whole + next, last) * 2 * width() + shift + bin.whole;
      const int of_row = next == 1 ? row.share : kShares - row.share;
      for (const int right : {0, 1}) {
        const auto weight =
            static_cast<std::uint32_t>(of_row * (right == 1 ? bin.share : kShares - bin.share));
        if (weight == 0) continue;
        const std::uint32_t to = pair[right] & 0xffffU, from = pair[right] >> 16;
        blocked = blocked || to == kBlocked;
        ahead += weight * to;
        back += weight * from;
        opposite_blocked = opposite_blocked || from == kBlocked;
      }
    }
    constexpr int kBits = 2 * kShareBits;
    constexpr std::uint32_t kHalf = 1U << (kBits - 1);
    if (!blocked) halves[heading] = static_cast<std::uint16_t>((ahead + kHalf) >> kBits);
    if (!opposite_blocked)
      halves[static_cast<std::size_t>(opposite(heading))] =
          static_cast<std::uint16_t>((back + kHalf) >> kBits);
  };
  fill(straight_, 0, kEast, x, y);
  fill(straight_, 0, kNorth, y, x);
  fill(diagonal_, width(), kNorthEast, x + y, y - x);
  fill(diagonal_, width(), kNorthWest, y - x, x + y);
  return halves;
}

}  // namespace talus::planner
