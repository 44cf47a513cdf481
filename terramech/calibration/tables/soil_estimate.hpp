#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <talus/terramech/estimate/soil_posterior.hpp>
#include <talus/terramech/estimate/telemetry.hpp>
#include <talus/terramech/strength/bevameter.hpp>
#include <talus/terramech/strength/mohr_coulomb_line.hpp>

namespace talus::terramech {

/// Options of a soil estimate from a table. Methods:
///   bevameter       plate tests (plate_estimate.hpp)
///   sojourner, iagnemma, linear-offset   straight lines in (sigma, tau) (line_estimate.hpp)
///   wong-reece      posterior from the wheel's equilibrium (posterior_estimate.hpp, model_estimate.hpp)
struct EstimateOptions {
  TableFile table;              ///< the CSV
  std::string method;           ///< one of estimateMethods()
  std::string shear_modulus;    ///< K [m] or one of modulusMethods(); empty: column, else prior, else joint
  std::string prior;            ///< soil file or name; empty: thesis Table 2.1 for wong-reece, otherwise none
  std::string rover;            ///< library name or file with default wheel dimensions; may be empty
  std::string model;            ///< wong-reece: refined model whose effects are applied; empty: no model
  bool whole_equation = false;  ///< linear-offset: include M1 of Eq. 2.9
  bool recursive = false;       ///< process rows one by one and store each estimate
  double plate_width_m = 0.0;   ///< bevameter: width of all plates [m] for a table without a width column; 0:
                                ///< not given
  double noise = 0.05;          ///< relative standard deviation of each reading [-]
};

/// Estimate after a row of the table; NaN if not available yet.
struct RunningSoil {
  /// Marks a value that is not available.
  static constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

  std::size_t line = 0;                                          ///< line of the table
  double cohesion_Pa = kNan;                                     ///< c
  double friction_angle_rad = kNan;                              ///< phi
  double shear_modulus_m = kNan;                                 ///< K
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Constant(kNan);  ///< of (c, tan phi)
};

/// Returns options.shear_modulus as a number [m]; nullopt if the text is not a number. Throws InputError if
/// the number is not > 0.
std::optional<double> statedModulus(const EstimateOptions& options);

/// Standard deviation of phi [rad] from that of tan(phi), linearised at phi.
double frictionStd_rad(const Eigen::Matrix2d& covariance, double friction_angle_rad);

/// Result of any method; quantities that a method does not provide are NaN.
struct SoilEstimate {
  double cohesion_Pa;                        ///< c
  double tan_friction;                       ///< tan(phi) [-]
  double shear_modulus_m;                    ///< K
  Eigen::Matrix2d covariance;                ///< of (c, tan phi)
  double friction_angle_rad;                 ///< phi
  double sinkage_exponent;                   ///< n [-]
  std::optional<double> cohesive_modulus;    ///< k_c
  std::optional<double> frictional_modulus;  ///< k_phi
  std::vector<PlateModulus> plates;          ///< bevameter, if the table contains one soil
  std::vector<TrialSoil> soils;              ///< bevameter: each soil of the table from its trials
  std::size_t rows_used = 0;                 ///< number of readings in the fit
  std::vector<RejectedRow> rejected;         ///< unusable rows with the reason
  std::vector<std::string> ignored;          ///< numeric columns that the method does not read
  std::vector<std::string> unseen;           ///< parameters not determined by the data, with the reason
  std::vector<std::string> warnings;         ///< warnings about the fit
  std::vector<std::string> effects;          ///< effects applied, of --model
  std::vector<StressPair> points;            ///< points of a line fit, for a plot
  std::optional<SoilPosterior> posterior;    ///< wong-reece
  std::vector<std::string> class_names;      ///< of the prior of wong-reece
  std::vector<RunningSoil> running;          ///< per used row, if recursive

  /// Initialises the numbers to NaN.
  SoilEstimate();

  /// Copies c, tan(phi), their covariance and undetermined parameters from a line fit.
  void take(const ShearStrength& fit);

  /// Reason why the estimate is implausible for any soil by more than two standard deviations: c < 0, phi
  /// below 0 or above 60 deg. Empty if plausible.
  std::string implausible() const;
};

}  // namespace talus::terramech
