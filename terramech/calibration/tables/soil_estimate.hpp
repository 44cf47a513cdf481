#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <talus/terramech/estimate/soil_estimation.hpp>
#include <talus/terramech/estimate/telemetry.hpp>
#include <talus/terramech/strength/bevameter.hpp>
#include <talus/terramech/strength/strength_lines.hpp>

namespace talus::terramech {

/// Options of a soil estimate from a telemetry table. The methods are
///   bevameter       plate tests (line_estimate.hpp)
///   sojourner, iagnemma, linear-offset   straight lines in (sigma, tau) (line_estimate.hpp)
///   wong-reece      posterior from the wheel's equilibrium (model_estimate.hpp)
struct EstimateOptions {
  TableFile table;     ///< CSV file
  std::string method;  ///< estimation method, one of estimateMethods()
  /// K [m] or one of modulusMethods(); empty: column of the table, otherwise prior, otherwise joint.
  std::string shear_modulus;
  /// Soil file or library name; empty: thesis Table 2.1 for wong-reece, otherwise no prior.
  std::string prior;
  std::string rover;  ///< library name or file of the rover with default wheel dimensions; may be empty
  std::string model;  ///< wong-reece: file of a refined model whose effects are applied; empty: no effects
  bool recursive = false;  ///< process rows one by one and store the estimate after each row
  /// bevameter: width of all plates for a table without a width column; 0: not given.
  double plate_width_m = 0.0;
  double noise = 0.05;  ///< relative standard deviation of each reading [-]
};

/// Soil estimate after a row of the table; NaN if not yet available.
struct RunningSoil {
  /// Value of a quantity that is not available.
  static constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

  std::size_t line = 0;                                          ///< line number in the file
  double cohesion_Pa = kNan;                                     ///< cohesion c
  double friction_angle_rad = kNan;                              ///< friction angle phi
  double shear_modulus_m = kNan;                                 ///< shear deformation modulus K
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Constant(kNan);  ///< covariance of (c, tan phi)
};

/// Returns options.shear_modulus as a number [m], or nullopt if the text is not a number. Throws InputError
/// if the number is not > 0.
std::optional<double> statedModulus(const EstimateOptions& options);

/// Returns the standard deviation of phi [rad] from that of tan(phi) in `covariance`, linearised at phi.
double frictionStd_rad(const Eigen::Matrix2d& covariance, double friction_angle_rad);

/// Soil estimate by any method. Quantities that a method does not provide are NaN or empty.
struct SoilEstimate {
  double cohesion_Pa;                        ///< cohesion c
  double tan_friction;                       ///< friction coefficient tan(phi) [-]
  double shear_modulus_m;                    ///< shear deformation modulus K
  Eigen::Matrix2d covariance;                ///< covariance of (c, tan phi)
  double friction_angle_rad;                 ///< friction angle phi
  double sinkage_exponent;                   ///< sinkage exponent n [-]
  std::optional<double> cohesive_modulus;    ///< k_c [N/m^(n+1)]
  std::optional<double> frictional_modulus;  ///< k_phi [N/m^(n+2)]
  /// bevameter: modulus of each plate size, if the table contains one soil.
  std::vector<PlateModulus> plates;
  std::vector<TrialSoil> soils;       ///< bevameter: parameters of each soil of the table from its trials
  std::size_t rows_used = 0;          ///< number of readings in the fit
  std::vector<RejectedRow> rejected;  ///< unusable rows, with the reason
  std::vector<std::string> ignored;   ///< numeric columns that the method does not read
  std::vector<std::string> unseen;    ///< parameters that the data do not determine, each with the reason
  std::vector<std::string> warnings;  ///< warnings about the fit
  std::vector<std::string> effects;   ///< effects of the model file that were applied
  std::vector<StressPair> points;     ///< equations of the samples in a line fit, for a plot
  std::optional<SoilPosterior> posterior;  ///< wong-reece: posterior of the soil
  std::vector<std::string> class_names;    ///< wong-reece: names of the soil classes of the prior
  std::vector<RunningSoil> running;        ///< estimate after each used row, if `recursive` is true

  /// Initialises the numbers to NaN.
  SoilEstimate();

  /// Copies c, tan(phi), their covariance and the undetermined parameters from a line fit.
  void take(const ShearStrength& fit);

  /// Returns the reason why no soil can have this strength: c < 0, phi < 0 or phi > 60 deg, each by more than
  /// two standard deviations. Returns an empty text if the strength is plausible.
  std::string implausible() const;
};

}  // namespace talus::terramech
