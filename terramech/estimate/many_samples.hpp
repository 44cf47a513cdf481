#pragma once

#include <span>
#include <vector>

#include <talus/terramech/estimate/soil_objective.hpp>

/// The inner workings of soil_posterior.hpp where samples are many (ours).
namespace talus::terramech {

/// The posterior of more samples than each draw can be weighed by. Every class' mode is found on 512 samples
/// spread evenly over all, then on sixteen times as many and so on, in the classes that are still in
/// question; the cost of all samples is then the quadratic of their cost about that mode. Time grows with the
/// number of samples, some 50 us each, memory does not.
SoilPosterior fitManySamples(const std::vector<SoilObjective>& classes, std::span<const WheelReading> samples,
                             const SoilFitOptions& options);

/// So many samples spread evenly over all, in their order; all of them when there are no more.
std::vector<WheelReading> spreadEvenly(std::span<const WheelReading> samples, std::size_t count);

}  // namespace talus::terramech
