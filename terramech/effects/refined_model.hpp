#pragma once

#include <array>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <talus/terramech/contact/wheel_on_soil.hpp>

namespace talus::terramech {

/// Measured quantity of a wheel (channel of the sensors) that a wheel model predicts.
enum class Channel { DrawbarPull, Sinkage, Torque, SideForce };
/// Number of channels. kAllChannels lists all of them in the order of Channel.
inline constexpr int kChannels = 4;
inline constexpr Channel kAllChannels[] = {Channel::DrawbarPull, Channel::Sinkage, Channel::Torque,
                                           Channel::SideForce};

/// Returns the name of the scaled channel: "drawbar_pull_over_load", "sinkage_over_radius",
/// "torque_over_load_radius" or "side_force_over_load".
const char* name(Channel channel);

/// Sensor readings of one wheel, measured or predicted, in SI units. The scaled channels are the ratios DP/W
/// (drawbar pull), z/r (sinkage), T/(rW) (torque) and F/W (side force), with W = load_N and r = radius_m.
struct Reading {
  double load_N = 0.0;     ///< nominal load W
  double radius_m = 0.0;   ///< wheel radius r
  double sinkage_m = 0.0;  ///< sinkage z
  double dug_m = 0.0;      ///< part of the model's sinkage that a driven wheel excavates; not a measurement
  double torque_Nm = 0.0;  ///< torque T about the axle
  double drawbar_pull_N = 0.0;  ///< drawbar pull DP
  double side_force_N = 0.0;    ///< side force F

  double& operator[](Channel channel);        ///< returns the reading of the channel
  double denominator(Channel channel) const;  ///< returns r for sinkage, r W for torque, otherwise W
  double scaled(Channel channel) const;       ///< returns the scaled channel [-]
  /// Adds `value` [-] to the scaled channel.
  void addScaled(Channel channel, double value) { (*this)[channel] += value * denominator(channel); }
};

/// Contact of one wheel with all quantities that an effect may change, and the solution of this contact. The
/// forces are integrated as in rim_contact.hpp with a faster quadrature rule. Without effects the results
/// equal those of wheel_on_soil.hpp within 1e-6 of the load.

/// Parameters of the wheel-soil contact after all effects (corrections to Wong-Reece) have changed them.
/// Plain data in SI units.
struct WheelContact {
  double load_N = 0.0;  ///< vertical load > 0
  double slip = 0.0;    ///< slip along the wheel plane, [-1, 1], defined in rim_contact.hpp
  /// Slip angle beta from the wheel plane to the travel direction; 0: no side force.
  double slip_angle_rad = 0.0;
  double rolling = 1.0;  ///< r omega / v with the full travel speed v [-], 0 if locked; used only by effects

  double radius_m = 0.1;        ///< radius r of the contact arc, > 0
  double width_m = 0.1;         ///< width b > 0
  double shear_radius_m = 0.1;  ///< radius r_s of shear displacement and torque; r for a smooth wheel

  double sinkage_modulus = 0.0;   ///< sinkage modulus k = k_c/b + k_phi [N/m^(n+2)]
  double sinkage_exponent = 1.0;  ///< sinkage exponent n [-]
  double cohesion_Pa = 0.0;       ///< cohesion c
  double tan_friction = 0.0;      ///< tangent of the friction angle, tan phi [-]
  double shear_modulus_m = 0.02;  ///< shear deformation modulus K
  double density_kg_m3 = 1600.0;  ///< bulk density, for forces that move soil
  double gravity_m_s2 = 9.80665;  ///< gravity, for forces that move soil
  /// Parameters of slip sinkage, and of digging and side bulldozing at a slip angle, defined in Soil. An
  /// effect that replaces one of these laws sets its parameter to 0.
  double slip_sinkage_exponent = 0.0;
  double digging_exponent = 0.0;
  double side_bulldozing = 0.0;
  double c1 = 0.43;  ///< angle of the stress peak: theta_m = (c1 + c2 i) theta_1
  double c2 = 0.32;

  double rebound = 0.0;  ///< rebound kappa [-]: contact ends at theta_2 = -acos(1 - kappa z/r)
  /// Depth H of a harder lower layer: at a depth h > H the pressure increases by hard_modulus_Pa_m (h - H).
  double hard_depth_m = std::numeric_limits<double>::infinity();
  double hard_modulus_Pa_m = 0.0;  ///< modulus k_h of the lower layer
  // Digging increases the static sinkage z0 to z = z0 + hypot(dug, ploughed_m) + extra_sinkage_m <= 1.95 r,
  // with dug = (sinkage_gain - 1) z0 + dug_m. The stress at the larger depth is scaled so that it carries the
  // load.
  double sinkage_gain = 1.0;     ///< factor on the static sinkage z0 [-]
  double dug_m = 0.0;            ///< sinkage that lugs excavate along the wheel plane
  double ploughed_m = 0.0;       ///< sinkage that the wheel excavates across the wheel plane
  double extra_sinkage_m = 0.0;  ///< sinkage by other causes
  /// Share of `dug` that refills behind the wheel [-]: the contact ends at the angle theta_2 of the depth
  /// kappa z + rear_fill dug.
  double rear_fill = 0.0;

  bool operator==(const WheelContact&) const = default;
};

/// Sinkage and forces of a wheel, in SI units.
struct ContactForces {
  double sinkage_m = 0.0;         ///< sinkage z
  double dug_m = 0.0;             ///< part of the sinkage that the driven wheel excavates
  double entry_angle_rad = 0.0;   ///< entry angle theta_1 of the contact
  double static_entry_rad = 0.0;  ///< entry angle at the static sinkage; initial value of the next search
  double growth = 0.0;  ///< d log W / d log theta_1 at the result [-], for the next search; 0: unknown
  double torque_Nm = 0.0;
  double drawbar_pull_N = 0.0;
  /// Force across the wheel plane, opposite to the sideways motion: negative for slip_angle_rad > 0.
  double side_force_N = 0.0;
};

/// Returns the contact parameters of a smooth rigid wheel on a soil, without effects. Wheel::lug_thrust is
/// ignored, because effects represent the lugs.
WheelContact contactOf(const Soil& soil, const Wheel& wheel);

/// Returns the forces on a wheel at the sinkage at which the soil carries its load. `entry_guess_rad` and
/// `growth` are initial values of the search, from the ContactForces of a similar contact; 0 selects a
/// default. Digging and side bulldozing at a slip angle are those of wheel_on_soil.hpp. If the soil carries less
/// than the load with the axle at the surface, the result is the wheel sunk to its axle, with the stress
/// scaled to carry the load, because fits evaluate such soils. The entry angle is at most pi/2 at any
/// sinkage. Never throws. Thread-safe. The forces are the integrals of rimForces() with the shear stress
///   tau = (c + sigma tan phi)(1 - e^{-j/K}) along the resultant displacement j = hypot(j_x, j_y),
/// which corresponds to the friction circle of an isotropic soil (ishigami_2007).
ContactForces solveContact(const WheelContact& contact, double entry_guess_rad = 0.0, double growth = 0.0);

/// Cache of solved contacts, for repeated solutions of similar contacts.
struct SolvedContacts {
  std::vector<WheelContact> contacts;  ///< contact parameters
  std::vector<ContactForces> forces;   ///< forces of each contact, in the order of `contacts`
};

/// Solves `contacts` and stores contacts and forces in `solved`. A contact equal to the stored contact of the
/// same index keeps its forces; for a changed contact the stored forces are the initial values of the search.
/// Contacts without effects are solved in batches by wong_reece_batch.hpp, other contacts by solveContact().
void solveContacts(std::vector<WheelContact> contacts, SolvedContacts& solved);

/// Operating state of one wheel: the input of a wheel model. NaN marks an unknown value; an effect that needs
/// an unknown value is not applied.
struct WheelState {
  /// Value of an unknown quantity.
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  Wheel wheel;
  double load_N = 0.0;              ///< vertical load, > 0
  double slip = 0.0;                ///< measured slip, [-1, 1]
  double slip_angle_rad = 0.0;      ///< slip angle from the wheel plane to the travel direction
  double speed_mps = kUnknown;      ///< travel speed of the wheel centre
  double rim_speed_mps = kUnknown;  ///< rim speed r omega
  double time_s = kUnknown;         ///< time of the reading
  double pass_index = kUnknown;     ///< number of wheel passes over this track, including this pass
  double slope_rad = kUnknown;      ///< slope along the heading, positive uphill
  double gravity_m_s2 = 9.80665;    ///< gravity at the driving site, > 0

  /// Readings that only the base model linear-formula uses.
  double measured_torque_Nm = kUnknown;
  double measured_sinkage_m = kUnknown;

  /// Further numeric columns of the telemetry row: name and value.
  std::vector<std::pair<std::string, double>> extra;
  /// Text columns of the row (wheel, session, source, ...): name and text.
  std::vector<std::pair<std::string, std::string>> group;

  /// Returns the value of a numeric column by its name in telemetry files. The column is one of
  /// stateColumns() or of `extra`; the value is NaN if unknown. "constant" and the name of a text column have
  /// the value 1. "a*b" is the product of the columns a and b.
  double covariate(std::string_view name) const;

  /// Sets the value of a numeric column of stateColumns() or of `extra`. pass_index is rounded to an integer.
  /// Other names are ignored.
  void setCovariate(std::string_view name, double value);

  /// Returns the text of a text column; empty if the state has no such column.
  std::string_view label(std::string_view column) const;
};

/// Returns the names of the telemetry columns that are fields of WheelState.
const std::vector<std::string>& stateColumns();

/// Effects that the Wong-Reece model lacks, as corrections that can be combined. An effect changes the
/// wheel-soil contact before the equilibrium is solved, or the sensor readings afterwards. The effect library
/// lists formula, parameters with bounds, source and signature of each known effect (its form). The covariate
/// of an effect is the quantity on which the effect depends: a column of telemetry.

/// Parameter of an effect form.
struct EffectParameter {
  /// Name in model files.
  const char* name;
  const char* unit;    ///< unit; "-" if dimensionless
  double low, high;    ///< physical bounds, which also limit a fit
  double typical;      ///< initial value of a fit, and value at which a candidate effect is tested
  bool fitted = true;  ///< false: computed from the data (a first pass, a start time) and not fitted
};

/// Arguments with which an effect is evaluated for one wheel state.
struct EffectInput {
  const double* parameter;  ///< parameter values in the order of EffectForm::parameters
  const WheelState& state;  ///< operating state of the wheel
  double x;                 ///< value of the covariate, finite
};

/// Form of an effect: an entry of the effect library. Plain data with static lifetime.
struct EffectForm {
  const char* name;
  const char* family;      ///< name shared by all forms of one physical cause
  const char* covariate;   ///< telemetry column with which the residual correlates
  Channel channel;         ///< channel with the largest residual
  bool of_sensor = false;  ///< true: sensor error, which does not influence the ground or routes
  const char* formula;
  const char* source;     ///< keys of REFERENCES.bib, or "ours"
  const char* signature;  ///< description of the residual by which the effect is recognised
  std::vector<EffectParameter> parameters;
  /// Function that changes the contact before the contact is solved; null: no change.
  void (*act)(const EffectInput&, WheelContact&) = nullptr;
  /// Function that changes the readings after the contact is solved; null: no change.
  void (*read)(const EffectInput&, const WheelContact&, Reading&) = nullptr;
};

/// Returns the library of all effect forms.
const std::vector<EffectForm>& effectLibrary();

/// Returns the library entry with this name, or nullptr. Accepts the prefixes "moisture_" and "temperature_"
/// that model files of version 0.1 contain.
const EffectForm* findEffect(std::string_view name);

/// Effect of a model: a library form with parameter values, or a curve fitted to a measured residual. A curve
/// has a name that begins with "empirical". The curve is a natural cubic spline through (knots, parameters)
/// over the covariate, constant beyond the outermost knots. The curve "empirical" is added to one scaled
/// channel. In the channel F/W (side force over load) the curve is multiplied by sin beta, where beta is the
/// slip angle, because the side force is odd in beta.
struct Effect {
  std::string name{};                      ///< name of a library form, or "empirical..." for a curve
  std::string covariate{};                 ///< telemetry column on which the effect depends
  Channel channel = Channel::DrawbarPull;  ///< channel to which a curve is added
  std::vector<double> parameters{};  ///< library form: its parameters; curve: its values at the knots [-]
  /// Ascending values in the unit of the covariate. A curve has one knot per parameter; a library form has no
  /// knots, or 2 limits to which the covariate is clamped.
  std::vector<double> knots{};
  std::string only_column{};  ///< text column that restricts the effect to one group of rows
  std::string only_value{};   ///< text of this group in `only_column`; empty: all rows

  /// Returns true if the effect is a curve. The exponential of the curve "empirical_stiffness" multiplies the
  /// sinkage modulus k; that of a curve with any other suffix multiplies cohesion c and tan phi.
  bool empirical() const { return name.starts_with("empirical"); }

  /// Returns the factor on a curve at this slip angle: sin(slip_angle_rad) for the channel F/W, otherwise 1.
  double sense(double slip_angle_rad) const;
};

/// Returns true if any effect has the covariate pass_index, the number of wheel passes over a track.
bool knowsPasses(std::span<const Effect> effects);

namespace detail {
/// Return the library entries of one kind: contact, digging, forces, sensors, drifts.
std::vector<EffectForm> contactEffects();
std::vector<EffectForm> diggingEffects();
std::vector<EffectForm> forceEffects();
std::vector<EffectForm> sensorEffects();
std::vector<EffectForm> driftEffects();
}  // namespace detail

/// Standard deviations of the sensor readings of a wheel. The absolute and the relative component add in
/// squares.
struct SensorNoise {
  std::array<double, kChannels> absolute{};  ///< absolute component, of DP [N], z [m], T [N m], F [N]
  std::array<double, kChannels> relative{};  ///< relative component, over the reading [-]
  double slip_absolute = 0.0;                ///< absolute component of the slip error [-]
  double slip_relative = 0.0;                ///< relative component of the slip error, over the slip [-]
  double load_relative = 0.0;                ///< load error over the load [-]

  /// Returns the standard deviation of a measured slip i in [-1, 1] [-]: the root sum of squares of
  /// slip_absolute and min(slip_relative |i|, 1 + i). The second component is 0 for a locked wheel, because
  /// its rim speed r omega = 0 is measured exactly.
  double slipStd(double slip) const;
};

/// Standard deviations of sensors that a model file states, in the unit of the column; empty if not stated.
struct StatedSensors {
  std::optional<double> load_N, slip, torque_Nm, sinkage_m, drawbar_pull_N, side_force_N;
  std::optional<double> relative;  ///< error over the reading of each sensor without a value above [-]
};

/// Identifies a parameter of a model that was fitted to data.
struct FittedParameter {
  int effect = -1;  ///< index into RefinedModel::effects; -1: the parameter belongs to the soil
  int index = 0;    ///< index into the parameters of this effect, or into soilParameters()
};

/// Formula by which a model computes the drawbar pull.
enum class BaseModel {
  WongReece,  ///< integral of the stresses along the rim (Wong and Reece)
  /// DP/W = T/(rW) - z/r - 0.1 (kang_2003, Eq. 3.21), with the measured torque T and sinkage z, or with the
  /// solved values if T and z are not measured.
  LinearFormula
};

/// Refined model: the Wong-Reece model of a wheel (the base model), with the effects that were found in data.
/// The commands estimate, assess, costmap, plan and drive accept this model. Plain data.
struct RefinedModel {
  /// Formula for the drawbar pull.
  BaseModel base = BaseModel::WongReece;
  Soil soil;
  /// Prior means of soil parameters, by name in soilParameters().
  std::map<std::string, double> soil_prior_mean;
  /// Prior standard deviations of soil parameters, by the same names; a parameter without an entry is exactly
  /// known.
  std::map<std::string, double> soil_prior_std;
  std::vector<Effect> effects;  ///< applied in this order
  /// True: slip was measured with the full travel speed in place of its component along the wheel plane.
  bool slip_along_travel = false;
  std::optional<Wheel> wheel;           ///< wheel of telemetry rows without wheel dimensions
  double gravity_m_s2 = 9.80665;        ///< gravity of telemetry rows without gravity
  StatedSensors stated;                 ///< sensor errors stated in the model file
  SensorNoise noise;                    ///< sensor errors used for the standard deviations of predictions
  std::vector<FittedParameter> fitted;  ///< fitted parameters, in the order of `covariance`
  /// Covariance of `fitted`, row-major, in the units of the parameters; empty: unknown.
  std::vector<double> covariance;

  /// Sets `wheel` and `gravity_m_s2` to the values of a rover.
  void takeRover(const Rover& rover) {
    wheel = rover.wheel;
    gravity_m_s2 = rover.gravity_m_s2;
  }
};

/// Returns the sensor readings that a model predicts for a wheel state. A non-null `entry_guess_rad` contains
/// the initial entry angle of the sinkage search and receives the resulting angle. Never throws for a valid
/// state. Thread-safe.
Reading predict(const RefinedModel& model, const WheelState& state, double* entry_guess_rad = nullptr);

/// Returns the predicted sensor readings of many wheel states. The computation is several times faster than
/// single calls if no effect changes the contact. The computation is also faster if `solved` already contains
/// the contact of a state, because effects that change only the readings need no new solution.
std::vector<Reading> predict(const RefinedModel& model, std::span<const WheelState> states,
                             SolvedContacts& solved);

/// Prediction of the sensor readings, with standard deviations that include the uncertainty of parameters,
/// slip, load and sensors.
struct Prediction {
  Reading mean;
  std::array<double, kChannels> scaled_std{};  ///< standard deviation of DP/W, z/r, T/(rW), F/W
};
/// Returns the prediction for a wheel state with its standard deviations, by linear propagation of all
/// errors. Never throws for a valid state.
Prediction predictWithStd(const RefinedModel& model, const WheelState& state);

/// Returns the model without the effects that are sensor errors. The result has empty `fitted` and
/// `covariance`.
RefinedModel withoutSensors(RefinedModel model);

/// Soil parameter that a fit may change, with access to its value in a Soil.
struct SoilParameter {
  const char* name;
  double low, high, scale;  ///< bounds and typical step of a fit, in the unit of the parameter
  double Soil::*field;      ///< null: log_stiffness

  double get(const Soil& soil) const;  ///< returns the value in a soil; 0 for log_stiffness
  /// Sets the value in a soil; log_stiffness v multiplies k_c and k_phi by e^v.
  void set(Soil& soil, double value) const;
};
/// Returns all soil parameters that a fit may change.
const std::vector<SoilParameter>& soilParameters();

/// Return or set the value of a fitted parameter of a model.
double value(const RefinedModel& model, const FittedParameter& parameter);
void setValue(RefinedModel& model, const FittedParameter& parameter, double value);

/// Returns the slip along the wheel plane for a slip that was measured along the travel direction at the slip
/// angle beta. The conversion multiplies the ratio v/(r omega) of travelRatio() by cos beta.
double slipInWheelPlane(double slip_along_travel, double slip_angle_rad);

}  // namespace talus::terramech
