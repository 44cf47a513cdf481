#pragma once

#include <span>
#include <vector>

#include <talus/terramech/estimate/soil_objective.hpp>

/// Posterior for many samples; implementation of soil_posterior.hpp (ours).
namespace talus::terramech {

/// Returns the posterior for many samples, without weighting each draw by all samples. The mode of every
/// class is searched on 512 evenly spread samples, then on 16 times as many and so on, in the classes not yet
/// excluded. The likelihood of all samples is then approximated by a quadratic about the mode. The time is
/// about 50 us per sample; the memory does not depend on the number of samples.
SoilPosterior fitManySamples(const std::vector<SoilObjective>& classes, std::span<const WheelReading> samples,
                             const SoilFitOptions& options);

/// Returns `count` samples spread evenly over all samples, in their order; all samples if their number is at
/// most `count`.
std::vector<WheelReading> spreadEvenly(std::span<const WheelReading> samples, std::size_t count);

}  // namespace talus::terramech
