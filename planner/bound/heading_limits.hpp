#pragma once

#include <array>
#include <vector>

#include <talus/costmap/cost/drive_cost.hpp>

namespace talus::planner {

/// What a metre costs at least along 64 headings of a cell. A function of the place of which a metre along each
/// heading takes no more than the heading's limit falls in no direction faster than the drive cost.
///
/// Why between the headings too (ours). The gauge that is linear between the limits of neighbouring headings, c_i and
/// c_(i+1), shall stay below the drive cost. Between directions at which the gradient along or across passes a node
/// of the cost's table, cost less gauge is f = A + h1 + h2, a constant and harmonics of first and second order of the
/// angle, so f'' = A - f - 3 h2: over a piece of width w, f lies below its chord by no more than w^2 / 8 times the
/// largest f''. Every piece is looked at, and the limits of both headings about it are lowered by what it lacks. At
/// last they are made convex: a limit that others imply is lowered to what they imply.
///
/// Not thread-safe.
class HeadingLimits {
 public:
  static constexpr int kHeadings = 64;
  using Limits = std::array<float, kHeadings>;  ///< joules a metre, > 0, counter-clockwise from east

  /// The DriveCost must outlive it.
  explicit HeadingLimits(const costmap::DriveCost& cost) : cost_(cost) {}

  /// False where no heading is allowed.
  bool of(costmap::CellCode cell, Limits& limits);

  /// Unit vector of a heading, 0 to kHeadings.
  static costmap::Direction heading(int k) noexcept;

 private:
  // Directions, as seen from the steepest climb, between which the gradients along and across pass no node of the
  // table; towards (x, y) a metre costs level + x_J x + y_J |y| + both_J x |y|, infinite where refused.
  struct Piece {
    costmap::Direction from, to;
    double level_J, x_J = 0.0, y_J = 0.0, both_J = 0.0;
  };

  using Gauge = std::array<double, kHeadings>;

  void addNodes(double steepness);
  void addPieces(const costmap::DriveCurve& curve, double steepness);
  Piece pieceOf(const costmap::DriveCurve& curve, double steepness, const costmap::Direction& from,
                const costmap::Direction& to) const;
  void addRefused(const costmap::DriveCurve& curve, double steepness, const costmap::Direction& at);
  template <typename Each>
  void forEachPart(const costmap::Direction& climb, Each each) const;

  Gauge gaugeOf(costmap::CellCode cell, const costmap::Direction& climb) const;
  Gauge lackOf(const Gauge& gauge, const costmap::Direction& climb) const;

  const costmap::DriveCost& cost_;
  std::vector<costmap::Direction> nodes_;  // a quarter, of the steepest climb first
  std::vector<Piece> pieces_;              // half a turn
};

}  // namespace talus::planner
