#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include <talus/costmap/cost/travel_cost.hpp>

namespace talus::planner {

/// Lower bounds of the cost per metre along 64 headings of a cell, here called the limits. If a function of
/// position decreases along each of these headings by at most the limit of the heading, then it decreases in
/// every direction by at most the cost.
///
/// Proof for directions between the headings (ours, not from the literature). The gauge is the function of
/// direction that is linear between the limits c_i and c_(i+1) of neighbouring headings; it must be at most
/// the cost. Between two directions at which the gradient along or across passes a node of the cost table, f
/// = cost - gauge is A + h1 + h2: a constant and harmonics of first and second order of the angle. Therefore
/// f'' = A - f - 3 h2. Over a piece of width w, f lies below its chord by at most w^2 / 8 times the largest
/// f''. For each piece, the limits of both adjacent headings are reduced by the largest violation. Finally
/// the limits are made convex: a limit above the value that follows from two other limits is reduced to that
/// value.
///
/// The limits of a cell follow from those of its gradient turned by quarters and reflected into the first eighth
/// of the plane, because the headings have the same symmetry; these are computed once. Not thread-safe.
class DirectionalCostBounds {
 public:
  static constexpr int kHeadings = 64;
  using Limits = std::array<float, kHeadings>;  ///< limits [J/m], > 0, counter-clockwise from east

  /// `cost` must outlive the object.
  explicit DirectionalCostBounds(const costmap::TravelCost& cost) : cost_(cost) {}

  /// Sets the limits of a cell. Returns false if the cell allows no heading.
  bool of(costmap::CellCode cell, Limits& limits);

  /// A cell code whose gradient lies in the first eighth of the plane, and the reflections that lead there.
  struct Reflected {
    costmap::CellCode cell;
    bool west = false, south = false, steeper_north = false;

    /// Returns the heading of the reflected cell, of `headings`, a power of two >= 8, to which heading k belongs.
    std::size_t heading(int k, int headings) const noexcept {
      int at = west ? headings / 2 - k : k;
      if (south) at = -at;
      if (steeper_north) at = headings / 4 - at;
      return static_cast<std::size_t>(at & (headings - 1));
    }
  };

  /// Returns the reflection of a cell code.
  static Reflected reflected(costmap::CellCode cell) noexcept;

  /// Returns the unit vector of heading k, 0 <= k <= kHeadings.
  static costmap::Direction heading(int k) noexcept;

 private:
  // Interval of directions, relative to the steepest ascent, in which the gradients along and across the
  // heading pass no node of the cost table. A metre towards the unit vector (x, y) costs level_J + x_J x +
  // y_J |y| + both_J x |y|; the values are infinite if the directions are not allowed.
  struct Piece {
    costmap::Direction from, to;
    double level_J, x_J = 0.0, y_J = 0.0, both_J = 0.0;
  };

  using Gauge = std::array<double, kHeadings>;

  bool compute(costmap::CellCode cell, Limits& limits);
  void addNodes(double steepness);
  void addPieces(const costmap::TravelCurve& curve, double steepness);
  Piece pieceOf(const costmap::TravelCurve& curve, double steepness, const costmap::Direction& from,
                const costmap::Direction& to) const;
  void addRefused(const costmap::TravelCurve& curve, double steepness, const costmap::Direction& at);
  template <typename Each>
  void forEachPart(const costmap::Direction& climb, Each each) const;

  Gauge gaugeOf(costmap::CellCode cell, const costmap::Direction& climb) const;
  Gauge lackOf(const Gauge& gauge, const costmap::Direction& climb) const;

  const costmap::TravelCost& cost_;
  std::vector<costmap::Direction> nodes_;  // directions within a quarter turn from the steepest ascent
  std::vector<Piece> pieces_;              // pieces of half a turn
  std::unordered_map<std::uint32_t, Limits>
      known_;  // by bits of the reflected cell code; negative: no heading
};

}  // namespace talus::planner
