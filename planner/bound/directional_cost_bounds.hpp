#pragma once

#include <array>
#include <vector>

#include <talus/costmap/cost/travel_cost.hpp>

namespace talus::planner {

/// Lower bounds of the cost per metre along 64 headings of a cell. A function of position that falls along
/// each of these headings by no more than the heading's limit falls in every direction no faster than the
/// drive cost.
///
/// Why the bound also applies between the headings (ours, not from the literature). The gauge is linear
/// between the limits c_i and c_(i+1) of neighbouring headings and must stay below the drive cost. Between
/// two directions at which the gradient along or across passes a node of the cost table, cost - gauge is f =
/// A + h1 + h2, a constant and harmonics of first and second order of the angle, so f'' = A - f - 3 h2. Over
/// a piece of width w, f lies below its chord by at most w^2 / 8 times the largest f''. For each piece, the
/// limits of both adjacent headings are lowered by the largest violation. Finally the limits are made convex:
/// a limit above the value implied by two others is lowered to that value.
///
/// Not thread-safe.
class DirectionalCostBounds {
 public:
  static constexpr int kHeadings = 64;
  using Limits = std::array<float, kHeadings>;  ///< joules per metre, > 0, counter-clockwise from east

  /// The TravelCost must outlive the DirectionalCostBounds.
  explicit DirectionalCostBounds(const costmap::TravelCost& cost) : cost_(cost) {}

  /// Computes the limits of a cell. Returns false if no heading is allowed.
  bool of(costmap::CellCode cell, Limits& limits);

  /// Unit vector of heading k, k = 0 to kHeadings.
  static costmap::Direction heading(int k) noexcept;

 private:
  // Interval of directions, relative to the steepest ascent, in which the gradients along and across pass no
  // node of the table. A metre towards (x, y) costs level + x_J x + y_J |y| + both_J x |y|; infinite if
  // refused.
  struct Piece {
    costmap::Direction from, to;
    double level_J, x_J = 0.0, y_J = 0.0, both_J = 0.0;
  };

  using Gauge = std::array<double, kHeadings>;

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
  std::vector<costmap::Direction> nodes_;  // a quarter turn, from the steepest ascent
  std::vector<Piece> pieces_;              // half a turn
};

}  // namespace talus::planner
