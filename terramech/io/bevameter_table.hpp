#pragma once

#include <filesystem>
#include <vector>

#include <talus/common/progress_monitor.hpp>
#include <talus/terramech/estimate/telemetry.hpp>
#include <talus/terramech/strength/plate_trials.hpp>

namespace talus::terramech {

/// Plate tests out of a CSV: rows of a shear test (normal_stress_Pa, shear_stress_Pa, shear_displacement_m),
/// of a pressure-sinkage test (plate_width_m or plate_d_m, pressure_Pa or p_Pa, sinkage_m or z_m), or both.
/// The diameter plate_d_m of a round plate is taken as its smaller dimension b (thesis A.1); wong_2001 takes
/// the radius, which halves k_c. Where the width is neither stated nor a column, it is the diameter of the
/// round plate that F_N and the pressure tell, test by test; a test whose F_N over pressure changes was not
/// made with a plate. Readings of one trial are those alike in `trial`, `test` and all text columns that rows have in common; their soil is the
/// text of `soil`.
struct BevameterTable {
  std::vector<ShearReading> shear;
  std::vector<PlateTrial> plates;
  std::vector<RejectedRow> rejected;
  bool width_from_force = false;  ///< the widths are not the file's own
};

/// A stated plate width [m] holds for all rows, 0: none stated. Throws InputError when the file has the
/// columns of neither test, or no usable row.
BevameterTable readBevameterTable(const TableFile& file, double plate_width_m, const ProgressMonitor& watch);

}  // namespace talus::terramech
