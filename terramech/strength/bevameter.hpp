#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/strength/strength_lines.hpp>

namespace talus::terramech {

/// Soil parameters from a bevameter, an instrument that presses plates into the soil and shears the soil
/// below a plate (thesis App. B.1; wong_1980).

/// Reading of a plate that is pressed into the soil.
struct PlateReading {
  double plate_width_m = 0.0;  ///< smaller dimension b of the plate, > 0
  double sinkage_m = 0.0;      ///< sinkage z of the plate, > 0
  double pressure_Pa = 0.0;    ///< pressure sigma under the plate, > 0
};

/// Sinkage modulus k of the soil for one plate size, in sigma = k z^n.
struct PlateModulus {
  double plate_width_m = 0.0;    ///< smaller dimension b of the plate
  double sinkage_modulus = 0.0;  ///< k [N/m^(n+2)]
};

/// Pressure-sinkage parameters from a fit of sigma = (k_c/b + k_phi) z^n (thesis Eq. A.1).
struct PressureSinkage {
  double sinkage_exponent = 0.0;     ///< sinkage exponent n [-], common to all plate sizes
  std::vector<PlateModulus> plates;  ///< sinkage modulus k of each plate size
  /// Cohesive modulus k_c [N/m^(n+1)]; empty if the plate sizes do not separate k_c from k_phi.
  std::optional<double> cohesive_modulus;
  std::optional<double> frictional_modulus;  ///< frictional modulus k_phi [N/m^(n+2)]; empty if k_c is empty
  double residual_std = 0.0;                 ///< rms residual of ln(sigma), weighted with the pressure [-]
  double exponent_std = 0.0;  ///< standard error of n from residual_std, for independent errors [-]
  std::string refused;        ///< reason why k_c and k_phi are empty; otherwise empty
};

/// Returns the fit of k for each plate size and of the common exponent n, which minimises the squares of
/// ln(sigma) with weights sigma^2 (wong_1980):
///     minimise sum sigma^2 (ln sigma - ln k_b - n ln z)^2
/// k_c and k_phi follow from a line of k against 1/b. Throws std::invalid_argument unless plate width, sinkage and
/// pressure are > 0, and std::domain_error if there is no plate size with readings at two depths, because n is then
/// undetermined.
PressureSinkage fitPressureSinkage(std::span<const PlateReading> readings);

/// Sets k_c and k_phi of a fit by a line of k against 1/b through its plate sizes, or sets
/// PressureSinkage::refused.
void separateModuli(PressureSinkage& fit);

/// Mean and scatter of a quantity over several trials, in a random-effects model: each value is the common
/// mean plus an effect of the trial plus an error.
struct RandomEffect {
  Estimate mean;        ///< common mean with its standard error
  double spread = 0.0;  ///< standard deviation of the effects of trials
};

/// Pressure-sinkage parameters of one soil from several trials (tests with one plate).
struct TrialSoil {
  std::string soil;        ///< name of the soil
  std::size_t trials = 0;  ///< number of trials
  PressureSinkage fit;     ///< n and k of the mean trial
  RandomEffect exponent;   ///< mean and scatter of n over the trials [-]
  /// Depth at which pressures are compared: the pressure-weighted geometric mean depth.
  double depth_m = 0.0;
  /// Standard deviation of ln(sigma) at depth_m between trials with the same plate size [-].
  double pressure_spread = 0;
};

/// Reading of a plate that shears the soil.
struct ShearReading {
  double normal_Pa = 0.0;       ///< normal stress sigma >= 0
  double shear_Pa = 0.0;        ///< shear stress tau
  double displacement_m = 0.0;  ///< shear displacement j > 0
};

/// Cohesion c, friction angle phi and shear modulus K of the law of Janosi and Hanamoto (thesis Eq. A.4).
struct ShearFit {
  ShearStrength strength;         ///< c and tan phi with their covariance
  double shear_modulus_m = 0.0;   ///< K
  bool modulus_at_bound = false;  ///< true: the displacements do not determine K
};

/// Returns the least-squares fit of tau = (c + sigma tan phi)(1 - exp(-j/K)) over c, tan(phi) and K in [1e-4,
/// 0.2] m (thesis Eq. A.4). At a given K the equation is divided by the mobilised fraction m = 1 - exp(-j/K)
/// and weighted with m^2; the equation is then a line in sigma, so that only K needs a search. Throws
/// std::domain_error with fewer than three readings or with a single normal stress.
ShearFit fitShear(std::span<const ShearReading> readings);

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
