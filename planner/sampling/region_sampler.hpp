#pragma once

#include <cstdint>
#include <memory>
#include <utility>

#include <ompl/base/StateSampler.h>
#include <ompl/base/samplers/InformedStateSampler.h>

#include <talus/planner/bound/improvable_region.hpp>

namespace talus::planner {

/// Random places of an ImprovableRegion from a seed of its own; where the region requires it, the known
/// route's points first.
class RegionSource {
 public:
  RegionSource(std::shared_ptr<const ImprovableRegion> region, std::uint64_t seed)
      : region_(std::move(region)), engine_(seed) {}

  /// Moves place to the next one; false when none was found that can cost less than max_cost_J.
  bool next(double max_cost_J, maps::Point& place);

  const ImprovableRegion& region() const noexcept { return *region_; }
  ImprovableRegion::Engine& engine() noexcept { return engine_; }

 private:
  std::shared_ptr<const ImprovableRegion> region_;
  ImprovableRegion::Engine engine_;
  std::size_t handed_out_ = 0;
};

/// Samples MapSpace inside an ImprovableRegion, from a seed of its own. For planners that request plain
/// samples.
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

/// The same for planners that request samples below a cost. Its measure of the region is the map's area: an
/// upper bound.
class RegionInformedSampler : public ompl::base::InformedSampler {
 public:
  /// Arguments of OMPL's allocation call and the seed.
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

}  // namespace talus::planner
