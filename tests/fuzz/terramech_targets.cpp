#include <functional>

#include <talus/common/common.hpp>
#include <talus/terramech/terramech_io.hpp>

#include "targets.hpp"

namespace talus::fuzz {
namespace {

void readTelemetry(const std::string& bytes) {
  terramech::readTelemetry(fileOf(bytes, ".csv"), {.required = {"load_N", "slip"}, .wheel_radius_m = 0.1});
}

void readYaml(const std::string& bytes) {
  const std::string path = fileOf(bytes, ".yaml");
  std::size_t refused = 0;
  for (const auto& read : {std::function<void()>([&] { terramech::loadSoil(path); }),
                           std::function<void()>([&] { terramech::loadRover(path); }),
                           std::function<void()>([&] { terramech::loadModel(path); })})
    try {
      read();
    } catch (const InputError&) {
      ++refused;
    }
  if (refused == 3) throw InputError({"yaml", "is neither soil, rover nor model", ""});
}

}  // namespace

std::vector<Target> terramechTargets() {
  return {
      {"telemetry",
       {"load_N,slip,sinkage_m,run\n10,0.2,0.01,a\n20,0.3,,b\n", "slip,load_N\n0.1,5\n"},
       readTelemetry},
      {"yaml",
       {"name: s\ncohesion_Pa: 500\nfriction_angle_deg: 30\nsinkage_exponent: 1\ncohesive_modulus: 1400\n"
        "frictional_modulus: 820000\nshear_modulus_m: 0.02\nc1: 0.3\nc2: 0\n",
        "name: w\nmass_kg: 10\ngravity_m_s2: 3.7\nwheels: {count: 6, radius_m: 0.065, width_m: 0.08}\n"
        "wheelbase_m: 0.5\ntrack_m: 0.4\nclearance_m: 0.2\ncentre_of_mass_height_m: 0.2\nmax_pitch_rad: 0.5\n"
        "max_roll_rad: 0.5\nmax_torque_Nm: 5\nmax_speed_mps: 0.1\nturning_radius_m: 1\nhotel_power_W: 10\n"
        "steering: skid\n"},
       readYaml},
  };
}

}  // namespace talus::fuzz
