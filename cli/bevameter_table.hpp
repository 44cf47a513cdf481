#pragma once

#include <filesystem>
#include <vector>

#include <talus.hpp>
#include <terramech/bevameter.hpp>
#include <terramech/telemetry.hpp>

namespace talus::cli {

/// Plate tests out of a CSV: rows of a shear test (normal_stress_Pa, shear_stress_Pa, shear_displacement_m),
/// of a pressure-sinkage test (plate_width_m or plate_d_m, pressure_Pa or p_Pa, sinkage_m), or both. The
/// diameter plate_d_m of a round plate is taken as its smaller dimension b (thesis A.1); wong_2001 takes the
/// radius, which halves k_c.
struct BevameterTable {
  std::vector<terramech::ShearReading> shear;
  std::vector<terramech::PlateReading> plates;
  std::vector<terramech::RejectedRow> rejected;
};

/// Throws InputError when the file has the columns of neither test, or no usable row.
BevameterTable readBevameterTable(const std::filesystem::path& path, const Watch& watch);

}  // namespace talus::cli
