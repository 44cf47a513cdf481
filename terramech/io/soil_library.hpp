#pragma once

#include <map>
#include <string>
#include <vector>

#include <talus/terramech/contact/rover.hpp>
#include <talus/terramech/estimate/soil_prior.hpp>

/// Soils and rovers by name from the built-in library, or from a YAML file.
///
/// A soil file is a mapping of the fields of Soil (name, cohesion_Pa, friction_angle_rad, sinkage_exponent,
/// cohesive_modulus, frictional_modulus, shear_modulus_m, c1, c2, density_kg_m3, slip_sinkage_exponent,
/// test_gravity_m_s2, digging_exponent, side_bulldozing), bare or under `soil:`. Every field is a number; all
/// except name and test_gravity_m_s2 may be {mean: M, std: S}. A list under `soils:` contains several soils,
/// selected by PATH#NAME. A rover file is a mapping of the fields of Rover, bare or under `rover:`. Units and
/// checks: yaml_fields.hpp.
namespace talus::terramech {

class YamlFields;

/// Loads a soil with its standard deviations by library name, path, or PATH#NAME. Throws InputError with
/// file, line and field, or with the nearest name.
SoilPrior loadSoilPrior(const std::string& name_or_path);

/// Loads a soil without standard deviations, as loadSoilPrior().
Soil loadSoil(const std::string& name_or_path);

/// Loads a rover by library name or path. Throws InputError as loadSoilPrior().
Rover loadRover(const std::string& name_or_path);

/// Soil of each class number of a terrain raster, 0 to 254.
using TerrainClasses = std::map<int, SoilPrior>;

/// Reads {terrain_classes|classes: {1: SOIL, ...}} or the bare {1: SOIL, ...}. SOIL is the name of a soil in
/// the file's `soils:` list, a library name, a path relative to the file, or an inline mapping of a soil.
/// `other_keys` are further keys allowed in the file; any other key is an error. Throws InputError with file,
/// line and field.
TerrainClasses loadTerrainClasses(const std::string& path, const std::vector<std::string>& other_keys = {});

/// Read a soil or a rover from a mapping. Throw InputError for an unknown key or a value outside its range.
SoilPrior readSoil(const YamlFields& fields);
Rover readRover(const YamlFields& fields);

/// Loads every soil of a file: its single soil, or its list.
std::vector<SoilPrior> loadSoils(const std::string& path);

/// Names in the built-in library, in alphabetical order.
std::vector<std::string> librarySoils();
std::vector<std::string> libraryRovers();

}  // namespace talus::terramech
