#pragma once

#include <map>
#include <string>
#include <vector>

#include <talus/terramech/contact/rover.hpp>
#include <talus/terramech/estimate/soil_prior.hpp>

/// Reads soils and rovers by name from the built-in library, or from YAML files.
///
/// A soil file is a mapping of the fields of Soil (name, cohesion_Pa, friction_angle_rad, sinkage_exponent,
/// cohesive_modulus, frictional_modulus, shear_modulus_m, c1, c2, density_kg_m3, slip_sinkage_exponent,
/// test_gravity_m_s2, digging_exponent, side_bulldozing, rut_stiffness), at the root of the file or under `soil:`. Every
/// field except name is a number; all numbers except test_gravity_m_s2 may be {mean: M, std: S}. A list under
/// `soils:` contains several soils, of which PATH#NAME selects one. A rover file is a mapping of the fields
/// of Rover, at the root of the file or under `rover:`. Units and checks are described in yaml_fields.hpp.
namespace talus::terramech {

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

}  // namespace talus::terramech
