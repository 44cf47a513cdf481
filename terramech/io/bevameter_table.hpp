#pragma once

#include <filesystem>
#include <vector>

#include <talus/common/common.hpp>
#include <talus/terramech/estimate/telemetry.hpp>
#include <talus/terramech/strength/bevameter.hpp>

namespace talus::terramech {

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
