#include <cmath>

#include <refused.hpp>

#include <talus/cli/route/traverse_telemetry.hpp>
#include <talus/common/input_error.hpp>
#include <talus/terramech/io/telemetry_reader.hpp>

#include "run_program.hpp"

namespace talus::cli {
namespace traverse_telemetry_test {

// Property: the telemetry reader returns the recorded wheel values to nine digits; slope_rad is the atan of
// the gradient; unknown values are missing.
TEST(DriveTelemetry, TelemetryRoundTrips) {
  const Folder folder;
  planner::TraverseSimulation drive;
  for (int k = 0; k < 3; ++k)
    drive.records.push_back({.wheel = static_cast<std::size_t>(k),
                             .heading_rad = 0.5 * k,
                             .reading = {.time_s = 10.0 + k,
                                         .place = {100.25 + k, -3.5},
                                         .load_N = 56.0,
                                         .slip = k == 1 ? std::nan("") : 0.123456789,
                                         .torque_Nm = 2.5,
                                         .sinkage_m = 0.0125,
                                         .gradient = 0.2,
                                         .pass = k + 1}});
  terramech::Rover rover;
  rover.wheel = {.radius_m = 0.12, .width_m = 0.08};
  saveTelemetry(folder / "t.csv", drive, rover);
  const terramech::Telemetry table = terramech::readTelemetry(folder / "t.csv");
  ASSERT_EQ(table.size(), 3U);
  EXPECT_NEAR(table.at("slip")[0], 0.123456789, 1e-9);
  EXPECT_TRUE(std::isnan(table.at("slip")[1]));
  EXPECT_EQ(table.at("x_m")[2], 102.25);
  EXPECT_EQ(table.at("pass_index")[2], 3.0);
  EXPECT_NEAR(table.at("slope_rad")[0], std::atan(0.2), 1e-8);  // Closed form
  EXPECT_EQ(table.at("wheel_width_m")[0], 0.08);
  ASSERT_TRUE(table.findWords("wheel"));
  EXPECT_EQ((*table.findWords("wheel"))[1], "w2");
}

TEST(DriveTelemetry, MissingFolderIsRejected) {
  EXPECT_REFUSED(saveTelemetry("/no/such/folder/t.csv", {}, {}), InputError,
                 "folder /no/such/folder does not exist");
}

}  // namespace traverse_telemetry_test
}  // namespace talus::cli
