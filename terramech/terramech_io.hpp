#pragma once

/// Umbrella header of talus::terramech_io: reads soils, rovers and wheel models from YAML files and wheel
/// telemetry from CSV files.
#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <talus/common/common.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/effects/refined_model.hpp>
#include <talus/terramech/estimate/soil_estimation.hpp>
#include <talus/terramech/estimate/telemetry.hpp>
#include <talus/terramech/terramech.hpp>

namespace talus::terramech {

/// Distance without limit: larger than any value of a column, but in the range of numbers in a model file.
inline constexpr double kUnlimited = 1e12;

/// Range of a telemetry column in the rows to which a model was fitted, and the model's behaviour outside
/// this range. Corrections are the effects by which a refined model differs from its base model.
struct TrainedRange {
  std::string column;  ///< name of the column
  /// Least and greatest value of the column in these rows.
  double low = 0.0, high = 0.0;
  /// Standard deviation that is added to each scaled channel, per unit of distance below `low` and above
  /// `high`.
  std::array<double, kChannels> below{}, above{};
  /// Distances below `low` and above `high` up to which the corrections of each channel are applied in full,
  /// because no held-out rows contradict the corrections there.
  std::array<double, kChannels> reach_below = allChannels(kUnlimited), reach_above = reach_below;

  static constexpr std::array<double, kChannels> allChannels(double value) {
    return {value, value, value, value};
  }

  /// Returns the distance of a value from the range; 0 inside the range and for NaN.
  double outside(double x) const { return x < low ? low - x : x > high ? x - high : 0.0; }
  /// Returns the standard deviation that is added to a scaled channel at a value of the column [-].
  double stdAt(double x, std::size_t channel) const {
    return outside(x) * (x < low ? below : above)[channel];
  }

  /// Returns the fraction of a channel's corrections to apply at a value of the column: 1 up to the distance
  /// `reach`, then falling linearly to 0 at twice this distance (ours).
  double share(double x, std::size_t channel) const {
    const double distance = outside(x), reach = (x < low ? reach_below : reach_above)[channel];
    return !(distance > 0.0) ? 1.0 : reach > 0.0 ? std::clamp(2.0 - distance / reach, 0.0, 1.0) : 0.0;
  }
};

/// Channels and ranges of columns in which the corrections of a refined model are applied.
struct ModelScope {
  std::vector<TrainedRange> trained;  ///< ranges of the columns in the fitted rows; empty: unknown
  std::optional<RefinedModel> base;   ///< model without corrections; nullopt: no corrections exist
  /// True for channels in which held-out rows confirmed the corrections.
  std::array<bool, kChannels> kept{true, true, true, true};

  /// Returns the fraction of a channel's corrections to apply to a row, in [0, 1]. The prediction of the base
  /// model has the weight 1 - share.
  double share(const WheelState& state, std::size_t channel) const {
    double least = !base || kept[channel] ? 1.0 : 0.0;
    for (const TrainedRange& range : trained)
      if (base) least = std::min(least, range.share(state.covariate(range.column), channel));
    return least;
  }
};

/// Contents of a model file.
struct ModelFile {
  RefinedModel model;
  bool soil_given = true;  ///< false: the file contains no soil, so the soil must be fitted
  ModelScope scope;        ///< channels and ranges in which the corrections are applied
};

/// Reads a base or refined model from a YAML file of the form
///   {name: ..., soil: {...}|NAME, model: wong-reece|linear-formula, gravity_m_s2: 9.80665,
///    sensors: {load_N, slip, torque_Nm, sinkage_m, drawbar_pull_N, side_force_N},
///    wheel: {...}, slip_along_travel: false, effects: [{name, covariate, channel, parameters: [...], knots:
///    [...], only: {column, value}}], noise: {...}, fitted: [...], covariance: [...], trained: [{column,
///    range: [low, high], below: [4], above: [4], reach_below: [4], reach_above: [4]}], base: {soil, effects,
///    kept: [4]}}
/// or a file that contains only a soil. Throws InputError with file, line and field.
ModelFile loadModel(const std::string& path);

class YamlFields;

/// Reads the list `effects:` of a model file, in the form above. If covariate and channel of a library form
/// are missing, the values of the form are used.
std::vector<Effect> readEffects(const YamlFields& root);

/// Returns a model whose soil must be fitted, with the initial soil of the fit.
ModelFile unknownSoil();

/// Returns the text of a model file. loadModel() restores bit-identical numbers, except that numbers too
/// small for a file become 0. Priors of the soil, RefinedModel::stated, Soil::test_gravity_m_s2 and
/// Soil::correlation_time_s are not written.
std::string modelText(const RefinedModel& model, const ModelScope& scope = {});

/// Reads soils and rovers by name from the built-in library, or from YAML files.
///
/// A soil file is a mapping of the fields of Soil (name, cohesion_Pa, friction_angle_rad, sinkage_exponent,
/// cohesive_modulus, frictional_modulus, shear_modulus_m, c1, c2, density_kg_m3, slip_sinkage_exponent,
/// test_gravity_m_s2, correlation_time_s, digging_exponent, side_bulldozing, rut_stiffness), at the root of the file or
/// under `soil:`. Every field except name is a number; all numbers except the gravity and the time may be {mean: M,
/// std: S}. A list under `soils:` contains several soils, of which PATH#NAME selects one. A rover file is a mapping of
/// the fields of Rover, at the root of the file or under `rover:`. Units and checks are described in yaml_fields.hpp.

class YamlFields;

/// Loads a soil with the standard deviations of its parameters. The argument is a library name, a path, or
/// PATH#NAME. Throws InputError with file, line and field, or with the nearest library name.
SoilPrior loadSoilPrior(const std::string& name_or_path);

/// Loads a soil without standard deviations; argument and errors are those of loadSoilPrior().
Soil loadSoil(const std::string& name_or_path);

/// Loads a rover by library name or path. Throws InputError with file, line and field, or with the nearest
/// library name.
Rover loadRover(const std::string& name_or_path);

/// Soil of each terrain class. The key is the class number in a terrain raster, 0 to 254.
using TerrainClasses = std::map<int, SoilPrior>;

/// Reads the soils of the terrain classes of a terrain raster from a file of the form
/// {terrain_classes|classes: {1: SOIL, ...}} or {1: SOIL, ...}. SOIL is the name of a soil in the file's list
/// `soils:`, a library name, a path relative to the file, or a mapping of the fields of a soil. `other_keys`
/// are further keys that the file may contain; any other key is an error. Throws InputError with file, line
/// and field.
TerrainClasses loadTerrainClasses(const std::string& path, const std::vector<std::string>& other_keys = {});

/// Read a soil or a rover from a YAML mapping. Throw InputError for an unknown key or a value outside its
/// range.
SoilPrior readSoil(const YamlFields& fields);
Rover readRover(const YamlFields& fields);

/// Loads every soil of a file: its single soil, or the soils of its list.
std::vector<SoilPrior> loadSoils(const std::string& path);

/// Return the names of the soils and rovers in the built-in library, in alphabetical order.
std::vector<std::string> librarySoils();
std::vector<std::string> libraryRovers();

/// Options of readTelemetry().
struct TelemetryOptions {
  /// Numeric columns that must exist; a row without a value in one of them is rejected.
  std::vector<std::string> required;
  /// Wheel radius for the sinkage check if the file has no wheel_radius_m; 0: unknown.
  double wheel_radius_m = 0.0;
  /// True: a row that equals an earlier row in every field, including time_s, is left out and counted in
  /// Telemetry::repeated. Rows at the same time are compared only if the file has a column `wheel`.
  bool once = false;
};

/// Reads telemetry of wheels from a CSV file with a header row and columns in any order (CsvReader). An empty
/// field is a missing value. A row is rejected, with line and reason in Telemetry::rejected, if a known
/// column contains text, NaN, infinity or a value outside its range (load <= 0, sinkage outside [0, 2r), slip
/// outside [-1, 1], ...), if a required field is empty, or if the row has a wrong number of fields. In
/// unknown columns NaN is a missing value. The columns are kept in memory, not the text of the file. Throws
/// InputError if the file cannot be read, has no header, has a column twice or in another unit or spelling
///, lacks a required column, or has no usable row.
Telemetry readTelemetry(const TableFile& table, const TelemetryOptions& options = {},
                        const ProgressMonitor& watch = {});

}  // namespace talus::terramech
