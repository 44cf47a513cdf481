#pragma once

#include <span>
#include <vector>

#include <talus/terramech/estimate/soil_objective.hpp>

/// Posterior for many samples; implementation of soil_posterior.hpp (ours).
namespace talus::terramech {

/// Returns the posterior for more samples than can be used to weight each draw. The mode of every class is
/// searched on 512 samples spread evenly over all, then on sixteen times as many and so on, in the classes
/// not yet excluded. The likelihood of all samples is then approximated by a quadratic about the mode. Time
/// is some 50 us per sample; memory does not depend on the number of samples.
SoilPosterior fitManySamples(const std::vector<SoilObjective>& classes, std::span<const WheelReading> samples,
                             const SoilFitOptions& options);

/// Returns `count` samples spread evenly over all, in their order, or all if there are no more than `count`.
std::vector<WheelReading> spreadEvenly(std::span<const WheelReading> samples, std::size_t count);

}  // namespace talus::terramech
