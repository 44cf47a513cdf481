#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <talus/terramech/numerics/estimate.hpp>
#include <talus/terramech/strength/mohr_coulomb_line.hpp>

/// The bevameter: plates pressed into the soil, and sheared over it (thesis App. B.1; wong_1980).
namespace talus::terramech {

/// One reading of a plate being pressed in.
struct PlateReading {
  double plate_width_m = 0.0;  ///< smaller dimension b > 0
  double sinkage_m = 0.0;      ///< z > 0
  double pressure_Pa = 0.0;    ///< sigma > 0
};

/// k of one plate size, in sigma = k z^n.
struct PlateModulus {
  double plate_width_m = 0.0;
  double sinkage_modulus = 0.0;  ///< k [N/m^(n+2)]
};

/// Fit of sigma = (k_c/b + k_phi) z^n (thesis Eq. A.1).
struct PressureSinkage {
  double sinkage_exponent = 0.0;     ///< n [-], common to all plates
  std::vector<PlateModulus> plates;  ///< k of each plate size
  /// k_c [N/m^(n+1)]; empty when the sizes cannot separate it from k_phi.
  std::optional<double> cohesive_modulus;
  std::optional<double> frictional_modulus;  ///< k_phi [N/m^(n+2)]; empty likewise
  double residual_std = 0.0;                 ///< pressure-weighted scatter of ln(sigma) [-]
  double exponent_std = 0.0;                 ///< of n, from that scatter, errors independent [-]
  std::string refused;                       ///< why k_c and k_phi are empty; empty otherwise
};

/// Fits k of each plate size and the common n by least squares of ln(sigma) weighted with sigma^2, as Wong
/// (wong_1980):
///     minimise sum sigma^2 (ln sigma - ln k_b - n ln z)^2
/// then k_c and k_phi by a line of k over 1/b. Recursive: memory grows with the number of plate sizes alone.
class PressureSinkageFit {
 public:
  /// Throws std::invalid_argument unless all three are > 0.
  void add(const PlateReading& reading);

  /// Throws std::domain_error when no plate has two depths: n cannot be seen.
  PressureSinkage estimate() const;

 private:
  struct Plate {  // weighted means and centred moments of x = ln z, y = ln sigma
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

/// k_c and k_phi of a fit by a line of k over 1/b through its plates, or why it refuses them.
void separateModuli(PressureSinkage& fit);

/// What a quantity is over trials: each is the common mean, an effect of its own and its error.
struct RandomEffect {
  Estimate mean;        ///< with its standard error
  double spread = 0.0;  ///< standard deviation of the trials' effects
};

/// One soil by several trials.
struct TrialSoil {
  std::string soil;
  std::size_t trials = 0;
  PressureSinkage fit;         ///< n and k of the mean trial
  RandomEffect exponent;       ///< n over the trials [-]
  double depth_m = 0.0;        ///< at which pressures are compared: the pressure-weighted geometric mean
  double pressure_spread = 0;  ///< of ln(sigma) there between trials with one plate [-]
};

/// One reading of a sheared plate.
struct ShearReading {
  double normal_Pa = 0.0;       ///< sigma >= 0
  double shear_Pa = 0.0;        ///< tau
  double displacement_m = 0.0;  ///< j > 0
};

/// c, phi and K of thesis Eq. A.4.
struct ShearFit {
  ShearStrength strength;
  double shear_modulus_m = 0.0;
  bool modulus_at_bound = false;  ///< the displacements do not see K
};

/// Least squares of tau = (c + sigma tan phi)(1 - exp(-j/K)) over c, tan(phi) and K in [1e-4, 0.2] m (thesis
/// Eq. A.4). At each K the equation, divided by the mobilised share m = 1 - exp(-j/K) and weighted with m^2,
/// is a line: K alone is searched. Throws std::domain_error with fewer than three readings or with one normal
/// stress only.
ShearFit fitShear(std::span<const ShearReading> readings);

}  // namespace talus::terramech
