#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <tuple>
#include <utility>
#include <vector>

#include <talus/costmap/cost/cost_model.hpp>
#include <talus/costmap/ground/ground_model.hpp>

namespace talus::costmap {

/// Returns the heading that determines the category of a cell: straight uphill, or a heading across the slope
/// if its equivalent climb is steeper by more than 1/32.
Direction worstHeading(const TravelCost& cost, CellCode cell) noexcept;

/// Returns the category of ground with the estimate `belief` in one heading, and its probability. `state` is
/// the result of TravelCost::detail() and `climb` the result of TravelCost::climb() for that heading. Ground that is
/// refused (has infinite cost) for a reason other than its category is dangerous.
RankedCategory judged(const GroundModel& model, const GroundBelief& belief, const TravelState& state,
                      double climb);

/// Category of ground of one estimated strength, tabulated over the gradient of the plane of a cell in steps
/// of CellCode. The category is the worst over all headings, and dangerous if worstHeading() is refused. The
/// gradient of a cell is rounded up to a step.
class CategoryTable {
 public:
  /// Makes the table of ground with the estimate `belief`; `ground` is the result of GroundModel::ground()
  /// for it. It is computed at the first call of at().
  CategoryTable(std::shared_ptr<const GroundModel> model, const GroundBelief& belief, GroundCost ground);

  /// Returns the entry for the gradient of a cell. Thread-safe.
  CellCategory at(CellCode cell) const;

 private:
  std::vector<CellCategory> tabulated() const;

  std::shared_ptr<const GroundModel> model_;
  GroundBelief belief_;
  GroundCost ground_;
  mutable std::once_flag once_;
  mutable std::vector<CellCategory> entries_;
};

/// Returns an estimate of the strength of ground of a class, rounded so that similar estimates share one cost
/// curve. Each quantity is relative to `prior`, the estimate of the class before any evidence
/// (GroundModel::prior()), and rounded towards danger, in steps of
///   - drawbar pull over load DP/W: 0.005, rounded down;
///   - standard deviation of DP/W: a factor 2^(1/8), from 1/64 to 256 times that of the prior, rounded up;
///   - sinkage over wheel radius: 0.02, rounded up.
/// An estimate no worse than the prior is not rounded beyond the prior, so that little evidence never increases a
/// cost. The standard deviation of sinkage is reduced in proportion to that of DP/W, and is at most that of the
/// class. A rounded estimate is unchanged.
GroundBelief rounded(const GroundBelief& belief, const GroundBelief& prior,
                     const GroundClass& ground) noexcept;

/// Table of the cost curves of a map. A cost curve is the cost per metre over the gradient for ground of one
/// estimated strength. The table assigns an index to each estimate. The indices 0 .. classes-1 belong to the priors
/// of the terrain classes. The curve of a prior is computed at the first call of prior() for its class; before that
/// call, it refuses every heading, i.e. has infinite cost. The constructor computes the curve of the first class. An
/// estimate from telemetry is rounded towards danger (rounded()) and receives an index at its first occurrence, or
/// CellCode::kBlocked, which refuses every heading, if the table is full. Not thread-safe.
class CostCurveTable {
 public:
  /// Greatest number of curves: each takes some 0.1 MB here and in a planner.
  static constexpr std::size_t kMost = 8192;

  explicit CostCurveTable(std::shared_ptr<const GroundModel> model);

  /// Returns the index of the curve of a class's prior. priorBelief() returns the prior itself.
  CellCode::Curve prior(int class_index);
  const GroundBelief& priorBelief(int class_index) const {
    return priors_[static_cast<std::size_t>(class_index)];
  }
  /// Returns the index of the curve of an estimate from telemetry, for ground of the class `class_index`, or
  /// possibly of `other_class` (-1: none). No cost of the curve is below the cost of the same estimate on either
  /// class.
  CellCode::Curve learned(int class_index, const GroundBelief& belief, int other_class = -1);

  /// Returns the index of a curve that equals the curve with index `number` except that `added_J_per_m` is
  /// added to the energy. `number` must not be a result of dearer(). `step` > 0 identifies the added energy. Returns
  /// CellCode::kBlocked if the table is full.
  CellCode::Curve dearer(CellCode::Curve number, int step, double added_J_per_m);

  /// Returns the number of indices in use.
  std::size_t size() const noexcept { return curves_.size(); }
  /// Discards all estimates from telemetry.
  void restart();

  /// Replaces the prior of a class by the estimate `next` from evidence. Returns false if the prior is
  /// unchanged, as in most calls.
  bool setPrior(int class_index, const GroundBelief& next);

  /// Returns the estimate from which the curve with an index was computed.
  const GroundBelief& belief(CellCode::Curve number) const { return curves_[number].belief; }
  /// Returns the categories of the ground with a curve index, tabulated over the gradient of the plane of a
  /// cell.
  const CategoryTable& categories(CellCode::Curve number) const { return *curves_[number].categories; }

  /// Returns the cost function with the curves of all assigned indices. Calls return the same object until a
  /// curve is added.
  std::shared_ptr<const TravelCost> cost() const;

 private:
  struct Curve {
    GroundCost ground;
    GroundBelief belief;
    std::shared_ptr<const CategoryTable> categories;
  };
  Curve curve(const GroundCost& ground, const GroundBelief& belief) const {
    return {ground, belief, std::make_shared<const CategoryTable>(model_, belief, ground)};
  }
  Curve dearer(Curve curve, double added_J_per_m) const;
  SoilUncertainty uncertainty() const;
  void price(std::size_t class_index);
  CellCode::Curve added(Curve curve);
  std::size_t classes() const noexcept { return model_->parts().classes.size(); }

  std::shared_ptr<const GroundModel> model_;
  std::vector<Curve> curves_;
  std::vector<GroundBelief> priors_;  // priors of the classes
  std::vector<bool> priced_;          // by class: prior() was called
  struct Dearer {
    CellCode::Curve number;
    double added_J_per_m;
  };
  // Curves of learned() by both classes, DP/W, its standard deviation, and sinkage.
  std::map<std::tuple<int, int, double, double, double>, CellCode::Curve> numbers_;
  std::map<std::pair<CellCode::Curve, int>, Dearer> dearer_;  // curves of dearer(), by curve index and step
  mutable std::shared_ptr<const TravelCost> cost_;
};

}  // namespace talus::costmap
