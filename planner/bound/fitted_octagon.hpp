#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <deque>
#include <vector>

#include <talus/costmap/cost/cost_model.hpp>
#include <talus/planner/field/edge_layer.hpp>

namespace talus::planner {

/// Consecutive numbers of cell codes whose gradient lies in the first eighth of the plane (0 <= dz/dy <= dz/dx), in
/// the order of their first request, so that data of codes can be stored in arrays. The numbers are in tables by
/// curve and gradient, because neighbouring cells have similar gradients. Not thread-safe.
class CodeNumbers {
 public:
  /// Returns the number of a code, which is size() before the call for a new code.
  std::uint32_t of(costmap::CellCode code) {
    std::vector<std::uint32_t>& table = tables_[code.curve()];
    // The gradient without an opposite is negative and may stand at either place.
    const auto [y, x] = std::minmax({std::abs(code.stepsX()), std::abs(code.stepsY())});
    const auto at = static_cast<std::size_t>(x * (x + 1) / 2 + y);
    if (at >= table.size()) table.resize(static_cast<std::size_t>((x + 1) * (x + 2) / 2), kNone);
    if (table[at] == kNone) table[at] = size_++;
    return table[at];
  }

  /// Returns the number of codes.
  std::uint32_t size() const noexcept { return size_; }

 private:
  static constexpr std::uint32_t kNone = 0xffffffffU;

  std::vector<std::vector<std::uint32_t>> tables_ =
      std::vector<std::vector<std::uint32_t>>(std::size_t{costmap::CellCode::kBlocked} + 1);
  std::uint32_t size_ = 0;
};

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
  explicit DirectionalCostBounds(const costmap::TravelCost& cost)
      : cost_(cost), steepest_(1.001 * std::hypot(cost.limits().max_along, cost.limits().max_across)) {}

  /// Sets the limits of a cell. Returns false if the cell allows no heading.
  bool of(costmap::CellCode cell, Limits& limits);

  /// A cell code whose gradient lies in the first eighth of the plane, and the reflections that lead there.
  struct Reflected {
    costmap::CellCode cell;
    bool west = false, south = false, steeper_north = false;

    /// Returns the index, 0 to 7, of the combination of reflections, and the combination with an index.
    unsigned kind() const noexcept {
      return (west ? 1U : 0U) + (south ? 2U : 0U) + (steeper_north ? 4U : 0U);
    }
    static Reflected ofKind(unsigned kind) noexcept {
      return {{}, (kind & 1U) != 0, (kind & 2U) != 0, (kind & 4U) != 0};
    }

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

  /// Returns the number, from 0, of the limits of a reflected cell code, which are computed at the first request.
  std::uint32_t numberOf(const Reflected& reflected);
  /// Returns the limits with a number; the first one is negative if the cell allows no heading.
  const Limits& reflectedLimits(std::uint32_t number) const noexcept { return known_[number]; }

  /// Calls each(limits) for every cell code that was requested and allows some heading.
  template <typename Each>
  void forEachRequested(Each each) const {
    for (std::size_t i = 0; i < known_.size(); ++i)
      for (unsigned kind = 0; kind < 8; ++kind)
        if ((asked_[i] >> kind & 1U) != 0 && known_[i].front() >= 0.0F)
          each(turned(known_[i], Reflected::ofKind(kind)));
  }

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
  static Limits turned(const Limits& reflected, const Reflected& by) noexcept {
    Limits limits;
    for (int k = 0; k < kHeadings; ++k)
      limits[static_cast<std::size_t>(k)] = reflected[by.heading(k, kHeadings)];
    return limits;
  }

  double steepest_;                  // largest gradient that some heading allows
  CodeNumbers numbers_;              // of reflected cell codes
  std::deque<Limits> known_;         // by number; negative: no heading
  std::vector<std::uint8_t> asked_;  // by number: bit mask of the kinds of reflections requested
};

/// Weights w_k [J/m] > 0 of the eight headings e_k of the grid, indexed by GridHeading. The gauge, a function
/// of direction that equals w_k at e_k and is linear between neighbouring headings, is convex and at most the
/// cost per metre of a cell. All weights are infinite for a cell that allows no heading.
using Octagon = std::array<float, 8>;

/// Returns an octagon below the limits of a cell that is near `wanted`. A function of position that decreases
/// per metre along each heading e_k by at most wanted_k, and satisfies the limits, also satisfies the octagon.
///
/// Proof of the lower bound (ours, not from the literature). The gauge of the limits is linear between 64
/// headings, eight of which lie in each sector of the octagon, where the gauge of the octagon is linear.
/// Therefore the octagon is below the limits everywhere if it is below them at the 64 headings. Each wanted
/// weight is scaled by the worst ratio of its two sectors. Then the weights are raised: all at once by half of the increase that the limits and the neighbours
/// permit, so that two neighbours together stay below a shared limit, then one after the other by all of it.
/// Lowering the weights until sqrt(2) w_k <= w_(k-1) + w_(k+1) makes the gauge convex.
Octagon fittedOctagon(const DirectionalCostBounds::Limits& limits, const Octagon& wanted);

/// Octagons of cells whose costs are wanted equally in all directions, computed at the first use of a cell
/// code or a reflection of it. Not thread-safe.
class FittedOctagons {
 public:
  /// `cost` must outlive the object.
  explicit FittedOctagons(const costmap::TravelCost& cost) : limits_(cost) {}

  /// Returns the octagon of a cell code.
  Octagon of(costmap::CellCode cell);

  /// Returns the limits of the cost function.
  DirectionalCostBounds& limits() noexcept { return limits_; }

  /// Every weight of an octagon is at least this share of the lowest cost per metre of the cell's cost curve.
  static constexpr double kLeastShare = 0.05;

 private:
  Octagon fitted(const DirectionalCostBounds::Limits& limits);

  DirectionalCostBounds limits_;
  std::vector<Octagon> known_;  // by the number of the limits
};

}  // namespace talus::planner
