#include <set>
#include <string>

#include <talus/terramech/io/file_keys.hpp>
#include <talus/terramech/io/soil_library.hpp>
#include <talus/terramech/io/yaml_fields.hpp>

namespace talus::terramech {
namespace file_keys_test {

TEST(FileKeys, KeyNamesAreUniqueAndDocumented) {
  for (const auto keys : {soilKeys(), roverKeys(), wheelKeys(), telemetryKeys()}) {
    std::set<std::string> names;
    for (const FileKey& key : keys) {
      EXPECT_TRUE(names.insert(key.name).second) << key.name;
      EXPECT_NE(std::string(key.meaning), "") << key.name;
    }
    EXPECT_EQ(namesOf(keys).size(), keys.size());
  }
}

// Property: a rover and a soil with every key are accepted.
TEST(FileKeys, EveryRoverAndSoilKeyIsAccepted) {
  const std::string wheels =
      "{count: 6, radius_m: 0.1, width_m: 0.1, grouser_height_m: 0, grouser_count: 0, lug_thrust: 0}";
  std::string rover, soil;
  for (const std::string& name : namesOf(roverKeys()))
    rover += name + ": " +
             (name == "name"                        ? "r"
              : name == "steering"                  ? "ackermann"
              : name == "wheels"                    ? wheels
              : name.starts_with("centre_of_mass_") ? "0.05"
                                                    : "0.2") +
             "\n";
  for (const std::string& name : namesOf(soilKeys()))
    soil += name + ": " + (name == "name" ? "s" : name == "rut_stiffness" ? "4" : "0.3") + "\n";
  EXPECT_EQ(readRover(YamlFields::text(rover, "r.yaml")).steering, Steering::Ackermann);
  EXPECT_EQ(readSoil(YamlFields::text(soil, "s.yaml")).mean.name, "s");
}

}  // namespace file_keys_test
}  // namespace talus::terramech
