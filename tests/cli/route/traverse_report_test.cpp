#include <cmath>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include <talus/cli/app/campaign.hpp>
#include <talus/cli/app/context.hpp>
#include <talus/cli/route/traverse_report.hpp>
#include <talus/terramech/terramech_io.hpp>

#include "run_program.hpp"

namespace talus::cli {
namespace traverse_report_test {

using planner::Outcome;
using planner::SoilKnowledge;
using testing::HasSubstr;

planner::WorldResult world(Outcome outcome, double energy_J) {
  planner::WorldResult result;
  result.drive.outcome = outcome;
  result.drive.energy_J = energy_J;
  result.drive.length_m = 1.0 / 3.0;
  result.drive.time_s = 1234.5;
  result.drive.replans = 4;
  result.drive.alarms = 2;
  result.drive.max_slip = 0.1 + 0.2;
  result.categories_changed = 17;
  return result;
}

// Closed form: three of four worlds reached the goal: 75 %; the mean energy is that of these three worlds.
TEST(DriveReport, RatesAreSharesOfTheWorlds) {
  const std::vector<planner::WorldResult> results{world(Outcome::Reached, 100.0),
                                                  world(Outcome::Reached, 200.0), world(Outcome::Tipped, 9e9),
                                                  world(Outcome::Reached, 300.0)};
  const auto json = asJson(results);
  EXPECT_EQ(json["worlds"], 4);
  EXPECT_EQ(json["reached"]["rate"], 0.75);
  EXPECT_EQ(json["tipped"]["rate"], 0.25);
  EXPECT_EQ(json["immobilised"]["rate"], 0.0);
  EXPECT_NEAR(json["mean_energy_J_where_reached"].get<double>(), 200.0, 1e-9);
  EXPECT_EQ(json["each"].size(), 4U);
  EXPECT_THAT(asText(results), HasSubstr("75.0 % ["));
}

// Closed form: in worlds solved with perfect knowledge, 150 J against 100 J gives the ratio 1.5.
TEST(DriveReport, BeliefsAreComparedInWorldsSolvedWithPerfectKnowledge) {
  BeliefResults beliefs;
  for (auto& each : beliefs) each = {world(Outcome::Reached, 150.0), world(Outcome::Immobilised, 1.0)};
  beliefs[static_cast<std::size_t>(SoilKnowledge::PerfectKnowledge)] = {world(Outcome::Reached, 100.0),
                                                                        world(Outcome::GaveUp, 0.0)};
  const auto json = asJson(beliefs);
  EXPECT_EQ(json["worlds"], 2);
  EXPECT_EQ(json["worlds_with_a_safe_route"], 1);
  EXPECT_EQ(json["prior"]["reached"]["rate"], 1.0);
  EXPECT_NEAR(json["prior"]["energy_over_clairvoyant"]["mean"].get<double>(), 1.5, 1e-9);
  EXPECT_THAT(asText(beliefs), HasSubstr("2 worlds; perfect knowledge reaches the goal in 1 of them"));
}

planner::WorldResult numbered(std::size_t b, std::size_t i) {
  planner::WorldResult result;
  result.drive.outcome = static_cast<planner::Outcome>(i % 5);
  result.drive.energy_J = (static_cast<double>(i) + 1.0) / 3.0;
  result.drive.length_m = 1.0 / 3.0;
  result.drive.max_slip = 0.1 + 0.2;
  result.drive.replans = static_cast<int>(b);
  result.categories_changed = i;
  return result;
}

// Property: results are bitwise equal and in order after the conversion to text, for any number of workers.
TEST(DriveWorlds, ResultsAreInOrderForAnyWorkerCount) {
  const Campaign campaign;
  for (const std::size_t workers : {1U, 3U}) {
    const auto jobs =
        campaign.results({.count = 14, .workers = workers},
                         [](std::size_t k) { return jsonText(asJson(numbered(k / 7, k % 7))); }, {});
    const SimulatedWorlds driven = simulatedWorlds(2, 7, jobs.value());
    ASSERT_EQ(driven.results.size(), 2U);
    EXPECT_TRUE(driven.failures.empty());
    for (std::size_t b = 0; b < 2; ++b) {
      ASSERT_EQ(driven.results[b].size(), 7U);
      for (std::size_t i = 0; i < 7; ++i) {
        const planner::WorldResult expected = numbered(b, i), &got = driven.results[b][i];
        EXPECT_EQ(got.drive.outcome, expected.drive.outcome);
        EXPECT_EQ(got.drive.energy_J, expected.drive.energy_J);
        EXPECT_EQ(got.drive.length_m, expected.drive.length_m);
        EXPECT_EQ(got.drive.max_slip, expected.drive.max_slip);
        EXPECT_EQ(got.drive.replans, expected.drive.replans);
        EXPECT_EQ(got.categories_changed, expected.categories_changed);
      }
    }
  }
}

TEST(DriveWorlds, FailedWorldIsReportedAndExcludedUnderEveryBelief) {
  const Campaign campaign;
  const auto world = [](std::size_t k) {
    if (k == 6) throw std::domain_error("no such ground");
    return jsonText(asJson(numbered(k / 4, k % 4)));
  };
  const SimulatedWorlds driven =
      simulatedWorlds(2, 4, campaign.results({.count = 8, .workers = 2}, world, {}).value());
  ASSERT_EQ(driven.failures.size(), 1U);
  EXPECT_EQ(driven.failures[0].world, 2U);
  EXPECT_EQ(driven.failures[0].reason, "no such ground");
  for (const auto& results : driven.results) {
    ASSERT_EQ(results.size(), 3U);
    EXPECT_EQ(results[2].categories_changed, 3U) << "the same worlds in the same order";
  }
}

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

}  // namespace traverse_report_test
}  // namespace talus::cli
