#pragma once

#include <map>
#include <string>
#include <vector>

#include <talus/terramech/contact/rover.hpp>
#include <talus/terramech/estimate/soil_prior.hpp>

/// Soils and rovers by name from the library that is built in, or from a YAML file.
///
/// A soil file is a mapping of the fields of Soil (name, cohesion_Pa, friction_angle_rad, sinkage_exponent,
/// cohesive_modulus, frictional_modulus, shear_modulus_m, c1, c2, density_kg_m3, slip_sinkage_exponent, test_gravity_m_s2, digging_exponent,
/// side_bulldozing), bare or under `soil:`, each a number or {mean: M, std: S}; or a list of them under
/// `soils:`, of which PATH#NAME picks one. A rover file is a mapping of the fields of Rover, bare or under
/// `rover:`. Units and strictness: yaml_fields.hpp.
namespace talus::terramech {

class YamlFields;

/// A soil by library name, path, or PATH#NAME. Throws InputError naming file, line and field, or the nearest
/// name.
SoilPrior loadSoilPrior(const std::string& name_or_path);

/// Its means.
Soil loadSoil(const std::string& name_or_path);

/// A rover by library name or path. Throws InputError as loadSoilPrior().
Rover loadRover(const std::string& name_or_path);

/// Soil of each class number of a terrain raster.
using TerrainClasses = std::map<int, SoilPrior>;

/// Reads {terrain_classes|classes: {1: SOIL, ...}} or the bare {1: SOIL, ...}, where SOIL is a library name,
/// the name of a soil in the file's own `soils:` list, a path relative to the file, or an inline mapping of a
/// soil. A file that holds more than classes names its other keys; any further one is refused.
TerrainClasses loadTerrainClasses(const std::string& path, const std::vector<std::string>& other_keys = {});

/// A soil or rover from an open mapping, and all soils of a file's `soils:` list by name; refuse unknown
/// keys.
SoilPrior readSoil(const YamlFields& fields);
Rover readRover(const YamlFields& fields);

/// Every soil of a file: its one soil, or its list.
std::vector<SoilPrior> loadSoils(const std::string& path);

/// Names in the built-in library, in alphabetical order.
std::vector<std::string> librarySoils();
std::vector<std::string> libraryRovers();

}  // namespace talus::terramech
