#pragma once

#include <span>
#include <string>
#include <vector>

#include <talus/terramech/strength/bevameter.hpp>

namespace talus::terramech {

/// Trial: readings of one test in which one plate is pressed into the soil.
struct PlateTrial {
  std::string soil, name;  ///< texts of the table; may be empty
  std::vector<PlateReading> readings;
};

/// Returns common mean and scatter of values with known standard errors, by the method of moments
/// (dersimonian_laird_1986, Eqs. 7 to 9).
RandomEffect randomEffect(std::span<const Estimate> values);

/// Returns the pressure-sinkage parameters of each soil, in the order of the trials. Each trial has its own
/// exponent n and its own pressure at TrialSoil::depth_m, because a joint fit of a firm shallow trial and a
/// soft deep trial would give too small an n. Trials without two depths are ignored. Throws std::domain_error
/// if no trial of a soil has two depths.
std::vector<TrialSoil> trialSoils(std::span<const PlateTrial> trials);

}  // namespace talus::terramech
