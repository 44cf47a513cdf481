#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include <talus/costmap/cost/drive_cost.hpp>
#include <talus/terramech/mobility/slope_equilibrium.hpp>

namespace talus::costmap {

class LevelClimbs;
class SlopeRows;

/// What the parts of the one cost function count: cost = energy_J * energy + time_s * time_W + hazard *
/// risk_J.
struct CostWeights {
  double energy = 1.0;  ///< [-], >= 0
  double time_W = 1.0;  ///< joules that one second is worth, >= 0
  double risk_J = 1e7;  ///< joules that the loss of the rover is worth, >= 0
};

/// What a slope is worth on the ground of one class, as climbs straight up under even loads (ours): for every gradient
/// along and across at the nodes of DriveCurve, row 0 included,
/// - the climb that costs as much: on it SlopeEquilibrium finds no less energy and time a metre;
/// - the climb that leaves as little: the strength that the ground may lose until nothing holds is the same. A
///   loss d takes d of the pull and the share d / thrust of the side force, thrust the gross thrust over load
///   at the reference slip;
/// - the descent that is braked as hard, where it fails no more than 0.16 below the limit of pitch.
/// None is less steep than the gradient along, and none gets gentler from row to row, so cost, risk and refusal never
/// fall as the gradient across grows. All three are the class's own: a belief moves them as it moves the climbs. Nodes
/// at which the rover tips are refused on any ground: how its body lies is that on the class's ground.
///
/// Both equilibria read one table of wheel forces, so that its errors cancel: a rover whose slopes move no load costs on
/// row 0 what the mobility curve says. Along, equilibria are solved 1/32 apart, linear between. Where the gradients
/// that hold fall apart into several ranges the longest counts. Immutable.
class CrossSlope {
 public:
  /// What the class's ground gives without crossing.
  struct Level {
    double first = 0.0, last = -1.0;  ///< gradients along that hold; first > last: none
    double thrust = 1.0;              ///< gross thrust over load at the reference slip [-], > 0
  };
  CrossSlope(const terramech::SlopeEquilibrium& equilibrium, const Level& level,
             const DriveCost::Limits& limits);

  /// Of a planner that knows slopes along the heading only: crossing costs nothing more and never fails. For
  /// comparison with such planners.
  static CrossSlope alongOnly();

  /// Of ground that may be of either: the harder of both.
  static CrossSlope harder(const CrossSlope& a, const CrossSlope& b);

  /// Rows that differ, the level one included; the last refuses every heading unless the limits come first.
  int rows() const noexcept { return static_cast<int>(climbs_.size()) / DriveCurve::kBins; }

  /// The state at a node: energy and time of the climbs up to that which costs as much, risk and refusal
  /// of those up to that which leaves as little, with category and margin there. Rows beyond the last are as the last.
  DriveState state(const DriveTable& states, int row, int bin) const noexcept;

  /// Costs of all nodes, row by row: of state() each.
  std::shared_ptr<const std::vector<float>> costs(const DriveTable& states, const CostWeights& weights) const;

  /// How the rover holds a slope, linear between equilibria; of two grounds on the first.
  SlopeHold hold(const terramech::Gradient& gradient) const noexcept;

  /// The climb that leaves as little as a slope; 4 where it holds on no ground.
  double climb(const terramech::Gradient& gradient) const noexcept;
  /// The steepest of these climbs over the headings on a plane of this gradient, never below that.
  double steepest(double gradient) const noexcept;

 private:
  // Places between bins; `refused` where nothing holds, whatever the strength.
  struct Climbs {
    float costs = 0.0F, leaves = 0.0F, brakes = 0.0F;
    float more_slip = 0.0F;  // than on the climb that costs as much
    Refusal refused = Refusal::None;
  };
  // What the equilibrium says at one of the gradients along of a row.
  struct Held {
    SlopeHold hold;
    terramech::SlopeFailure grip = terramech::SlopeFailure::None;
  };
  // The gradients along between which level ground holds under even loads.
  struct Ends {
    double first, last;
  };
  struct Strengths;
  CrossSlope() = default;
  static Strengths solvedRows(const SlopeRows& lattice, const SlopeRows& even_lattice, const Ends& even,
                              int last_row);
  void addRow(int row, const Strengths& strengths, const LevelClimbs& level_climbs, const Level& level,
              const DriveCost::Limits& limits);
  void addLevelRow();
  static Climbs harder(const Climbs& a, const Climbs& b) noexcept;
  void tabulateSteepest();
  const Climbs& at(int row, int bin) const noexcept {
    return climbs_[static_cast<std::size_t>(std::min(row, rows() - 1) * DriveCurve::kBins + bin)];
  }
  SlopeHold holdInRow(int row, double along) const noexcept;
  Refusal reasonAt(int row, int bin) const noexcept;

  std::vector<Climbs> climbs_;
  std::vector<std::vector<Held>> held_;  // by row, as far as any gradient holds
  int first_along_ = 0;                  // of their first, in steps between equilibria
  std::vector<float> steepest_;          // by gradient in steps of CellCode, up to 1
};

/// What a metre costs on ground with these states, under these weights, across slopes too.
DriveCurve priced(const DriveTable& states, const CrossSlope* crossing, const CostWeights& weights);

}  // namespace talus::costmap
