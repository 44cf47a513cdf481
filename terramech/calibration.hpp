#pragma once

/// Umbrella header of talus::calibration. From a table of wheel telemetry its functions estimate the soil
/// parameters, the drawbar pull and traversability category of each row, and the physical effects that a
/// wheel model lacks.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <talus/common/common.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/effects/refined_model.hpp>
#include <talus/terramech/estimate/drawbar_pull.hpp>
#include <talus/terramech/estimate/soil_estimation.hpp>
#include <talus/terramech/estimate/telemetry.hpp>
#include <talus/terramech/mobility/category.hpp>
#include <talus/terramech/strength/bevameter.hpp>
#include <talus/terramech/strength/strength_lines.hpp>
#include <talus/terramech/terramech_io.hpp>

namespace talus::terramech {

/// Options for the assessment of the rows of a telemetry table: drawbar pull and traversability category of
/// each row.
struct AssessOptions {
  TableFile table;  ///< CSV file
  /// Formula for the drawbar pull without a model, one of pullFormulas().
  std::string formula = "single-force";
  std::string model;  ///< file of a base or refined model; empty: pull from the readings of T, z and i
  std::string rover;  ///< library name or file of the rover with default wheel dimensions; may be empty
  /// Steepest slope that the rover must climb; 10 deg (thesis Fig. 3.12).
  double slope_rad = 0.17453292519943295;
  double margin_rad = 0.0;      ///< uncertainty (+-) of that slope
  double z_threshold = 0.5;     ///< z/r (sinkage over radius) at or above which the category drops one level
  double z_critical = 0.75;     ///< z/r above which the ground is dangerous
  double noise = 0.05;          ///< relative standard deviation of each reading [-]
  double reference_slip = 0.5;  ///< slip of the forecasts with `extrapolate`
  /// true: the pull at the reference slip and the maximum pull are forecast as well.
  bool extrapolate = false;
};

/// Assessment of one row.
struct Assessment {
  std::size_t line = 0;                   ///< line number in the file
  double slip = 0.0;                      ///< measured slip [-]
  Estimate pull;                          ///< drawbar pull over load, DP/W [-], at the measured slip
  Estimate sinkage_over_radius;           ///< sinkage over radius, z/r [-]
  double torque_over_load_radius = 0.0;   ///< torque ratio T/(W r) [-]
  Category category = Category::Unknown;  ///< traversability category of the mean pull and sinkage
  CategoryProbability probability{};      ///< probability of each category
  std::optional<PullForecast> forecast;   ///< pull forecast, if AssessOptions::extrapolate is true
};

/// Assessment of all rows of a table.
struct AssessedTable {
  std::vector<Assessment> rows;       ///< usable rows in the order of the file
  std::vector<RejectedRow> rejected;  ///< unusable rows, with the reason
  /// Effects of the model that are sensor faults and therefore not applied.
  std::vector<std::string> left_out;
};

/// Reads the table and assesses each row, from its readings or with the model. Throws InputError for invalid
/// input.
AssessedTable assessTable(const AssessOptions& options, const ProgressMonitor& watch);

/// Options of a soil estimate from a telemetry table. The methods are
///   bevameter       plate tests
///   sojourner, iagnemma, linear-offset   straight lines in (sigma, tau)
///   wong-reece      fit of the wheel's equilibrium, as in traceResiduals()
struct EstimateOptions {
  TableFile table;     ///< CSV file
  std::string method;  ///< estimation method, one of estimateMethods()
  /// K [m] or one of modulusMethods(); empty: column of the table, otherwise prior, otherwise joint.
  std::string shear_modulus;
  /// Soil file or library name; empty: the wide prior of soils in general for wong-reece, otherwise no prior.
  std::string prior;
  std::string rover;  ///< library name or file of the rover with default wheel dimensions; may be empty
  std::string model;  ///< wong-reece: file of a refined model whose effects are applied; empty: no effects
  /// Linear methods: process rows one by one and store the estimate after each row.
  bool recursive = false;
  /// bevameter: width of all plates for a table without a width column; 0: not given.
  double plate_width_m = 0.0;
  /// wong-reece: relative standard deviation of each reading [-]; 0: estimated from the rows.
  double noise = 0.0;
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
  double shear_modulus_std_m = 0.0;          ///< wong-reece: its standard deviation
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
  /// wong-reece: wheel model with the estimated soil and the covariance of its parameters.
  std::optional<RefinedModel> model;
  double misfit = 0.0;  ///< wong-reece: mean square of the residuals over their errors; 1 is expected [-]
  /// wong-reece: names of the soils of the prior, and the probability of each.
  std::vector<std::pair<std::string, double>> classes;
  std::vector<RunningSoil> running;  ///< estimate after each used row, if `recursive` is true

  /// Initialises the numbers to NaN.
  SoilEstimate();

  /// Copies c, tan(phi), their covariance and the undetermined parameters from a line fit.
  void take(const ShearStrength& fit);

  /// Returns the reason why no soil can have this strength: c < 0, phi < 0 or phi > 60 deg, each by more than
  /// two standard deviations. Returns an empty text if the strength is plausible.
  std::string implausible() const;
};

/// Returns the names of the soil-estimation methods: "bevameter", "sojourner", "iagnemma", "linear-offset",
/// "wong-reece".
const std::vector<std::string>& estimateMethods();

/// Returns the names of the methods for the shear modulus K: "error-minimisation", "effective-torque",
/// "effective-torque-printed", "joint".
const std::vector<std::string>& modulusMethods();

/// Estimates the soil from a table by options.method. Throws InputError for invalid input and
/// std::domain_error if no fit exists.
SoilEstimate estimateSoil(const EstimateOptions& options, const ProgressMonitor& watch);

/// Table of wheel telemetry together with the wheel model for its rows.

/// Trial: the measured rows of a telemetry table, prepared for residual tracing (search for the effects that
/// a wheel model lacks). The answers are the measured channels.
struct Trial {
  /// State of each row; slip and load are measured values, or estimates of the true values after
  /// calibrateInputs().
  std::vector<WheelState> states;
  std::vector<double> load_N;  ///< measured load of each row; denominator of every ratio
  std::vector<double> slip;    ///< measured slip of each row
  Eigen::MatrixXd measured;  ///< scaled channels in the order of Channel, rows x kChannels [-]; NaN: missing
  Eigen::VectorXd slip_variance;  ///< variance of the true slip about the slip of `states`
  Eigen::VectorXd load_variance;  ///< relative variance of the true load about the load of `states`
  std::vector<int> run;  ///< run number of each row; a row without a run label has a number of its own
  /// Moment number of each row of a rover's own drive: telemetry of several wheels without a measured drawbar
  /// pull DP. The rows of all wheels of a run at one time form a moment. DP/W of the first row of a moment is
  /// that of the whole rover, computed from the slope. Empty for other tables.
  std::vector<int> moment;
  /// Numeric columns that vary, without the answers and without columns that are linear functions of an
  /// answer.
  std::vector<std::string> covariates;
  std::vector<std::string> groupings;  ///< text columns with few distinct values, without the run column
  std::vector<std::string> dropped;    ///< columns that the screening removed (column_screening.hpp)
  std::vector<std::string> chance;     ///< covariates that the screening kept without significance

  /// Returns the number of rows.
  int rows() const { return static_cast<int>(states.size()); }
  bool has(Channel channel) const;  ///< returns true if any row measures the channel
  /// Returns the denominator of a scaled channel: r for sinkage, r W for torque, otherwise W, with the
  /// measured load W.
  double denominator(int row, Channel channel) const;
};

/// Number of components of an error that the rows of a unit (a run, a stretch of time) share. The components
/// are an offset of each channel [-] and, because soils vary between locations, the logarithms of soil
/// strength (c, tan phi) and of stiffness (k).
inline constexpr int kShared = kChannels + 2;

/// Value of each component of the shared error.
using SharedVector = Eigen::Matrix<double, kShared, 1>;
/// Effect of each component on the channels of a row.
using SharedFactor = Eigen::Matrix<double, kChannels, kShared>;
/// Effect of the soil components on the channels of a row.
using SoilFactor = Eigen::Matrix<double, kChannels, kShared - kChannels>;
using RunError = Eigen::Matrix<double, kShared, kShared>;  ///< covariance of the components

/// Error that the rows of a unit share.
struct SharedError {
  std::vector<int> unit{};          ///< unit number of each row; empty: rows share no error
  RunError run = RunError::Zero();  ///< covariance of the components
  /// Effect of the soil components on each row; empty: the soil does not vary.
  std::vector<SoilFactor> by_soil{};

  double variance(int channel) const;      ///< variance in one channel, mean over the rows [-]
  double soilVariance(int channel) const;  ///< part of variance() that the soil components cause [-]
};

/// Sensor whose error must be larger than stated if the model lacks no effect.
struct StrainedSensor {
  std::string column;                   ///< column of the sensor
  double declared = 0.0, fitted = 0.0;  ///< stated and fitted standard deviation, in the unit of the column
};

/// Converts telemetry to a trial. Rows without wheel dimensions use the wheel of the model. Throws InputError
/// if no load, slip or answer is measured, or if the dimensions of a wheel are unknown.
Trial makeTrial(const Telemetry& telemetry, const RefinedModel& model);

/// Returns the state of each row of telemetry without answers, as input of predictions. Throws the exceptions
/// of makeTrial().
std::vector<WheelState> statesOf(const Telemetry& telemetry, const RefinedModel& model);

/// Returns true if slip was measured with the full travel speed in place of its component along the wheel
/// plane. The columns speed_mps and rim_speed_mps of rows with a slip angle decide; the result is false if
/// these columns do not suffice.
bool slipIsAlongTravel(const std::vector<WheelState>& states);

/// Marks rows with sinkage z >= wheel radius r (wheel sunk to its axle or deeper). Such rows would distort a
/// fit, because in all contact models the contact of the rim ends at the height of the axle.
std::vector<char> beyondAxle(const Trial& trial);

/// Returns the values of a covariate over the rows; NaN: missing. For the name "sinkage_m" these are the
/// model's sinkages.
Eigen::VectorXd covariateValues(const Trial& trial, const std::string& name,
                                const Eigen::VectorXd& sinkage_m);

/// Returns the rows of a trial marked by `keep`.
Trial subset(const Trial& trial, const std::vector<char>& keep);

/// Marks the rows for fits of the soil. These are the rows without slip angle (|angle| < 0.1 rad) if the
/// trial has at least 20 such rows, otherwise all rows.
std::vector<char> rowsOfSoil(const Trial& trial);

/// Returns the trial with slip and load as measured.
Trial asMeasured(Trial trial);

/// Returns the predicted scaled channels of a model for all rows, over the measured load, rows x kChannels
/// [-]. If the trial has moments, DP/W of the first row of a moment is the sum of the wheels' pulls over the
/// sum of their loads. `solved` caches contact solutions between calls and may be empty initially.
Eigen::MatrixXd predictRows(const RefinedModel& model, const Trial& trial, SolvedContacts& solved);

/// Telemetry columns of the quantities that a wheel model predicts (answers), in the order of Channel.
inline constexpr std::array<const char*, kChannels> kAnswers{"drawbar_pull_N", "sinkage_m", "torque_Nm",
                                                             "side_force_N"};

/// Returns true if a column is one of kAnswers.
inline bool isAnswer(std::string_view column) {
  return std::find(kAnswers.begin(), kAnswers.end(), column) != kAnswers.end();
}

/// Reads the model from a soil or model file and sets its wheel to that of a rover (library name or file).
/// With an empty `file` the model is unknownSoil(); with an empty `rover` the wheel of the model is kept.
/// Throws the exceptions of loadModel() and loadRover().
ModelFile baseModel(const std::string& file, const std::string& rover);

/// Wheel model, and the rows of a table to which the model applies.
struct ModelRows {
  RefinedModel model;  ///< the given model, with slip_along_travel set if slipIsAlongTravel() of the rows
  Trial trial;         ///< rows to which the model applies
  Trial beyond_axle;   ///< rows with sinkage z >= wheel radius r (beyondAxle())
  /// Rejected rows of the table, including rows with a side force but no slip angle.
  std::vector<RejectedRow> rejected;
};

/// Selects the rows of a table for a model. Throws the exceptions of leaveOutWithoutSlipAngle() and
/// makeTrial().
ModelRows modelRows(Telemetry table, const RefinedModel& model);

/// Candidate: a possible addition to a wheel model. A candidate is an effect of the library, or a set of
/// curves of one covariate (telemetry column), one curve for each of some channels.
struct Candidate {
  std::vector<Effect> parts;  ///< one effect, or one curve per channel
  std::string family;         ///< family of the effect; "empirical" for curves
  int parameters = 0;         ///< number of fitted parameters

  /// Returns the logarithm of the prior probability of the candidate as a cause, relative to a known form of
  /// one parameter: ln(1/20)/4 for each further parameter of a form, ln(1/20)/2 for a drift, ln(1/20) for a
  /// curve, which includes a drift, and 3 ln(1/20)/2 for a product of two columns (ours).
  double logPrior() const;

  /// Returns true if the candidate consists of curves.
  bool empirical() const { return parts.front().empirical(); }
  /// Returns the telemetry column that explains the residual. For an effect on one group of rows, this is the
  /// text column of the group.
  const std::string& covariate() const {
    const Effect& front = parts.front();
    return front.only_column.empty() ? front.covariate : front.only_column;
  }
};

/// Returns all library effects that the columns of a trial (table of measured rows) permit, each at its
/// typical size. Nonlinear effects are returned with several start values, sensor effects also for single
/// groups of a text column. `sinkage_m` is the model's sinkage in each row.
std::vector<Candidate> libraryCandidates(const Trial& trial, const Eigen::VectorXd& sinkage_m);

/// Returns candidate curves of every covariate (numeric column that varies), initially zero: a line, and
/// splines of 4, 7 and 13 knots, each applied to one measured channel, to the soil stiffness or to the soil
/// strength. A column that is constant within runs needs at least three runs per knot. Further candidates are
/// steps of time, heading and additional columns (columns unknown to Talus), a constant per group of a text
/// column, and lines over products "A*B" of an additional column A of the effects `in` (those of the present
/// model) with slip, load, speed or another additional column.
std::vector<Candidate> empiricalCandidates(const Trial& trial, const std::vector<Effect>& in);

/// Returns the candidate of a single library effect.
Candidate formOf(const Effect& effect);

/// Returns true if a covariate is a product "A*B" of two columns.
bool isProduct(const std::string& covariate);

/// Returns true for an additional column: a numeric column that is not one of stateColumns().
bool isOwnColumn(const std::string& column);

/// Returns the value of GainDistribution::further_questions for a search after a screening of columns:
/// ln((kept + dropped) / kept), with the numbers of columns that the screening kept and dropped.
double furtherQuestions(const Trial& trial);

/// Returns the coarsest candidates of an additional column: a spline of 4 knots in each measured channel, one
/// channel at a time. For a text column returns a constant per group.
std::vector<Candidate> coarseCandidates(const Trial& trial, const std::string& column);

/// Options of residual tracing: the search for effects that explain the residuals of a wheel model.
struct TraceOptions {
  double significance = 0.05;  ///< probability of finding an effect in a table without effects, (0, 1)
  int max_effects = 7;         ///< greatest number of effects that are found
  double least_share = 0.0;    ///< least reduction of chi-squared per measured value by an effect [-]
  /// Number of candidate library effects that are fitted in the full model per round; for curves (empirical
  /// functions of a column) half this number.
  int fits = 6;
  /// Number of random tables drawn from the current model with noise alone; the least p-value is 1 / (draws +
  /// 1).
  int draws = 199;
  /// Greatest number of rows that are searched; of a larger table a sample is searched (rowSample()). A
  /// thousand rows suffice: an effect of a tenth of the scatter of single readings then has 3 standard
  /// errors.
  int most_rows = 1000;
  /// Greatest number of additional columns (unknown to Talus) that are searched; screenColumns() selects
  /// them.
  int most_columns = 24;
  bool fit_soil = false;   ///< true: the soil of the base model is fitted to the data, with vague priors
  std::uint64_t seed = 1;  ///< seed of the random numbers
};

/// Explanation: a fitted candidate (possible addition to a model) and its gain.
struct Explanation {
  Candidate candidate;  ///< candidate with fitted parameters
  /// Increase of the log-likelihood on held-out rows, including the change of the prior term of the soil and
  /// the logarithm of the candidate's prior [-].
  double gain = 0.0;
  /// Returns the gain without the candidate's prior.
  double evidence() const { return gain - candidate.logPrior(); }
  double chi2_gain = 0.0;  ///< twice the increase of the log-likelihood on the fitted rows [-]
};

/// Promise: a candidate before its fit, with its linearised gain.
struct Promise {
  Candidate candidate;
  double gain = 0.0;  ///< linearised value of Explanation::gain
  /// Probability that any candidate has at least this gain in a table without an effect.
  double p_value = 1.0;
};

/// Root mean square of the scaled residual in each channel [-]; NaN for a channel that is not measured.
using ChannelErrors = std::array<double, kChannels>;

/// Returns the deficit of log-likelihood above which an explanation is excluded in favour of a better one:
/// -ln(significance).
inline double closeGain(const TraceOptions& options) {
  return -std::log(options.significance);
}

/// Effect that the search accepted.
struct TracedEffect {
  Explanation chosen;                      ///< effect, as a fitted candidate
  Channel channel = Channel::DrawbarPull;  ///< channel in which the effect is largest
  std::vector<double> parameter_std;  ///< standard deviation of each fitted parameter of chosen.candidate
  double p_value = 1.0;               ///< probability of at least this gain in a table without the effect
  /// Other causes that the rows cannot distinguish from the effect, best first. In place of the effect, each
  /// has a gain of at least that of the effect minus closeGain().
  std::vector<Explanation> equal;
};

/// Alternative cause, with the model that contains this cause.
struct RivalCause {
  std::string in_place_of;  ///< name of the replaced effect; empty: the cause is added to all effects
  Explanation explanation;
  RefinedModel model;  ///< model with this cause, and with the covariance of its parameters
};

/// End of a column: the rows with the outermost values, predicted by a model that was fitted to the other
/// rows.
struct EndLevel {
  std::string column;     ///< name of the column
  bool high = false;      ///< true: the rows with the greatest values; false: with the least
  double distance = 0.0;  ///< root mean square distance of the held-out rows from the other rows
  int rows = 0;           ///< number of held-out rows
  /// Errors of the base and of the refined model on these rows.
  ChannelErrors base_rmse{}, refined_rmse{};
};

/// Errors on held-out rows. The parameters are refitted without each fold (held-out group of rows); the
/// choice of effects used all rows.
struct HeldOut {
  std::string scheme;            ///< kind of rows that are held out together
  ChannelErrors base_rmse{};     ///< errors of the base model; a fitted soil is refitted
  ChannelErrors refined_rmse{};  ///< errors of the refined model
};

/// Errors on the rows of a large table that the search did not use.
struct UnsearchedRows {
  int rows = 0;  ///< number of these rows
  ChannelErrors base_rmse{}, refined_rmse{};
};

/// Result of residual tracing. The base model is the model whose residuals were traced.
struct TraceResult {
  Soil given;            ///< soil of the base model before any fit
  RefinedModel base;     ///< base model, fitted if it has free parameters, with its sensor noise
  RefinedModel refined;  ///< base model with the found effects, fitted
  Trial trial;           ///< searched rows, with estimated true slip and load
  UnsearchedRows unsearched;
  std::vector<TracedEffect> effects;  ///< found effects, in the order of acceptance
  /// Alternative causes of the effects; without effects, the best rejected explanations.
  std::vector<RivalCause> rivals;
  std::vector<Explanation> rejected;  ///< explanations that were fitted in the last round and not accepted
  /// Candidates for the base model and for the refined model, best first.
  std::vector<Promise> first_promises, last_promises;
  double threshold = 0.0;  ///< gain that noise exceeds with probability `significance`
  /// Errors of both models on the searched rows, and rms that the fitted sensor noise causes.
  ChannelErrors base_rmse{}, refined_rmse{}, noise_floor{};
  /// Sensors whose fitted noise under the refined model exceeds the stated noise.
  std::vector<StrainedSensor> strained;
  ChannelErrors declared_floor{};  ///< noise_floor with the stated errors of the sensors in `strained`
  /// Error common to the rows of a run, for the base model and for the refined model.
  SharedError base_shared, shared;
  std::vector<EndLevel> ends;  ///< errors at the ends of columns, for extrapolation
  HeldOut held_out;            ///< errors on held-out rows, for the folds of foldsOf()
  ModelScope scope;            ///< channels and ranges in which held-out rows confirmed the effects
};

/// Return the root mean square of measured minus predicted scaled channels [-].
ChannelErrors rmseOf(const RefinedModel& model, const Trial& trial);
ChannelErrors rmseOf(const Eigen::MatrixXd& predicted, const Trial& trial);

/// Conclusion whether the model of a rigid wheel on soil, with physical effects, applies to a table.
struct Applicability {
  bool applies = true;   ///< true if the model describes the rows
  std::string reason;    ///< reason why the model does not apply; otherwise empty
  bool possible = true;  ///< true if a wheel on soil can have the median readings
};

/// Tests whether the median of DP/W is at most 1 and that of T/(rW) at most 1.5, and then the physical model, i.e. without empirical curves and sensor faults, on held-out rows. Only channels
/// that vary are tested: the scatter must exceed twice the noise or, for torque and sinkage, a quarter of the
/// mean. The model must explain at least half of the variance in one channel, and in no channel may its mean
/// square error exceed twice the variance. If drawbar pull, torque and sinkage are measured together, the
/// soil-independent relation of closureErrors() is tested as well: the median error of this relation and the
/// rms error of the model in DP/W must not both exceed 0.15. All limits are ours.
Applicability applicability(const TraceResult& result, const TraceOptions& options);

/// Returns for each row the measured DP/W minus the value that torque T and sinkage z imply for any soil
/// (kang_2003, Eq. 3.12); NaN if a value is missing:
///   DP/W = -tan(theta_1/2) + [sin(theta_1/4)/(theta_1/4)]^2 / cos(theta_1/2) T/(rW)
///   theta_1 = acos(1 - z/r)
/// The relation has an error of 0.03 for soils of 0 to 3 kPa and 20 to 37 deg.
std::vector<double> closureErrors(const Trial& trial);

/// A column whose values are a multiple of the quantity that its name states.
struct ScaledColumn {
  std::string column;  ///< name of the column
  double scale = 1.0;  ///< factor by which its values are to be multiplied
  std::string reason;  ///< what the values are instead
  double gain = 0.0;   ///< log-likelihood that the base model gains over the model of the rows as read [-]

  /// Returns, for example, "load_N looks like kilograms: scale 9.81 (log-likelihood gain 812.3)".
  std::string text() const;
};

/// Returns the most likely scale of a column: load in kilograms, pull or torque in kilogram-force, readings of
/// two wheels, or a diameter in place of the radius. The base model, fitted to the rows with this scale, must
/// gain more than the threshold of the search over the model `present` on the rows as read. The likelihood is
/// that of the readings in the units of the file. Returns nullopt without such a scale, and for a rover's own
/// drive.
std::optional<ScaledColumn> likelyScale(const TraceResult& result, const RefinedModel& present,
                                        const TraceOptions& options);

/// Tests whether the model of a rigid wheel on soil describes the rows of a table, with the criterion of
/// applicability(). The test is made first with the soil alone, then with the effects that residual
/// tracing finds. The test uses a sample of at most 400 rows. `base` is a soil or model file; if empty, the
/// soil is fitted. `rover` supplies the wheel. For a table with insufficient data (fewer than 20 rows, or no
/// load, slip or wheel) the model counts as applicable. Throws InputError for unreadable files.
Applicability tableApplicability(const TableFile& table, const std::string& base, const std::string& rover,
                                 const ProgressMonitor& watch = {});

/// Kind of conclusion of a residual trace (search for the effects that a wheel model lacks).
enum class Verdict {
  Explained,       ///< with the found effects, each channel of held-out rows is within 1.3 floors
  NothingMissing,  ///< no effect was found, and the residual is within the sensor errors
  Unexplained      ///< the residual exceeds the sensor errors; the found effects may explain a part of it
};

/// Returns "explained", "nothing_missing" or "unexplained".
const char* name(Verdict verdict);

/// Conclusion of a residual trace, with the largest remaining residual. The floor of a channel is the rms
/// that sensor errors cause.
struct Answer {
  Verdict verdict = Verdict::NothingMissing;  ///< kind of conclusion
  Channel channel = Channel::DrawbarPull;     ///< channel whose held-out error exceeds its floor most
  /// Rms errors of the base and of the refined model on held-out rows in `channel`, and its floor [-].
  double base = 0.0, rest = 0.0, floor = 0.0;
  std::vector<std::string> at_bound;  ///< fitted parameters at a bound of their range, with their effect
  std::string column;                 ///< column on which the remaining residual depends most; may be empty
  double gain = 0.0;  ///< gain of a candidate of that column, for comparison with TraceResult::threshold
  std::vector<StrainedSensor> strained;  ///< sensors whose fitted error is far larger than stated
  std::vector<std::string> unstated;     ///< measured columns without a stated error
  /// Standard deviations between runs of the logarithms of soil strength and soil stiffness, if these cause
  /// most of the residual; otherwise 0.
  double strength_scatter = 0.0, stiffness_scatter = 0.0;
  std::string unit = "run";  ///< kind of rows that share an error: a run, or a stretch of time
  std::string inapplicable;  ///< reason why the model does not apply; empty if it applies
  /// Measurements that would discriminate between the causes; empty unless the verdict is Unexplained.
  std::string measure;
};

/// Returns the conclusion of a trace. The floor of a channel is the rms of the fitted noise, or of the stated
/// sensor errors if the fitted errors are far larger than stated. The verdict is Explained if effects were
/// found, no held-out channel exceeds 1.3 floors, and no fitted parameter is at a bound of its range. It is
/// NothingMissing if no effect was found, no residual exceeds its floor by more than three standard errors of
/// the variance of the same number of normal errors, and either no held-out channel exceeds 1.3 floors or no
/// candidate promises more than noise.
Answer answerOf(const TraceResult& result);

/// Soil parameter whose fitted value is far from its prior.
struct MovedParameter {
  std::string name;  ///< name in soilParameters()
  /// Fitted value, and mean and standard deviation of the prior.
  double value = 0.0, prior = 0.0, prior_std = 0.0;
  double away() const;  ///< returns (value - prior) / prior_std
};

/// Returns the soil parameters of the refined model that are more than three standard deviations from their
/// prior.
std::vector<MovedParameter> movedSoil(const TraceResult& result);

/// Returns the names of fitted soil parameters of a refined model that are at a bound of their range.
std::vector<std::string> soilAtBounds(const RefinedModel& model);

/// Returns the names of fitted parameters of an effect that are at a bound of their range.
std::vector<std::string> atBounds(const Effect& effect);

/// Returns the refined model with additional error terms for predictions: the error that the rows of a new
/// run share, and the unexplained error of held-out rows. The unexplained error is the part of the held-out
/// error that exceeds the shared error and the floor by more than three standard errors.
RefinedModel forPrediction(const TraceResult& result);

/// Residual tracing of a telemetry table: finds the effects that a wheel model lacks, and returns the refined
/// model.

/// Options for tracing the residuals of a table.
struct TableTraceOptions {
  ModelFile base = unknownSoil();  ///< model whose residuals are traced; unknownSoil(): the soil is fitted
  TraceOptions search;             ///< options of the search; fit_soil is set according to `base`
};

/// Result of tracing a table.
struct TableTrace {
  std::string source;                 ///< path of the table
  std::vector<RejectedRow> rejected;  ///< rejected rows, with the reason
  TraceResult result;                 ///< effects, refined model and errors
  /// result.held_out, then the errors on held-out levels of each effect's column.
  std::vector<HeldOut> held_out;
  Answer answer;                     ///< conclusion of the trace
  Applicability applies;             ///< conclusion whether the wheel model applies to the table
  int beyond_axle = 0;               ///< number of rows with sinkage >= wheel radius, which were left out
  ChannelErrors beyond_axle_rmse{};  ///< errors of the refined model on the rows left out

  /// Returns the number of rows that were compared with the base model. In a large table, only a part of
  /// these rows is searched.
  int rowsUsed() const { return result.trial.rows() + result.unsearched.rows; }

  /// Returns the refined model as text of a model file for loadModel().
  std::string modelText() const;
};

/// Reads a table for tracing. The columns load_N and slip are required. Rows with a side force but no slip
/// angle are listed in Telemetry::rejected. Throws the exceptions of readTelemetry(), and InputError if no
/// row remains.
Telemetry readTraceTable(const TableFile& file);

/// Traces the residuals of a base model on a table. A specified soil without standard deviations gets default
/// ones, unless the table is a rover's own drive. The result is deterministic for a seed. After a stop by the
/// watch the result contains the effects found so far, without held-out errors, answer and applicability.
/// Throws InputError if too few rows are usable (traceInput()).
TableTrace traceTable(const Telemetry& table, const TableTraceOptions& options = {},
                      const ProgressMonitor& watch = {});

}  // namespace talus::terramech
