#include "library.hpp"

#include <numbers>
#include <stdexcept>
#include <utility>

#include <yaml-cpp/yaml.h>

namespace safety {
namespace {

constexpr std::pair<const char*, double> kUnits[] = {{"", 1.0},
                                                     {"_N", 1.0},
                                                     {"_kN", 1e3},
                                                     {"_MN", 1e6},
                                                     {"_Pa", 1.0},
                                                     {"_kPa", 1e3},
                                                     {"_m", 1.0},
                                                     {"_mm", 1e-3},
                                                     {"_cm", 1e-2},
                                                     {"_rad", 1.0},
                                                     {"_deg", std::numbers::pi / 180.0},
                                                     {"_kg", 1.0},
                                                     {"_Nm", 1.0},
                                                     {"_m_s2", 1.0},
                                                     {"_kg_m3", 1.0}};

struct Number {
  double mean = 0.0, deviation = 0.0;
  bool stated = false;
};

// Reads a key with any of its unit suffixes: a number, or {mean, std}.
Number number(const YAML::Node& node, const std::string& stem) {
  for (const auto& [unit, factor] : kUnits) {
    const YAML::Node value = node[stem + unit];
    if (!value) continue;
    if (value.IsMap()) return {factor * value["mean"].as<double>(), factor * value["std"].as<double>(), true};
    return {factor * value.as<double>(), 0.0, true};
  }
  return {};
}

double stated(const YAML::Node& node, const std::string& stem) {
  const Number n = number(node, stem);
  if (!n.stated) throw std::runtime_error("rover file: no " + stem);
  return n.mean;
}

SoilPrior priorOf(const YAML::Node& node) {
  SoilPrior prior;
  constexpr std::pair<const char*, double Soil::*> kFields[] = {
      {"cohesion", &Soil::cohesion_Pa},
      {"friction_angle", &Soil::friction_angle_rad},
      {"sinkage_exponent", &Soil::sinkage_exponent},
      {"cohesive_modulus", &Soil::cohesive_modulus},
      {"frictional_modulus", &Soil::frictional_modulus},
      {"shear_modulus", &Soil::shear_modulus_m},
      {"c1", &Soil::c1},
      {"c2", &Soil::c2},
      {"density", &Soil::density_kg_m3},
      {"digging_exponent", &Soil::digging_exponent},
      {"side_bulldozing", &Soil::side_bulldozing}};
  for (const auto& [stem, field] : kFields) {
    const Number n = number(node, stem);
    if (!n.stated) continue;
    prior.mean.*field = n.mean;
    prior.deviation.*field = n.deviation;
  }
  return prior;
}

}  // namespace

Rover Library::rover(const std::string& name) const {
  const YAML::Node node = YAML::LoadFile(folder + "/rovers/" + name + ".yaml")["rover"];
  const YAML::Node wheels = node["wheels"];
  return {.mass_kg = stated(node, "mass"),
          .gravity_m_s2 = stated(node, "gravity"),
          .wheels = wheels["count"].as<int>(),
          .wheel_radius_m = stated(wheels, "radius"),
          .wheel_width_m = stated(wheels, "width"),
          .wheelbase_m = stated(node, "wheelbase"),
          .track_m = stated(node, "track"),
          .clearance_m = stated(node, "clearance"),
          .centre_of_mass_height_m = stated(node, "centre_of_mass_height"),
          .max_pitch_rad = stated(node, "max_pitch"),
          .max_roll_rad = stated(node, "max_roll"),
          .max_torque_Nm = stated(node, "max_torque")};
}

SoilPrior Library::soil(const std::string& name) const {
  return priorOf(YAML::LoadFile(folder + "/soils/" + name + ".yaml")["soil"]);
}

std::map<int, SoilPrior> Library::classes(const std::string& path) const {
  std::map<int, SoilPrior> found;
  for (const auto& entry : YAML::LoadFile(path)["terrain_classes"])
    found[entry.first.as<int>()] =
        entry.second.IsMap() ? priorOf(entry.second) : soil(entry.second.as<std::string>());
  return found;
}

}  // namespace safety
