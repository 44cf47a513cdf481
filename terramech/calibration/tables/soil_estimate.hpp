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

/// How the soil is found from a table: one of the methods
///   bevameter       plate tests (plate_estimate.hpp)
///   sojourner, iagnemma, linear-offset   straight lines in (sigma, tau) (line_estimate.hpp)
///   wong-reece      the posterior by the wheel's equilibrium (posterior_estimate.hpp, model_estimate.hpp)
struct EstimateOptions {
  TableFile table;     ///< the CSV
  std::string method;  ///< one of estimateMethods()
  std::string
      shear_modulus;  ///< K: a number [m], or one of modulusMethods(); empty: the file's column, else the prior's, else joint
  std::string prior;  ///< soil file or name; empty: for wong-reece the classes of thesis Table 2.1, else none
  std::string rover;  ///< library name or file: whose wheel, where the table has no wheel size; may be empty
  std::string model;  ///< wong-reece: a refined model whose effects act; empty: none
  bool whole_equation = false;  ///< linear-offset: keep M1 of Eq. 2.9
  bool recursive = false;       ///< take the rows in one by one and keep each answer
  double plate_width_m = 0.0;   ///< bevameter: of all plates [m], where the file has no such column; 0: none
  double noise = 0.05;          ///< relative standard deviation of each reading [-]
};

/// The estimate after a row of the table; NaN where there is none yet.
struct RunningSoil {
  static constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

  std::size_t line = 0;  ///< of the table
  double cohesion_Pa = kNan;
  double friction_angle_rad = kNan;
  double shear_modulus_m = kNan;
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Constant(kNan);  ///< of (c, tan phi)
};

/// options.shear_modulus as a number [m], if it is one. Throws InputError where it is not > 0.
std::optional<double> statedModulus(const EstimateOptions& options);

/// Standard deviation of phi [rad] from that of tan(phi): by its slope at phi.
double frictionStd_rad(const Eigen::Matrix2d& covariance, double friction_angle_rad);

/// What any method answers; a number it cannot give is NaN.
struct SoilEstimate {
  double cohesion_Pa;
  double tan_friction;
  double shear_modulus_m;
  Eigen::Matrix2d covariance;  ///< of (c, tan phi)
  double friction_angle_rad;
  double sinkage_exponent;
  std::optional<double> cohesive_modulus;
  std::optional<double> frictional_modulus;
  std::vector<PlateModulus> plates;  ///< of bevameter, where the table holds one soil
  std::vector<TrialSoil> soils;      ///< of bevameter: each soil of the table by its trials
  std::size_t rows_used = 0;
  std::vector<RejectedRow> rejected;
  std::vector<std::string> ignored;        ///< the table's columns of numbers that the method does not read
  std::vector<std::string> unseen;         ///< parameters that the data do not show, with the reason
  std::vector<std::string> warnings;       ///< what the user should know of how it was fitted
  std::vector<std::string> effects;        ///< that acted, of --model
  std::vector<StressPair> points;          ///< what a line was fitted to, for a plot
  std::optional<SoilPosterior> posterior;  ///< of wong-reece
  std::vector<std::string> class_names;    ///< of its prior
  std::vector<RunningSoil> running;        ///< per used row, if recursive

  SoilEstimate();

  /// Takes c, tan(phi), their covariance and what was not seen from a fitted line.
  void take(const ShearStrength& fit);

  /// What no soil is like, by more than two standard deviations: c < 0, phi below 0 or above 60 deg. Empty
  /// where it may be one.
  std::string implausible() const;
};

}  // namespace talus::terramech
