#include <cmath>

#include <talus/cli/route/traverse_report.hpp>

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

// Property: a result sent between processes as JSON is bitwise equal, for every outcome.
TEST(DriveReport, ResultRoundTripsThroughJson) {
  for (const Outcome outcome : {Outcome::Reached, Outcome::Immobilised, Outcome::Tipped, Outcome::GaveUp}) {
    const planner::WorldResult sent = world(outcome, 0.1 * 0.7);
    const auto got = worldResult(nlohmann::ordered_json::parse(asJson(sent).dump()));
    EXPECT_EQ(got.drive.outcome, outcome);
    EXPECT_EQ(got.drive.energy_J, sent.drive.energy_J);
    EXPECT_EQ(got.drive.length_m, sent.drive.length_m);
    EXPECT_EQ(got.drive.max_slip, sent.drive.max_slip);
    EXPECT_EQ(got.drive.replans, 4);
    EXPECT_EQ(got.drive.alarms, 2);
    EXPECT_EQ(got.categories_changed, 17U);
  }
}

TEST(DriveReport, LabelsAndJsonNamesMatchTheirDocumentation) {
  EXPECT_EQ(label(Outcome::GaveUp), "no feasible route");
  EXPECT_EQ(label(Outcome::Reached), "reached");
  EXPECT_EQ(label(SoilKnowledge::PerfectKnowledge), "perfect knowledge");
  EXPECT_EQ(asJson(world(Outcome::GaveUp, 1.0))["outcome"], "gave_up");  // stable name in files
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

}  // namespace traverse_report_test
}  // namespace talus::cli
