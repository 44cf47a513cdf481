#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include <talus/common/common.hpp>
#include <talus/common/nearest_name.hpp>
#include <talus/terramech/io/soil_library.hpp>
#include <talus/terramech/io/yaml_fields.hpp>
#include <talus/terramech/terramech_io.hpp>

namespace talus::terramech {

namespace {

constexpr int kGreatestClass = 254;        // class rasters use 255 for no class
constexpr std::size_t kMostClasses = 254;  // limit of the cost-curve table

bool isFile(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::exists(path, error);
}

const std::string* findText(const std::map<std::string, std::string>& texts, const std::string& name) {
  const auto found = texts.find(name);
  return found == texts.end() ? nullptr : &found->second;
}

std::vector<std::string> libraryNames(const std::map<std::string, std::string>& texts) {
  std::vector<std::string> names;
  names.reserve(texts.size());
  for (const auto& [name, text] : texts) names.push_back(name);
  return names;
}

/// Returns the root mapping of a library entry or file. Throws InputError with the nearest library entry if
/// neither exists.
YamlFields open(const std::string& name, const std::map<std::string, std::string>& texts,
                const std::string& what) {
  if (const auto* text = findText(texts, name)) return YamlFields::text(*text, "talus library, " + name);
  if (isFile(name)) return YamlFields::file(name);
  const std::string nearest = nearestName(name, libraryNames(texts));
  throw InputError({.where = name,
                    .reason = "no such file, and no " + what + " of this name in the library",
                    .remedy = nearest.empty() ? "name a YAML file" : "did you mean " + nearest + "?"});
}

/// Returns the mapping under a wrapper key, or the root itself without such a key.
YamlFields unwrapped(const YamlFields& root, const std::string& wrapper) {
  return root.has(wrapper) ? root.fields(wrapper) : root;
}

std::vector<SoilPrior> listedSoils(const YamlFields& root) {
  std::vector<SoilPrior> soils;
  for (const YamlFields& item : root.list("soils")) {
    soils.push_back(readSoil(unwrapped(item, "soil")));
    const std::string& name = soils.back().mean.name;
    if (std::ranges::count(soils, name, [](const SoilPrior& s) { return s.mean.name; }) > 1)
      root.refuse("soils", "holds soil '" + shortened(name) + "' twice", "give each its own name");
  }
  return soils;
}

const SoilPrior* named(const std::vector<SoilPrior>& soils, const std::string& name) {
  const auto found =
      std::find_if(soils.begin(), soils.end(), [&](const auto& s) { return s.mean.name == name; });
  return found == soils.end() ? nullptr : &*found;
}

SoilPrior onlySoil(const std::vector<SoilPrior>& soils, const YamlFields& root, const std::string& wanted) {
  if (const auto* soil = named(soils, wanted)) return *soil;
  if (wanted.empty() && soils.size() == 1) return soils.front();
  std::string names;
  for (const auto& soil : soils) names += (names.empty() ? "" : ", ") + soil.mean.name;
  root.refuse("soils",
              wanted.empty() ? "holds " + std::to_string(soils.size()) + " soils" : "has no soil " + wanted,
              "pick one as FILE#NAME of " + names);
}

SoilPrior soilOfClass(const YamlFields& classes, const std::string& key, const std::vector<SoilPrior>& listed,
                      const std::filesystem::path& folder) {
  if (classes.isMapping(key)) return readSoil(unwrapped(classes.fields(key), "soil"));
  const std::string name = classes.word(key);
  if (const auto* soil = named(listed, name)) return *soil;
  if (!findText(librarySoilTexts(), name) && isFile(folder / name))
    return loadSoilPrior((folder / name).string());
  try {
    return loadSoilPrior(name);
  } catch (const InputError& e) {
    if (e.parts().where != name) throw;
    classes.refuse(key, "class " + key + ": no soil '" + name + "'", e.parts().remedy);
  }
}

// Returns the class number of a key. Only one spelling is accepted, because two entries for one class would
// be ambiguous.
int classNumber(const YamlFields& classes, const std::string& key) {
  const bool digits = !key.empty() && std::ranges::all_of(key, [](char c) { return c >= '0' && c <= '9'; });
  if (!digits || (key.size() > 1 && key.front() == '0'))
    classes.refuse(key, "'" + shortened(key) + "' is not a class number",
                   "write lines `1: soil name`, a number without sign or leading zeros");
  if (key.size() > 3 || std::stoi(key) > kGreatestClass)
    classes.refuse(key, "class " + shortened(key) + " is beyond " + std::to_string(kGreatestClass),
                   "number the classes from 0 to " + std::to_string(kGreatestClass));
  return std::stoi(key);
}

// Class numbers are checked before any soil is read, which may take milliseconds each.
std::vector<std::pair<int, std::string>> numberedClasses(const YamlFields& classes, bool wrapped) {
  std::vector<std::pair<int, std::string>> numbered;
  for (const std::string& key : classes.names())
    if (wrapped || key != "soils") numbered.emplace_back(classNumber(classes, key), key);
  if (numbered.size() > kMostClasses)
    classes.refuse("",
                   "names " + std::to_string(numbered.size()) + " terrain classes, more than " +
                       std::to_string(kMostClasses),
                   "join classes of one soil");
  return numbered;
}

Steering steeringOf(const YamlFields& fields) {
  const std::string word = fields.word("steering", "skid");
  if (word == "skid") return Steering::Skid;
  if (word == "ackermann") return Steering::Ackermann;
  if (word == "all_wheel") return Steering::AllWheel;
  fields.refuse("steering", "steering = '" + word + "'", "write skid, ackermann or all_wheel");
}

void readWheels(const YamlFields& fields, Rover& rover) {
  fields.only(namesOf(wheelKeys()));
  rover.wheel_count = fields.integer("count");
  rover.wheel.radius_m = fields.number("radius_m");
  rover.wheel.width_m = fields.number("width_m");
  rover.wheel.grouser_height_m = fields.number("grouser_height_m", 0.0);
  rover.wheel.grouser_count = fields.integer("grouser_count", 0);
  const bool lugs = rover.wheel.grouser_height_m > 0.0 && rover.wheel.grouser_count > 0;
  rover.wheel.lug_thrust = fields.number("lug_thrust", lugs ? kLugThrust : 0.0);
}

}  // namespace

std::span<const SoilField> soilFields() {
  static constexpr SoilField kFields[] = {
      {"cohesion_Pa", &Soil::cohesion_Pa, &SoilDeviation::cohesion_Pa, true},
      {"friction_angle_rad", &Soil::friction_angle_rad, &SoilDeviation::friction_angle_rad, true},
      {"sinkage_exponent", &Soil::sinkage_exponent, &SoilDeviation::sinkage_exponent, true},
      {"cohesive_modulus", &Soil::cohesive_modulus, &SoilDeviation::cohesive_modulus},
      {"frictional_modulus", &Soil::frictional_modulus, &SoilDeviation::frictional_modulus},
      {"shear_modulus_m", &Soil::shear_modulus_m, &SoilDeviation::shear_modulus_m, true},
      {"c1", &Soil::c1, &SoilDeviation::c1},
      {"c2", &Soil::c2, &SoilDeviation::c2},
      {"density_kg_m3", &Soil::density_kg_m3, &SoilDeviation::density_kg_m3},
      {"slip_sinkage_exponent", &Soil::slip_sinkage_exponent, &SoilDeviation::slip_sinkage_exponent},
      {"digging_exponent", &Soil::digging_exponent, &SoilDeviation::digging_exponent},
      {"side_bulldozing", &Soil::side_bulldozing, &SoilDeviation::side_bulldozing},
      {"rut_stiffness", &Soil::rut_stiffness, &SoilDeviation::rut_stiffness}};
  return kFields;
}

SoilPrior readSoil(const YamlFields& fields) {
  const std::vector<std::string> known = namesOf(soilKeys());
  // For a file of another kind the message does not list unknown names; a misspelt field is listed.
  const auto foreign = [&](const std::string& key) { return meantKey(key, known).empty(); };
  if (std::ranges::none_of(known, [&](const std::string& name) { return fields.has(name); }) &&
      std::ranges::all_of(fields.names(), foreign))
    fields.refuse("", "has no field of a soil", "name a file of soils (terramech/README.md)");
  fields.only(known);
  SoilPrior soil;
  soil.mean.name = fields.word("name", "unnamed");
  for (const SoilField& field : soilFields()) {
    const Estimate stated =
        field.required ? fields.stated(field.name) : fields.stated(field.name, soil.mean.*field.value);
    soil.mean.*field.value = stated.value;
    soil.deviation.*field.deviation = stated.std;
  }
  // theta_m / theta_1 = c1 + c2 slip must be in [0, 1].
  if (soil.mean.c1 < 0.0 || soil.mean.c1 > 1.0)
    fields.refuse("c1", "c1 must be 0 to 1: the peak of the stress lies in the contact", "check it");
  if (std::abs(soil.mean.c2) > 1.0)
    fields.refuse("c2", "c2 must be -1 to 1: the peak of the stress lies in the contact", "check it");
  soil.mean.test_gravity_m_s2 = fields.number("test_gravity_m_s2", soil.mean.test_gravity_m_s2);
  soil.mean.correlation_time_s = fields.number("correlation_time_s", soil.mean.correlation_time_s);
  if (soil.mean.cohesive_modulus == 0.0 && soil.mean.frictional_modulus == 0.0)
    fields.refuse("", "lacks cohesive_modulus and frictional_modulus", "add at least one, above 0");
  try {
    validate(soil.mean);
  } catch (const std::invalid_argument& e) {
    fields.refuse(e);
  }
  return soil;
}

Rover readRover(const YamlFields& fields) {
  fields.only(namesOf(roverKeys()));
  Rover rover;
  rover.name = fields.word("name", "unnamed");
  rover.mass_kg = fields.number("mass_kg");
  rover.gravity_m_s2 = fields.number("gravity_m_s2", rover.gravity_m_s2);
  const YamlFields wheels = fields.fields("wheels");
  readWheels(wheels, rover);
  rover.wheelbase_m = fields.number("wheelbase_m");
  rover.track_m = fields.number("track_m");
  rover.clearance_m = fields.number("clearance_m");
  rover.centre_of_mass_height_m = fields.number("centre_of_mass_height_m", 0.0);
  rover.centre_of_mass_ahead_m = fields.number("centre_of_mass_ahead_m", 0.0);
  rover.centre_of_mass_left_m = fields.number("centre_of_mass_left_m", 0.0);
  rover.max_pitch_rad = fields.number("max_pitch_rad", rover.max_pitch_rad);
  rover.max_roll_rad = fields.number("max_roll_rad", rover.max_roll_rad);
  rover.max_torque_Nm = fields.number("max_torque_Nm");
  rover.max_speed_mps = fields.number("max_speed_mps", rover.max_speed_mps);
  rover.turning_radius_m = fields.number("turning_radius_m", 0.0);
  rover.hotel_power_W = fields.number("hotel_power_W", 0.0);
  rover.steering = steeringOf(fields);
  try {
    validate(rover);
  } catch (const std::invalid_argument& e) {
    (std::string(e.what()).find("wheels.") == std::string::npos ? fields : wheels).refuse(e);
  }
  return rover;
}

SoilPrior loadSoilPrior(const std::string& name_or_path) {
  const auto hash = name_or_path.rfind('#');
  const bool picks = hash != std::string::npos && !isFile(name_or_path);
  const std::string path = name_or_path.substr(0, picks ? hash : std::string::npos);
  const std::string wanted = picks ? name_or_path.substr(hash + 1) : "";
  const YamlFields root = open(path, librarySoilTexts(), "soil");
  if (!root.has("soils")) return readSoil(unwrapped(root, "soil"));
  return onlySoil(listedSoils(root), root, wanted);
}

Soil loadSoil(const std::string& name_or_path) {
  return loadSoilPrior(name_or_path).mean;
}

Rover loadRover(const std::string& name_or_path) {
  return readRover(unwrapped(open(name_or_path, libraryRoverTexts(), "rover"), "rover"));
}

std::vector<SoilPrior> loadSoils(const std::string& path) {
  const YamlFields root = YamlFields::file(path);
  if (!root.has("soils")) return {readSoil(unwrapped(root, "soil"))};
  return listedSoils(root);
}

TerrainClasses loadTerrainClasses(const std::string& path, const std::vector<std::string>& other_keys) {
  const YamlFields root = YamlFields::file(path);
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  const std::string wrapper = root.has("terrain_classes") ? "terrain_classes" : "classes";
  const bool wrapped = root.has(wrapper);
  if (wrapped) {
    std::vector<std::string> known = other_keys;
    known.insert(known.end(), {wrapper, "soils"});
    root.only(known);
  }
  const YamlFields classes = unwrapped(root, wrapper);
  const auto numbered = numberedClasses(classes, wrapped);
  const auto listed = listedSoils(root);
  TerrainClasses table;
  for (const auto& [number, key] : numbered) table[number] = soilOfClass(classes, key, listed, folder);
  if (table.empty()) root.refuse("", "names no terrain class", "write lines `1: soil name`");
  return table;
}

std::vector<std::string> librarySoils() {
  return libraryNames(librarySoilTexts());
}

std::vector<std::string> libraryRovers() {
  return libraryNames(libraryRoverTexts());
}

std::vector<SoilPrior> soilPriors(const std::string& name_or_path) {
  if (name_or_path.empty()) return {};
  const auto library = librarySoils();
  if (std::ranges::find(library, name_or_path) != library.end()) return {loadSoilPrior(name_or_path)};
  return loadSoils(name_or_path);
}

std::vector<StrengthPrior> strengthPriors(const std::vector<SoilPrior>& soils) {
  std::vector<StrengthPrior> priors;
  priors.reserve(soils.size());
  for (const SoilPrior& soil : soils) priors.push_back(strengthPrior(soil));
  return priors;
}

double meanModulus(const std::vector<SoilPrior>& soils) {
  double sum = 0.0;
  for (const SoilPrior& soil : soils) sum += soil.mean.shear_modulus_m;
  return sum / static_cast<double>(soils.size());
}

}  // namespace talus::terramech
