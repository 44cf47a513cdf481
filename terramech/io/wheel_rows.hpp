#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <talus/common/common.hpp>
#include <talus/terramech/estimate/soil_estimation.hpp>
#include <talus/terramech/estimate/telemetry.hpp>
#include <talus/terramech/strength/bevameter.hpp>

namespace talus::terramech {

/// Rows of wheel telemetry that an estimator can use, and the rejected rows.
struct WheelRows {
  std::string source;                ///< name of the file
  Wheel wheel;                       ///< wheel of the first row; if one_wheel is true, of all rows
  bool one_wheel = true;             ///< false: the rows contain wheels of several sizes
  std::vector<WheelSample> samples;  ///< readings of the usable rows
  std::vector<Wheel> wheels;         ///< wheel of each sample
  std::vector<std::size_t> lines;    ///< line number of each sample in the file
  std::vector<std::string> ignored;  ///< names of numeric columns of the file that are not used
  /// Rows that the reader or the estimation method rejected, in the order of the file.
  std::vector<RejectedRow> rejected;
};

/// Options of readWheelRows().
struct WheelRowOptions {
  /// Rover that supplies the wheel of all rows; empty: the columns wheel_radius_m and wheel_width_m are used.
  std::string rover;
  bool needs_slip = true;  ///< true: rows with slip <= 0 are rejected
  double deepest = 2.0;    ///< rows with z/r (sinkage over radius) >= this value are rejected, (0, 2]
};

/// Largest slip angle at which a wheel is treated as straight. Up to this angle, torque and sinkage of the
/// wheel of rover mer on sandy_loam differ by less than 3 % from those at slip angle 0.
inline constexpr double kStraightUpTo_rad = 0.1;

/// Moves rows with a side force but without slip_angle_rad to Telemetry::rejected, because the slip angle is
/// needed to interpret the force. Throws InputError if no row remains.
void leaveOutWithoutSlipAngle(Telemetry& telemetry);

/// Reads load_N, torque_Nm, sinkage_m and, if needed, slip of each row. Rejects rows without contact (sinkage
/// 0), with a slip angle above kStraightUpTo_rad, with a side force but no slip angle, with z/r >= deepest,
/// or with slip <= 0 if slip is needed. Throws InputError if a column is missing, if a row has no wheel
/// dimensions, or if no row remains.
WheelRows readWheelRows(const TableFile& file, const WheelRowOptions& options, const ProgressMonitor& watch);

/// Plate tests (bevameter) from a CSV file. The file contains rows of a shear test (normal_stress_Pa,
/// shear_stress_Pa, shear_displacement_m), of a pressure-sinkage test (plate_width_m or plate_d_m,
/// pressure_Pa or p_Pa, sinkage_m or z_m), or both. The diameter plate_d_m of a round plate is used as its
/// smaller dimension b (thesis A.1); wong_2001 uses the radius, which halves k_c. If neither an option nor a
/// column gives the width, the plate is assumed round, with the area F_N / pressure, and its diameter is
/// computed for each test; a test with variable F_N / pressure is rejected. Readings belong to one trial if
/// they agree in `trial`, `test` and all text columns with repeated values. The soil is the text of column
/// `soil`.
struct BevameterTable {
  std::vector<ShearReading> shear;  ///< readings of the shear tests
  /// Trials of the pressure-sinkage tests.
  std::vector<PlateTrial> plates;
  std::vector<RejectedRow> rejected;
  bool width_from_force = false;  ///< true: the plate widths were computed from F_N / pressure
};

/// Reads the plate tests of a file. A plate_width_m > 0 applies to all rows; 0: not given. Throws InputError
/// if the file has the columns of neither test, or no usable row.
BevameterTable readBevameterTable(const TableFile& file, double plate_width_m, const ProgressMonitor& watch);

}  // namespace talus::terramech
