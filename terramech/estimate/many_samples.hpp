#pragma once

#include <span>
#include <vector>

#include <talus/terramech/estimate/soil_objective.hpp>

/// Posterior of the soil for many samples; part of the implementation of soil_posterior.hpp (ours).
namespace talus::terramech {

/// Returns the posterior of the soil for many samples. The mode (most likely soil) of every soil class is
/// searched on 512 evenly spread samples, then on 16 times as many, and so on, in the classes that are not
/// yet excluded. For more than 300 samples the likelihood of all samples is replaced by a quadratic
/// approximation about the mode, so that a draw is not weighted with every sample. The time is about 50 us
/// per sample; the memory does not depend on the number of samples.
SoilPosterior fitManySamples(const std::vector<SoilObjective>& classes, std::span<const WheelReading> samples,
                             const SoilFitOptions& options);

/// Returns `count` samples that are spread evenly over all samples, in their order. Returns all samples if
/// there are at most `count`.
std::vector<WheelReading> spreadEvenly(std::span<const WheelReading> samples, std::size_t count);

}  // namespace talus::terramech
