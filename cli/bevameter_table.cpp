#include <cmath>

#include <cli/bevameter_table.hpp>
#include <terramech/telemetry_reader.hpp>

namespace talus::cli {
namespace {

using terramech::Telemetry;

const std::vector<double>* either(const Telemetry& table, const char* name, const char* other) {
  const auto* column = table.find(name);
  return column != nullptr ? column : table.find(other);
}

}  // namespace

BevameterTable readBevameterTable(const std::filesystem::path& path, const Watch& watch) {
  const Telemetry table = terramech::readTelemetry(path, {}, watch);
  const auto* normal = table.find("normal_stress_Pa");
  const auto* shear = table.find("shear_stress_Pa");
  const auto* moved = table.find("shear_displacement_m");
  const auto* width = either(table, "plate_width_m", "plate_d_m");
  const auto* pressure = either(table, "pressure_Pa", "p_Pa");
  const auto* sinkage = table.find("sinkage_m");
  const bool sheared = normal != nullptr && shear != nullptr && moved != nullptr;
  const bool pressed = width != nullptr && pressure != nullptr && sinkage != nullptr;
  if (!sheared && !pressed) {
    throw InputError({.where = table.source,
                      .reason = "lacks the columns of a plate test",
                      .remedy = "a shear test has normal_stress_Pa, shear_stress_Pa, shear_displacement_m; a "
                                "pressure-sinkage test plate_width_m, pressure_Pa, sinkage_m"});
  }
  BevameterTable result{.shear = {}, .plates = {}, .rejected = table.rejected};
  for (std::size_t k = 0; k < table.size(); ++k) {
    const bool shear_row = sheared && (*normal)[k] >= 0.0 && std::isfinite((*shear)[k]) && (*moved)[k] > 0.0;
    const bool press_row = pressed && (*width)[k] > 0.0 && (*pressure)[k] > 0.0 && (*sinkage)[k] > 0.0;
    if (shear_row) result.shear.push_back({(*normal)[k], (*shear)[k], (*moved)[k]});
    if (press_row) result.plates.push_back({(*width)[k], (*sinkage)[k], (*pressure)[k]});
    if (!shear_row && !press_row) {
      result.rejected.push_back(
          {table.lines[k], "no load yet: pressure, sinkage or shear displacement is not above 0"});
    }
  }
  if (!result.shear.empty() || !result.plates.empty()) return result;
  throw InputError({.where = table.source,
                    .reason = "no usable row",
                    .remedy = "pressures and displacements must be > 0"});
}

}  // namespace talus::cli
