#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <talus/terramech/numerics/estimate.hpp>
#include <talus/terramech/strength/mohr_coulomb_line.hpp>

/// Bevameter: plates pressed into the soil and sheared over it (thesis App. B.1; wong_1980).
namespace talus::terramech {

/// Reading of a plate pressed into the soil.
struct PlateReading {
  double plate_width_m = 0.0;  ///< smaller dimension b > 0
  double sinkage_m = 0.0;      ///< z > 0
  double pressure_Pa = 0.0;    ///< sigma > 0
};

/// Sinkage modulus k of one plate size, in sigma = k z^n.
struct PlateModulus {
  double plate_width_m = 0.0;
  double sinkage_modulus = 0.0;  ///< k [N/m^(n+2)]
};

/// Fit of sigma = (k_c/b + k_phi) z^n (thesis Eq. A.1).
struct PressureSinkage {
  double sinkage_exponent = 0.0;     ///< n [-], common to all plates
  std::vector<PlateModulus> plates;  ///< k of each plate size
  /// k_c [N/m^(n+1)]; empty if the plate sizes do not separate k_c from k_phi.
  std::optional<double> cohesive_modulus;
  std::optional<double> frictional_modulus;  ///< k_phi [N/m^(n+2)]; empty if k_c is empty
  double residual_std = 0.0;                 ///< pressure-weighted rms residual of ln(sigma) [-]
  double exponent_std = 0.0;  ///< standard error of n, from residual_std with independent errors [-]
  std::string refused;        ///< reason if k_c and k_phi are empty
};

/// Fits k of each plate size and the common n by least squares of ln(sigma) with weights sigma^2 (wong_1980):
///     minimise sum sigma^2 (ln sigma - ln k_b - n ln z)^2
/// k_c and k_phi follow from a line of k against 1/b. Recursive: memory grows with the number of plate sizes
/// only.
class PressureSinkageFit {
 public:
  /// Adds a reading. Throws std::invalid_argument unless width, sinkage and pressure are > 0.
  void add(const PlateReading& reading);

  /// Returns the fit. Throws std::domain_error if no plate has readings at two depths, because n is then
  /// undetermined.
  PressureSinkage estimate() const;

 private:
  struct Plate {  // weighted means and central moments of x = ln z, y = ln sigma
    double width_m = 0.0;
    double weight = 0.0;
    double x = 0.0;
    double y = 0.0;
    double xx = 0.0;
    double xy = 0.0;
    double yy = 0.0;
  };
  std::vector<Plate> plates_;
  std::size_t count_ = 0;
};

/// Sets k_c and k_phi of a fit by a line of k against 1/b through its plates, or `refused`.
void separateModuli(PressureSinkage& fit);

/// Random-effects model of a quantity over trials: common mean, effect of the trial, and error.
struct RandomEffect {
  Estimate mean;        ///< common mean with its standard error
  double spread = 0.0;  ///< standard deviation of the effects of trials
};

/// Pressure-sinkage parameters of one soil from several trials.
struct TrialSoil {
  std::string soil;
  std::size_t trials = 0;
  PressureSinkage fit;    ///< n and k of the mean trial
  RandomEffect exponent;  ///< n over the trials [-]
  double depth_m = 0.0;   ///< depth for the comparison of pressures: the pressure-weighted geometric mean
  /// Standard deviation of ln(sigma) at depth_m between trials with one plate [-].
  double pressure_spread = 0;
};

/// Reading of a sheared plate.
struct ShearReading {
  double normal_Pa = 0.0;       ///< sigma >= 0
  double shear_Pa = 0.0;        ///< tau
  double displacement_m = 0.0;  ///< j > 0
};

/// Cohesion, friction angle and shear modulus of thesis Eq. A.4.
struct ShearFit {
  ShearStrength strength;
  double shear_modulus_m = 0.0;
  bool modulus_at_bound = false;  ///< true: the displacements do not determine K
};

/// Returns the least-squares fit of tau = (c + sigma tan phi)(1 - exp(-j/K)) over c, tan(phi) and K in [1e-4,
/// 0.2] m (thesis Eq. A.4). At a given K the equation, divided by the mobilised share m = 1 - exp(-j/K) and
/// weighted with m^2, is a line; only K needs a search. Throws std::domain_error with fewer than three
/// readings or with a single normal stress.
ShearFit fitShear(std::span<const ShearReading> readings);

}  // namespace talus::terramech
