#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include <talus/costmap/cost/cost_model.hpp>
#include <talus/planner/bound/fitted_octagon.hpp>
#include <talus/planner/field/cost_to_go.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// Returns the lowest cost per metre [J/m] over all cost curves (kinds of ground, costmap::TravelCurve) that
/// occur on the map and all gradients; 0 if no cell has a cost curve. Only row 0 of each cost curve (no
/// gradient across the heading) is read, because no other row has a lower cost.
double cheapestMetre_J(const costmap::CostGrid& map);

/// Returns a lower bound [J] of the cost of any motion from `places.from` to within `tolerance_m` of
/// `places.to`: the distance times the lowest cost per metre of all cost curves (kinds of ground). The
/// function reads no cell.
double straightBound_J(const costmap::CostGrid& map, const Segment& places, double tolerance_m = 0.0);

/// Returns a lower bound [J] from the lowest cost per metre of the reachable cells. `known_J` is the cost of
/// a known route, infinite if none is known. The result is at least min(straightBound_J(), known_J) and at
/// most known_J. On uniform ground the bound proves that the straight line is optimal. After a stop, returns
/// the bound found so far.
///
/// Derivation (ours, not from the literature). Let D be the distance and S >= 2 D. The points whose distances
/// to both places sum to at most S form an ellipse. A route that leaves the ellipse drives at least (S - D) /
/// 2 from the first place to its boundary and at least the same distance back to the second place. Therefore
/// every route drives D metres inside the ellipse, each at no less than the lowest cost per metre there. A
/// route of at most known_J is no longer than S = known_J / (lowest cost per metre), also if S < 2 D. A
/// tolerance shortens all lengths equally. The computation takes a few nanoseconds per cell of the bounding
/// box of the ellipse and iteration.
double straightBoundOver_J(const costmap::CostGrid& map, const Segment& places, double tolerance_m,
                           double known_J = std::numeric_limits<double>::infinity(),
                           const StopCheck& stop = {});

/// Returns the octagon of a cell inside the map; infinite weights for a cell that no route enters.
using OctagonOf = std::function<Octagon(maps::Cell)>;

/// Direction of the routes: from the corners of cells to the goal, or from the start to the corners.
enum class RouteSense { ToGoal, FromStart };

/// Returns lower bounds of the costs between neighbouring cell corners, along cell sides and across cells.
/// The cost-to-go field over these edges is a lower bound of the cost of every continuous route of any shape
/// and heading, not only of grid routes. Corners are numbered like cells: a corner has the index of the cell
/// to its north-east. The corner grid has one column and one row more than the cell grid. For
/// RouteSense::FromStart every edge has the cost of the opposite motion.
///
/// Proof of the lower bound (ours, not from the literature). The gauge N of an Octagon is convex and at most
/// equal to the cost per metre of the cell. Take a field over corners whose differences along the sides and
/// both diagonals of the cell are at most w_k, and interpolate the field linearly along the sides. Between any
/// two points of the cell's boundary the field then changes by at most N. Therefore the field can be extended
/// into the cell such that it changes no faster than N (McShane 1934 [mcshane_1934]). Along any allowed motion
/// the extended field changes by at most the cost of the motion. A step along a side has the lower of the
/// costs in the two cells beside the side. Costs are rounded down to whole units.
///
/// Returns null after a stop, or if the lowest cost per metre of the map is 0.
std::shared_ptr<const EdgeLayer> admissibleEdges(const std::shared_ptr<const costmap::CostGrid>& map,
                                                 const OctagonOf& octagon_of, const StopCheck& stop = {},
                                                 RouteSense sense = RouteSense::ToGoal);

/// Returns the cost-to-go field [J] over admissibleEdges() by index of the corner, row by row: at most the
/// given value at `ends`, infinite where no route leads. The result is empty after a stop, or if the
/// lowest cost per metre of the map is 0.
std::vector<float> cornerField(const std::shared_ptr<const costmap::CostGrid>& map,
                               const OctagonOf& octagon_of, std::vector<FieldGoal> ends,
                               const StopCheck& stop = {}, RouteSense sense = RouteSense::ToGoal);

/// Computes a lower bound of the cost of every route to a goal, of any shape and heading, in levels. Each level
/// is a cost-to-go field over admissibleEdges(), and none lowers the bound.
///
/// Level 1 fits the octagons of all cells alike (FittedOctagons). With F, the field of the start, and B, the
/// field of the goal, every route of at most a cost L stays in the region of the cells with a corner at which
/// F + B <= L: it crosses the boundary of each cell where the interpolated sum is at most L (ours; compare
/// Clawson, Chacon and Vladimirsky 2014 [clawson_2014]). Level 2 consists of rounds within the region of the known
/// cost. Each fits the octagons of the cells on routes of at most the bound and a third of the gap to the differences
/// of F between their corners, and computes F anew; B follows every second time. The field satisfies its own
/// differences, so that fits never lower it. The last round is the one that closes less than 3 % of the gap. Level 3
/// is a SubSolution in the region of the highest L that has a limited number of cells; it proves at most L, and cells
/// are added while it proves L. In the region of the known cost, cells are then divided into equal cells, which halves
/// the length on which the solution is linear, again and again. The work of each level is limited.
/// straightBoundOver_J(), or the bound on a uniform map that is nowhere more expensive, is used if it is higher.
class LowerBound {
 public:
  /// Returns the lower bound [J] for routes from `places.from` to within `goal_tolerance_m` of `places.to`.
  /// `known_J` is the cost of a known route; the result is between 0 and known_J. If the relative difference
  /// of a bound from known_J is at most `gap` or kEven, no further level is computed. A level that a stop ended
  /// contributes 0. `gap` 0: levels 2 and 3 end at kEnough.
  double operator()(const std::shared_ptr<const costmap::CostGrid>& map, const Segment& places,
                    double goal_tolerance_m, const StopCheck& stop = {},
                    double known_J = std::numeric_limits<double>::infinity(), double gap = 0.0);

  /// Computes level 1 of toGoal_J(). Returns false after a stop or if there is no bound.
  bool prepare(const std::shared_ptr<const costmap::CostGrid>& map, maps::Point goal, double goal_tolerance_m,
               const StopCheck& stop);

  /// Returns the cells, by index, outside of which no route of at most `most_J` [J] leads; empty after a stop or if
  /// there is no bound.
  std::vector<bool> corridor(const std::shared_ptr<const costmap::CostGrid>& map, const Segment& places,
                             double goal_tolerance_m, double most_J, const StopCheck& stop = {});

  /// Returns the best lower bound [J] of the cost from a place to the goal of the latest call, bilinear in each
  /// cell and therefore proven on cell sides only; 0 if there is none, infinite where no route leads.
  double toGoal_J(maps::Point place) const noexcept;

  /// Relative difference to the cost of the known route up to which a bound suffices.
  static constexpr double kEven = 1e-4;
  /// Relative difference up to which levels 2 and 3 suffice without a stated gap.
  static constexpr double kEnough = 0.02;

 private:
  OctagonOf octagonOf();
  double throughCell_J(maps::Cell cell) const;
  template <typename Each>
  void forEachInside(Each each) const;
  double costFor(std::size_t cells, double least_J, double known_J) const;
  double narrowed_J(const Segment& places, const std::vector<FieldGoal>& starts, double known_J,
                    double enough_J, const StopCheck& stop);
  // Returns the bound [J], at least `bound_J`, of level 3.
  double certified_J(const Segment& places, double bound_J, double known_J, double enough_J,
                     const StopCheck& stop);

  std::shared_ptr<const costmap::CostGrid> map_;
  std::optional<FittedOctagons> octagons_;
  std::vector<float> level_1_;               // field of the goal, level 1
  std::vector<float> from_start_, to_goal_;  // best fields
  std::vector<bool> inside_;                 // cells on routes of at most the known cost
  maps::Point goal_;
  double tolerance_m_ = 0.0;
};

}  // namespace talus::planner
