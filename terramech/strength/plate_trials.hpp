#pragma once

#include <span>
#include <string>
#include <vector>

#include <talus/terramech/strength/bevameter.hpp>

namespace talus::terramech {

/// Readings of one test with one plate.
struct PlateTrial {
  std::string soil, name;  ///< as in the table; may be empty
  std::vector<PlateReading> readings;
};

/// Returns mean and spread of values with given standard errors by the method of moments
/// (dersimonian_laird_1986, Eqs. 7 to 9).
RandomEffect randomEffect(std::span<const Estimate> values);

/// Returns the parameters of each soil, in the order of the trials. Each trial has its own n and its own
/// pressure at depth_m, because pooled readings of a firm shallow trial and a soft deep trial would give too
/// small an n. Trials without two depths are ignored. Throws std::domain_error if no trial of a soil has two
/// depths.
std::vector<TrialSoil> trialSoils(std::span<const PlateTrial> trials);

}  // namespace talus::terramech
