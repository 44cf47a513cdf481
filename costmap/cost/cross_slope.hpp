#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include <talus/costmap/cost/travel_cost.hpp>
#include <talus/terramech/mobility/slope_equilibrium.hpp>

namespace talus::costmap {

class LevelClimbs;
class SlopeRows;

/// Weights of the cost function: cost = energy_J * energy + time_s * time_W + hazard * risk_J.
struct CostWeights {
  double energy = 1.0;  ///< weight of energy [-], >= 0
  double time_W = 1.0;  ///< weight of time [J/s], >= 0
  double risk_J = 1e7;  ///< cost of the loss of the rover [J], >= 0
};

/// Equivalent straight slopes for the ground of one class (ours). Each node of TravelCurve (gradient along,
/// gradient across; row 0 included) is represented by three gradients without cross slope, under even wheel
/// loads:
///   - costs: a climb with at least the energy and time per metre that SlopeEquilibrium finds at the node;
///   - leaves: the climb with the same strength reserve, i.e. the same loss d of drawbar pull over load at
///     which the slope fails. A loss d reduces the side force by the fraction d / thrust, with thrust =
///     gross thrust / load at the reference slip;
///   - brakes: the descent with the same braking reserve. Descents are solved up to the gradient 0.16 beyond
///     the pitch limit.
/// A climb is at least as steep as the node's gradient along, and no slope becomes less steep from row to
/// row: cost, risk and refusal never decrease with the gradient across. The slopes follow from the class's
/// soil alone; an estimate of the ground changes the states on these slopes. Nodes at which the rover tips
/// are refused on any soil; the attitude of the body is that on the soil of the class.
///
/// The equilibria with load transfer and those under even loads use one table of wheel forces, so that the
/// table errors cancel: without load transfer, row 0 has the cost of the mobility curve. Equilibria are
/// solved at gradients along 1/32 apart and interpolated linearly. If the gradients without failure form
/// several intervals, the interval nearest to level ground is used; of equally near intervals, the longest.
/// Immutable.
class CrossSlope {
 public:
  /// Limits and thrust of the class's ground without cross slope.
  struct Level {
    double first = 0.0, last = -1.0;  ///< gradients along without failure; first > last: empty interval
    double thrust = 1.0;              ///< gross thrust / load at the reference slip [-], > 0
  };
  CrossSlope(const terramech::SlopeEquilibrium& equilibrium, const Level& level,
             const TravelCost::Limits& limits);

  /// Ignores cross slopes: no additional cost and no failure. For comparison with planners that consider
  /// slopes along the heading only.
  static CrossSlope alongOnly();

  /// Slopes for ground of the class of `a` or of `b`: at each node the less favourable values of both.
  static CrossSlope harder(const CrossSlope& a, const CrossSlope& b);

  /// Returns the number of tabulated rows, row 0 included. Steeper gradients across use the last row, which
  /// refuses every heading unless the limits of roll or pitch end the table first.
  int rows() const noexcept { return static_cast<int>(climbs_.size()) / TravelCurve::kBins; }

  /// State at a node. Energy and time: maximum over the climbs up to `costs`. Pull margin and category: over
  /// the climbs up to `leaves`. Risk and refusal: from `brakes` to `leaves`.
  TravelState state(const TravelTable& states, int row, int bin) const noexcept;

  /// Returns the costs [J/m] of state() at all nodes, row by row.
  std::shared_ptr<const std::vector<float>> costs(const TravelTable& states,
                                                  const CostWeights& weights) const;

  /// Slip angle, side force and stability margin on a slope, interpolated between equilibria; after harder(a,
  /// b), those of a.
  SlopeHold hold(const terramech::Gradient& gradient) const noexcept;

  /// Returns the gradient of the climb with the same strength reserve as a slope; 4 if refused on any soil.
  double climb(const terramech::Gradient& gradient) const noexcept;
  /// Returns the maximum of climb() over the headings on a plane of this gradient, at least `gradient`.
  double steepest(double gradient) const noexcept;

 private:
  // Gradients of the three straight climbs (class comment), in bins of TravelCurve; `refused` applies at any
  // strength.
  struct Climbs {
    float costs = 0.0F, leaves = 0.0F, brakes = 0.0F;
    float more_slip = 0.0F;  // slip in addition to that of the climb `costs`
    Refusal refused = Refusal::None;
  };
  // Equilibrium of a row at one gradient along the heading.
  struct Held {
    SlopeHold hold;
    terramech::SlopeFailure grip = terramech::SlopeFailure::None;
  };
  // Interval of gradients along without failure on row 0 under even loads.
  struct Ends {
    double first, last;
  };
  struct Strengths;
  CrossSlope() = default;
  static Strengths solvedRows(const SlopeRows& lattice, const SlopeRows& even_lattice, const Ends& even,
                              int last_row);
  void addRow(int row, const Strengths& strengths, const LevelClimbs& level_climbs, const Level& level,
              const TravelCost::Limits& limits);
  void addLevelRow();
  static Climbs harder(const Climbs& a, const Climbs& b) noexcept;
  void tabulateSteepest();
  const Climbs& at(int row, int bin) const noexcept {
    return climbs_[static_cast<std::size_t>(std::min(row, rows() - 1) * TravelCurve::kBins + bin)];
  }
  SlopeHold holdInRow(int row, double along) const noexcept;
  Refusal reasonAt(int row, int bin) const noexcept;

  std::vector<Climbs> climbs_;
  std::vector<std::vector<Held>> held_;  // by row, up to the last row with an equilibrium
  int first_along_ = 0;                  // index of the first gradient along, in steps of kAlongStep
  std::vector<float> steepest_;          // by gradient in steps of CellCode, up to 1
};

/// Returns the cost [J/m] of ground with these states and weights, with the rows of `crossing` if not null.
TravelCurve priced(const TravelTable& states, const CrossSlope* crossing, const CostWeights& weights);

}  // namespace talus::costmap
