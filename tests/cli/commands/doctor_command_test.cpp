#include <cstdlib>

#include <nlohmann/json.hpp>

#include <talus/maps/raster/gdal_dataset.hpp>

#include "run_program.hpp"

namespace talus::cli {
namespace doctor_command_test {

using nlohmann::json;

TEST(DoctorCommand, SettingsAreListedWithTheirOrigin) {
  const Ran ran = runTalus({"--seed", "7", "doctor", "--json"});
  ASSERT_EQ(ran.code, 0) << ran.err;
  const json found = json::parse(ran.out);
  EXPECT_EQ(found["options"]["seed"], (json{{"value", "7"}, {"origin", "--seed"}}));
  EXPECT_EQ(found["options"]["threads"]["origin"], "default");
  EXPECT_EQ(found["vector_drivers"]["there"].size(), maps::vectorFormats().size());
  EXPECT_EQ(found["raster_drivers"]["missing"], json::array());
  EXPECT_TRUE(found["faults"].empty());
}

TEST(DoctorCommand, MissingDriverIsReportedAsAFault) {
  ::setenv("GDAL_SKIP", "GPX", 1);
  const Ran ran = runTalus({"doctor"});
  ::unsetenv("GDAL_SKIP");
  EXPECT_EQ(ran.code, 1);
  EXPECT_THAT(ran.err, testing::HasSubstr("GDAL lacks the driver GPX"));
}

}  // namespace doctor_command_test
}  // namespace talus::cli
