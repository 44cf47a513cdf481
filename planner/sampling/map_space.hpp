#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>

#include <ompl/base/MotionValidator.h>
#include <ompl/base/OptimizationObjective.h>
#include <ompl/base/State.h>
#include <ompl/base/StateSampler.h>
#include <ompl/base/StateValidityChecker.h>
#include <ompl/base/samplers/InformedStateSampler.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>

#include <talus/maps/maps.hpp>
#include <talus/planner/bound/improvable_region.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::planner {

/// OMPL state space of the map plane: R^2 in map coordinates [m], bounded by the edges of the map. The
/// projection has squares of 16 x 16 cells (the default projection of OMPL aborts in R^2).
class MapSpace : public ompl::base::RealVectorStateSpace {
 public:
  explicit MapSpace(const maps::Grid& grid);

  const maps::Grid& grid() const noexcept { return grid_; }

  /// Returns the map coordinates [m] of a state of this space.
  static maps::Point place(const ompl::base::State* state) noexcept {
    const double* values = state->as<StateType>()->values;
    return {values[0], values[1]};
  }

  /// Sets a state of this space to a map position.
  static void setPlace(ompl::base::State* state, maps::Point place) noexcept {
    double* values = state->as<StateType>()->values;
    values[0] = place.x_m;
    values[1] = place.y_m;
  }

  void registerProjections() override;

 private:
  maps::Grid grid_;
};

/// MotionCost with a count of its work, so that a planner ends after the same work on every machine. The
/// latest result is kept, because OMPL requests the cost of a motion and then its validity. Every point
/// except start and goal may become a turn. Therefore a motion is allowed only if a route may turn at both
/// ends of the motion (MotionCost::turnAllowed()); otherwise the route check would reject routes composed of
/// such motions. Use one object per planning run; not thread-safe.
class MeteredCost {
 public:
  /// `ends` are start and goal of the problem.
  MeteredCost(std::shared_ptr<const costmap::CostGrid> map, const Segment& ends)
      : motion_(std::move(map)), ends_(ends) {}

  const MotionCost& motion() const noexcept { return motion_; }

  /// Returns the exact cost of a motion [J]; infinite if the motion is not allowed.
  double operator()(const Segment& motion) const noexcept;

  /// Adds the work of one iteration of a planner: 100 cell lengths.
  void iterated() const noexcept { work_ += 100; }

  /// Returns the work so far [evaluated cell lengths].
  std::uint64_t work() const noexcept { return work_; }

 private:
  bool turnsAllowed(const Segment& motion) const noexcept;

  MotionCost motion_;
  Segment ends_;                                  // start and goal
  mutable Segment last_{{NAN, NAN}, {NAN, NAN}};  // latest motion; initially equal to no motion
  mutable double last_cost_J_ = 0.0;
  mutable std::uint64_t work_ = 0;
};

/// Validity of states of MapSpace: a state is valid if its cell allows some heading.
class MapValidityChecker : public ompl::base::StateValidityChecker {
 public:
  MapValidityChecker(const ompl::base::SpaceInformationPtr& space, std::shared_ptr<const MeteredCost> cost);

  bool isValid(const ompl::base::State* state) const override;

 private:
  std::shared_ptr<const MeteredCost> cost_;
};

/// Validity of straight motions between states of MapSpace: a motion is valid if every crossed cell allows
/// its heading. The validity of the reverse motion may differ. The check is exact; the motion is not sampled.
class MapMotionValidator : public ompl::base::MotionValidator {
 public:
  MapMotionValidator(const ompl::base::SpaceInformationPtr& space, std::shared_ptr<const MeteredCost> cost);

  bool checkMotion(const ompl::base::State* from, const ompl::base::State* to) const override;

  /// Checks the motion and stores in `last_valid` its last valid state, found by bisection to 1/256 of the
  /// motion.
  bool checkMotion(const ompl::base::State* from, const ompl::base::State* to,
                   std::pair<ompl::base::State*, double>& last_valid) const override;

 private:
  bool allowed(const ompl::base::State* from, const ompl::base::State* to) const;

  std::shared_ptr<const MeteredCost> cost_;
};

/// Source of random points of an ImprovableRegion with a seed of its own. If hand_out_route of the region is
/// true, the source first returns the points of the known route.
class RegionSource {
 public:
  RegionSource(std::shared_ptr<const ImprovableRegion> region, std::uint64_t seed)
      : region_(std::move(region)), engine_(seed) {}

  /// Sets `place` to the next point. Returns false if no point was found for which the lower bound of a route
  /// through it is at most `max_cost_J`.
  bool next(double max_cost_J, maps::Point& place);

  const ImprovableRegion& region() const noexcept { return *region_; }
  ImprovableRegion::Engine& engine() noexcept { return engine_; }

 private:
  std::shared_ptr<const ImprovableRegion> region_;
  ImprovableRegion::Engine engine_;
  std::size_t handed_out_ = 0;
};

/// Sampler of states of MapSpace inside an ImprovableRegion, with a seed of its own, for planners that use
/// the uniform samples of OMPL.
class RegionSampler : public ompl::base::StateSampler {
 public:
  RegionSampler(const ompl::base::StateSpace* space, std::shared_ptr<const ImprovableRegion> region,
                std::uint64_t seed);

  void sampleUniform(ompl::base::State* state) override;
  void sampleUniformNear(ompl::base::State* state, const ompl::base::State* near, double distance) override;
  void sampleGaussian(ompl::base::State* state, const ompl::base::State* mean, double deviation) override;

 private:
  RegionSource source_;
};

/// Sampler of states of MapSpace inside an ImprovableRegion, for planners that request samples below a given
/// cost. The reported measure of the region is the area of the map, which is an upper bound.
class RegionInformedSampler : public ompl::base::InformedSampler {
 public:
  /// Arguments of the allocation call of OMPL, the region and the seed.
  struct Parts {
    ompl::base::ProblemDefinitionPtr problem;
    unsigned int max_calls = 100;
    std::shared_ptr<const ImprovableRegion> region;
    std::uint64_t seed = 1;
  };

  explicit RegionInformedSampler(const Parts& parts);

  bool sampleUniform(ompl::base::State* state, const ompl::base::Cost& max_cost) override;
  bool sampleUniform(ompl::base::State* state, const ompl::base::Cost& min_cost,
                     const ompl::base::Cost& max_cost) override;
  bool hasInformedMeasure() const override { return false; }
  double getInformedMeasure(const ompl::base::Cost& current) const override;
  ompl::base::Cost heuristicSolnCost(const ompl::base::State* state) const override;

 private:
  RegionSource source_;
};

/// Cost [J] of a motion that is not allowed. The value is finite, because sums and comparisons of OMPL fail
/// with infinite values. It exceeds the cost of any real route; sums with this value have a resolution of
/// about 0.1 J.
inline constexpr double kBlockedMotionCost_J = 1e15;

/// Optimisation objective of OMPL that minimises the cost of a route [J] (MotionCost). It is not symmetric,
/// because ascent and descent differ. For states of MapSpace.
class TravelObjective : public ompl::base::OptimizationObjective {
 public:
  /// Parts of the objective: the cost function, the region in which samples are drawn, and a seed.
  struct Parts {
    std::shared_ptr<const MeteredCost> cost;
    std::shared_ptr<const ImprovableRegion> region;
    std::uint64_t seed = 1;  ///< seed of the informed samplers
  };

  TravelObjective(const ompl::base::SpaceInformationPtr& space, Parts parts);

  bool isSymmetric() const override { return false; }

  /// Returns 0, because only motions have a cost.
  ompl::base::Cost stateCost(const ompl::base::State* state) const override;

  /// Returns the exact cost of a motion [J]; kBlockedMotionCost_J if the motion is not allowed.
  ompl::base::Cost motionCost(const ompl::base::State* from, const ompl::base::State* to) const override;

  /// Returns an admissible lower bound of the cost of the cheapest path between two states [J].
  ompl::base::Cost motionCostHeuristic(const ompl::base::State* from,
                                       const ompl::base::State* to) const override;

  /// Returns a sampler of the region through which a route cheaper than the best known route can lead.
  ompl::base::InformedSamplerPtr allocInformedStateSampler(const ompl::base::ProblemDefinitionPtr& problem,
                                                           unsigned int max_calls) const override;

 private:
  Parts parts_;
};

}  // namespace talus::planner
