#pragma once

#include <span>
#include <string>
#include <vector>

#include <talus/terramech/strength/bevameter.hpp>

namespace talus::terramech {

/// The readings of one test with one plate.
struct PlateTrial {
  std::string soil, name;  ///< of the table; may be empty
  std::vector<PlateReading> readings;
};

/// Mean and spread of values of these standard errors by the method of moments (dersimonian_laird_1986, Eqs. 7 to 9).
RandomEffect randomEffect(std::span<const Estimate> values);

/// Each soil of the trials, in their order. Every trial has an n and a pressure at depth_m of its own: pooled readings would
/// take the difference between a firm shallow and a soft deep trial for a small n. A trial without two depths counts in
/// none; throws std::domain_error where no trial of a soil has them.
std::vector<TrialSoil> trialSoils(std::span<const PlateTrial> trials);

}  // namespace talus::terramech
