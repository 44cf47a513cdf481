#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include <talus/costmap/cost/travel_cost.hpp>
#include <talus/terramech/mobility/slope_equilibrium.hpp>

namespace talus::costmap {

class LevelClimbs;
class SlopeRows;

/// Weights of the cost function: cost = energy * energy_J + time_W * time_s + risk_J * hazard, where `hazard`
/// is TravelState::risk_per_m.
struct CostWeights {
  double energy = 1.0;  ///< weight of energy, >= 0 [-]
  double time_W = 1.0;  ///< weight of time, >= 0 [J/s]
  double risk_J = 1e7;  ///< cost of the loss of the rover, >= 0 [J]
};

/// Table of equivalent straight slopes for the ground of one terrain class (ours). The table covers slopes
/// with a gradient along the heading and a gradient across the heading, at the nodes (pairs of both
/// gradients) of TravelCurve. All nodes of a row have the same gradient across, which is 0 in row 0. Each
/// node is represented by the gradients of three slopes without cross slope, under even wheel loads:
///   - `costs`: a climb with at least the energy and time per metre that SlopeEquilibrium finds at the node;
///   - `leaves`: the climb with the same strength reserve d, i.e. the loss of drawbar pull over load at which
///     driving on the slope fails. A loss d reduces the side force by the fraction d / thrust, with thrust =
///     gross thrust / load at the reference slip;
///   - `brakes`: the descent with the same braking reserve. Descents are solved up to the gradient 0.16
///     beyond the pitch limit.
/// `costs` and `leaves` are at least as steep as the node's gradient along the heading, and none of the three
/// slopes becomes less steep from row to row: cost, risk and refusal never decrease with the gradient across.
/// The three slopes depend on the soil of the class alone; an estimate of the ground changes the travel
/// states on these slopes. Nodes at which the rover tips are refused (have infinite cost) on any soil; the
/// attitude of the body is that on the soil of the class.
///
/// The equilibria with load transfer and those under even loads use one table of wheel forces, so that errors
/// of the table cancel: without load transfer, row 0 has the cost of the mobility curve. Equilibria are
/// solved at gradients along the heading in steps of 1/32 and interpolated linearly. If the gradients without
/// failure form several intervals, the interval nearest to level ground is used; if several intervals are
/// equally near, the longest of them is used. Immutable.
class CrossSlope {
 public:
  /// Limits and thrust of the class's ground without cross slope.
  struct Level {
    /// Interval of gradients along the heading without failure; empty if first > last.
    double first = 0.0, last = -1.0;
    double thrust = 1.0;  ///< gross thrust / load at the reference slip [-], > 0
  };
  CrossSlope(const terramech::SlopeEquilibrium& equilibrium, const Level& level,
             const TravelCost::Limits& limits);

  /// Returns a table that ignores cross slopes: no additional cost and no failure. It serves comparisons with
  /// planners that consider slopes along the heading only.
  static CrossSlope alongOnly();

  /// Returns the table for ground that may belong to the class of `a` or of `b`: at each node the less
  /// favourable values of both tables.
  static CrossSlope harder(const CrossSlope& a, const CrossSlope& b);

  /// Returns the number of tabulated rows, row 0 included. Steeper gradients across the heading use the last
  /// row. The last row refuses every heading, unless the limits of roll or pitch end the table first.
  int rows() const noexcept { return static_cast<int>(climbs_.size()) / TravelCurve::kBins; }

  /// Returns the travel state at the node in `row` (gradient across) and `bin` (gradient along the heading),
  /// from the states without cross slope `states`. Energy and time are maxima over the climbs up to `costs`.
  /// Pull margin and category are the worst over the climbs up to `leaves`. Risk and refusal are the worst
  /// from `brakes` to `leaves`.
  TravelState state(const TravelTable& states, int row, int bin) const noexcept;

  /// Returns the costs [J/m] of state() at all nodes, row by row.
  std::shared_ptr<const std::vector<float>> costs(const TravelTable& states,
                                                  const CostWeights& weights) const;

  /// Returns slip angle, side force and stability margin on a slope, interpolated between equilibria. The
  /// result of harder(a, b) has the values of `a`.
  SlopeHold hold(const terramech::Gradient& gradient) const noexcept;

  /// Returns the gradient of the straight climb with the same strength reserve as a slope; 4 if any soil
  /// refuses the slope.
  double climb(const terramech::Gradient& gradient) const noexcept;
  /// Returns the maximum of climb() over all headings on a plane of this gradient; at least `gradient`.
  double steepest(double gradient) const noexcept;

 private:
  // Gradients of the three equivalent straight slopes (class comment), in bins of TravelCurve; `refused` is
  // the reason of a refusal on any soil.
  struct Climbs {
    float costs = 0.0F, leaves = 0.0F, brakes = 0.0F;
    float more_slip = 0.0F;  // additional slip relative to the climb `costs`
    Refusal refused = Refusal::None;
  };
  // Equilibrium of a row at one gradient along the heading.
  struct Held {
    SlopeHold hold;
    terramech::SlopeFailure grip = terramech::SlopeFailure::None;
  };
  // Interval of gradients along the heading without failure, on row 0 under even loads.
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
  std::vector<std::vector<Held>> held_;  // equilibria by row, up to the last row with an equilibrium
  int first_along_ = 0;          // index of the first gradient along the heading, in steps of kAlongStep
  std::vector<float> steepest_;  // results of steepest(), by gradient in steps of CellCode up to 1
};

/// Returns the cost curve [J/m] of ground with the travel states `states` and the given weights. The curve
/// has the rows of `crossing` if `crossing` is not null.
TravelCurve priced(const TravelTable& states, const CrossSlope* crossing, const CostWeights& weights);

}  // namespace talus::costmap
