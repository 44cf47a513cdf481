#pragma once

#include <cstdint>
#include <memory>
#include <utility>

#include <ompl/base/StateSampler.h>
#include <ompl/base/samplers/InformedStateSampler.h>

#include <talus/planner/bound/improvable_region.hpp>

namespace talus::planner {

/// Random places of an ImprovableRegion with its own seed; if the region's hand_out_route is set, the known
/// route's points come first.
class RegionSource {
 public:
  RegionSource(std::shared_ptr<const ImprovableRegion> region, std::uint64_t seed)
      : region_(std::move(region)), engine_(seed) {}

  /// Sets `place` to the next place. Returns false if no place with a lower bound of at most max_cost_J was
  /// found.
  bool next(double max_cost_J, maps::Point& place);

  const ImprovableRegion& region() const noexcept { return *region_; }
  ImprovableRegion::Engine& engine() noexcept { return engine_; }

 private:
  std::shared_ptr<const ImprovableRegion> region_;
  ImprovableRegion::Engine engine_;
  std::size_t handed_out_ = 0;
};

/// Samples MapSpace inside an ImprovableRegion with its own seed, for planners that use OMPL's uniform
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

/// Samples MapSpace inside an ImprovableRegion for planners that request samples below a cost. The reported
/// measure is the map's area, an upper bound.
class RegionInformedSampler : public ompl::base::InformedSampler {
 public:
  /// Arguments of OMPL's allocation call, the region and the seed.
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
