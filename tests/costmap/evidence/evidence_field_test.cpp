#include <cmath>
#include <sstream>

#include <site_map.hpp>

#include <talus/costmap/costmap.hpp>
#include <talus/costmap/evidence/class_evidence.hpp>
#include <talus/costmap/evidence/evidence.hpp>

namespace talus::costmap {
namespace evidence_field_test {

std::vector<std::string> wide() {
  return std::vector<std::string>(60, std::string(60, '1'));
}

WheelObservation soft(double x, double y) {
  return {.time_s = 12.0,
          .place = {100.0 + x, 200.0 + y},
          .pull = {0.05, 0.05},
          .sinkage = {0.6, 0.05},
          .trust = Trust::Once,
          .sinkage_verified = true};
}

// A reading whose pull is lower than the class mean by `by`.
WheelObservation weaker(double x, double y, double by) {
  return {.time_s = 12.0,
          .place = {100.0 + x, 200.0 + y},
          .pull = {testGround()->prior(0).pull.value - by, 0.05},
          .sinkage = {0.2, 0.05},
          .trust = Trust::Once,
          .sinkage_verified = true};
}

TEST(TraversabilityMap, EvidenceIsLocalAndUncertaintyGrowsWithDistance) {
  TraversabilityMap map = mapOf(wide());
  const GroundBelief before = *map.ground({30, 30});
  for (int i = 0; i < 20; ++i) EXPECT_TRUE(map.learn(soft(30.5, 30.5)));
  map.publish();
  const GroundBelief here = *map.ground({30, 30}), near = *map.ground({32, 30}), far = *map.ground({50, 50});
  EXPECT_LT(here.pull.value, before.pull.value - 0.05);
  EXPECT_LT(here.pull.std, before.pull.std);
  EXPECT_LT(here.pull.value, near.pull.value);
  EXPECT_LT(near.pull.value, far.pull.value);
  EXPECT_GT(far.pull.value, before.pull.value - 0.25 * (before.pull.value - here.pull.value))
      << "one place tells little about its class";
  EXPECT_LE(here.pull.std, near.pull.std);
  EXPECT_LE(near.pull.std, far.pull.std);
  EXPECT_LE(far.pull.std, before.pull.std);
}

TEST(TraversabilityMap, EvidenceDoesNotAffectOtherClasses) {
  std::vector<std::string> site = wide();
  for (auto& row : site) row.replace(31, 29, 29, '2');
  TraversabilityMap map = mapOf(site);
  const GroundBelief dust = *map.ground({32, 30});
  for (int i = 0; i < 20; ++i) map.learn(soft(30.5, 30.5));
  map.publish();
  EXPECT_EQ(map.ground({32, 30})->pull.value, dust.pull.value);
}

TEST(TraversabilityMap, ObservationsOutsideTheMapAreRejected) {
  TraversabilityMap map = mapOf(wide());
  EXPECT_FALSE(map.learn(soft(-5.0, 3.0)));
  EXPECT_FALSE(map.learn(soft(std::nan(""), 3.0)));
}

TEST(EvidenceField, ClassMeanMovesMoreWithManyIndependentPlaces) {
  TraversabilityMap one = mapOf(wide()), many = mapOf(wide());
  for (int i = 0; i < 200; ++i) {
    one.learn(weaker(30.5, 30.5, 0.06));
    many.learn(weaker(5.5 + 0.25 * i, 30.5, 0.06));
  }
  EXPECT_LT(many.evidence().classBelief(0).pull.value, one.evidence().classBelief(0).pull.value - 0.01);
  EXPECT_LT(many.evidence().classBelief(0).pull.std, one.evidence().classBelief(0).pull.std);
}

TEST(EvidenceField, OutlierPlacesDoNotMoveTheClassMean) {
  TraversabilityMap map = mapOf(wide()), ordinary = mapOf(wide());
  for (int i = 0; i < 20; ++i) {
    map.learn(weaker(30.5, 30.5, 0.4));
    ordinary.learn(weaker(30.5, 30.5, 0.06));
  }
  map.publish();
  // Property: readings seven standard deviations from the class change the class mean by less than one
  // standard deviation, but determine the estimate of their own cells.
  const double prior = map.model().prior(0).pull.value;
  EXPECT_GT(map.evidence().classBelief(0).pull.value, prior - 0.05);
  EXPECT_LT(map.ground({30, 30})->pull.value, prior - 0.3);
  EXPECT_NEAR(map.ground({45, 45})->pull.value, prior, 0.05);
}

TEST(TraversabilityMap, RefusedAreaStaysBlocked) {
  TraversabilityMap map = mapOf(wide());
  map.refuse({130.5, 230.5}, 2.0);
  map.publish();
  for (int row = 25; row <= 35; ++row)
    for (int column = 25; column <= 35; ++column) {
      const bool inside = std::hypot(column - 30, row - 30) <= 2.0;
      EXPECT_EQ(has(map.surface().hazards({column, row}), Hazard::Obstacle), inside) << column << ' ' << row;
      EXPECT_EQ(map.published()->at({column, row}).curve() == CellCode::kBlocked, inside)
          << column << ' ' << row;
    }
  for (int i = 0; i < 20; ++i) map.learn(weaker(30.5, 30.5, -0.1));
  map.publish();
  EXPECT_EQ(map.published()->at({30, 30}).curve(), CellCode::kBlocked);
  EXPECT_NO_THROW(map.refuse({-500.0, 1e9}, 3.0));
}

}  // namespace evidence_field_test
}  // namespace talus::costmap
