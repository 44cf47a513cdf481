#include <cmath>
#include <sstream>

#include <site_map.hpp>

#include <costmap/evidence_field.hpp>
#include <costmap/map_file.hpp>

namespace talus::costmap {
namespace {

std::vector<std::string> wide() {
  return std::vector<std::string>(60, std::string(60, '1'));
}

WheelObservation soft(double x, double y) {
  return {.time_s = 12.0, .place = {100.0 + x, 200.0 + y}, .pull = {0.05, 0.05}, .sinkage = {0.6, 0.05}};
}

TEST(TraversabilityMap, LearnsWhereItDroveAndDoubtsFarAway) {
  TraversabilityMap map = mapOf(wide());
  const GroundBelief before = *map.ground({30, 30});
  for (int i = 0; i < 20; ++i) EXPECT_TRUE(map.learn(soft(30.5, 30.5)));
  map.publish();
  const GroundBelief here = *map.ground({30, 30}), near = *map.ground({32, 30}), far = *map.ground({50, 50});
  EXPECT_LT(here.pull.mean, before.pull.mean - 0.05);
  EXPECT_LT(here.pull.std, before.pull.std);
  EXPECT_LT(here.pull.mean, near.pull.mean);
  EXPECT_LT(near.pull.mean, far.pull.mean);
  EXPECT_LT(far.pull.mean, before.pull.mean) << "the class as a whole learned a little";
  EXPECT_GT(far.pull.std, 0.9 * before.pull.std);
}

TEST(TraversabilityMap, PublishesWhatItLearnedAndKeepsOldVersions) {
  TraversabilityMap map = mapOf(wide());
  const auto old = map.published();
  for (int i = 0; i < 20; ++i) map.learn(soft(30.5, 30.5));
  EXPECT_EQ(map.published(), old) << "nothing shows before publish()";
  map.publish();
  const auto fresh = map.published();
  EXPECT_GT(fresh->version(), old->version());
  const auto cost = [](const CostGrid& grid, maps::Cell c) {
    return grid.cost().costPerMetre(grid.at(c), {});
  };
  EXPECT_GT(cost(*fresh, {30, 30}), cost(*old, {30, 30}));
  EXPECT_EQ(old->at({30, 30}).curve(), 0);
}

TEST(TraversabilityMap, EvidenceDoesNotCrossIntoAnotherClass) {
  std::vector<std::string> site = wide();
  for (auto& row : site) row.replace(31, 29, 29, '2');
  TraversabilityMap map = mapOf(site);
  const GroundBelief dust = *map.ground({32, 30});
  for (int i = 0; i < 20; ++i) map.learn(soft(30.5, 30.5));
  map.publish();
  EXPECT_EQ(map.ground({32, 30})->pull.mean, dust.pull.mean);
}

TEST(TraversabilityMap, EvidenceSurvivesAFileToTheBit) {
  TraversabilityMap map = mapOf(wide(), 0.05);
  for (int i = 0; i < 40; ++i) map.learn(soft(20.5 + 0.3 * i, 30.5));
  map.publish();
  std::stringstream stream, again;
  writeMap(map, stream);
  const TraversabilityMap back = readMap(stream, {.name = "map.ot", .threads = 1});
  writeMap(back, again);
  EXPECT_EQ(stream.str(), again.str());
  for (int column = 0; column < 60; ++column)
    EXPECT_EQ(back.belief({column, 30}), map.belief({column, 30})) << column;
}

TEST(TraversabilityMap, OutsideTheMapNothingIsLearned) {
  TraversabilityMap map = mapOf(wide());
  EXPECT_FALSE(map.learn(soft(-5.0, 3.0)));
  EXPECT_FALSE(map.learn(soft(std::nan(""), 3.0)));
}

TEST(EvidenceField, ManyPlacesMoveTheClassOnePlaceHardly) {
  TraversabilityMap one = mapOf(wide()), many = mapOf(wide());
  for (int i = 0; i < 200; ++i) {
    one.learn(soft(30.5, 30.5));
    many.learn(soft(5.5 + 0.25 * i, 30.5));
  }
  EXPECT_LT(one.evidence().posterior(0).places, 1.0);
  EXPECT_GT(many.evidence().posterior(0).places,
            8.0);  // Closed form: 50 m over integral scales of 3.3 m, less noise
  EXPECT_LT(many.evidence().posterior(0).pull.mean, one.evidence().posterior(0).pull.mean);
}

}  // namespace
}  // namespace talus::costmap
