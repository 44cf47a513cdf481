#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <talus/terramech/calibration/search/rival_causes.hpp>

#include "calibration/traced_world.hpp"

namespace talus::terramech {
namespace rival_causes_test {

std::vector<std::string> columns(const TracedEffect& effect) {
  std::vector<std::string> all{effect.chosen.candidate.covariate()};
  for (const Explanation& e : effect.equal) all.push_back(e.candidate.covariate());
  std::sort(all.begin(), all.end());
  return all;
}

/// A world in which dust reduces the pull, with a second column correlated with dust.
blind::World tied() {
  const blind::World world =
      blind::makeWorld({.seed = 8, .effects = 1, .library = false, .unresolvable = "tied"});
  EXPECT_EQ(world.hidden[0].kind, "form:pull_dust_saturating");
  return world;
}

TEST(RivalCauses, CollinearColumnsAreReportedAsEqualCauses) {
  // Property: two columns, one a multiple of the other, are reported as equal causes.
  const TraceResult result = traced(tied());
  ASSERT_EQ(result.effects.size(), 1U);
  EXPECT_EQ(columns(result.effects[0]), (std::vector<std::string>{"dust_index", "tied_0"}));
  ASSERT_FALSE(result.rivals.empty());
  EXPECT_EQ(result.rivals[0].in_place_of, result.effects[0].chosen.candidate.parts[0].name);
  EXPECT_EQ(result.rivals[0].model.effects.size(), result.refined.effects.size());
  EXPECT_FALSE(result.rivals[0].model.covariance.empty());
}

TEST(RivalCauses, IdentifiableCauseHasNoEqual) {
  // Property: without the correlated column the same world has one cause.
  blind::World world = tied();
  world.columns.pop_back();
  for (auto& row : world.rows) row.pop_back();
  const TraceResult result = traced(world);
  ASSERT_EQ(result.effects.size(), 1U);
  EXPECT_EQ(columns(result.effects[0]), std::vector<std::string>{"dust_index"});
}

TEST(RivalCauses, ConstantOffsetHasNoDriftAsEqualCause) {
  // Property: with a constant zero error of the sinkage, a drift or a nearly constant curve is the same
  // offset and not a rival.
  const blind::World world =
      blind::makeWorld({.seed = 1303, .effects = 1, .library = true, .campaign = true});
  ASSERT_EQ(world.hidden[0].kind, "sinkage_datum");
  const TraceResult result = traced(world);
  ASSERT_EQ(result.effects.size(), 1U);
  EXPECT_TRUE(result.effects[0].equal.empty());
}

}  // namespace rival_causes_test
}  // namespace talus::terramech
