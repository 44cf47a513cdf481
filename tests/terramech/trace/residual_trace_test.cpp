#include <cmath>

#include <talus/terramech/trace/held_out.hpp>
#include <talus/terramech/trace/residual_trace.hpp>

#include "blind_worlds.hpp"
#include "made_rows.hpp"

namespace talus::terramech {
namespace {

Telemetry telemetryOf(const blind::World& world) {
  Telemetry t;
  t.source = "world";
  for (std::size_t k = 0; k < world.columns.size(); ++k) {
    t.numbers.push_back({world.columns[k], {}});
    for (const auto& row : world.rows) t.numbers.back().values.push_back(row[k]);
  }
  if (!world.run.empty()) {
    t.words.push_back({"run", {}});
    for (int run : world.run) t.words.back().values.push_back("run" + std::to_string(run));
  }
  for (std::size_t row = 0; row < world.rows.size(); ++row) t.lines.push_back(row + 2);
  return t;
}

RefinedModel baseOf(const blind::Ground& g) {
  RefinedModel m;
  m.soil = {.name = "hidden",
            .cohesion_Pa = g.cohesion,
            .friction_angle_rad = g.phi,
            .sinkage_exponent = g.n,
            .cohesive_modulus = 0.0,
            .frictional_modulus = g.k,
            .shear_modulus_m = g.shear_k,
            .c1 = g.c1,
            .c2 = g.c2,
            .density_kg_m3 = g.density};
  return m;
}

TraceResult traced(const blind::World& world) {
  const RefinedModel base = baseOf(world.ground);
  TraceOptions options;
  options.flips = 999;
  return traceResiduals(base, makeTrial(telemetryOf(world), base), options);
}

std::vector<blind::Claim> claims(const TraceResult& result) {
  std::vector<blind::Claim> all;
  for (const TracedEffect& e : result.effects)
    all.push_back({e.chosen.candidate.parts.front().name, e.chosen.candidate.covariate(), name(e.channel)});
  return all;
}

TEST(ResidualTrace, NamesAHiddenEffectAndReachesTheNoise) {
  // Property: worlds of an independent generator; which effect each hides is decided by its seed.
  for (const std::uint64_t seed : {5U, 17U, 40U}) {
    const blind::World world = blind::makeWorld({.seed = seed, .effects = 1, .library = true});
    const TraceResult result = traced(world);
    const blind::Marks marks = blind::judge(world, claims(result));
    EXPECT_EQ(marks.located, 1) << world.hidden[0].kind;
    EXPECT_EQ(marks.family, 1) << world.hidden[0].kind;
    EXPECT_LT(result.refined_rmse[0], 1.25 * result.noise_floor[0]) << world.hidden[0].kind;
    EXPECT_LE(result.refined_rmse[0], result.base_rmse[0]);
  }
}

TEST(ResidualTrace, FindsNothingWhereNothingIs) {
  for (const std::uint64_t seed : {1U, 2U, 3U})
    EXPECT_TRUE(traced(blind::makeWorld({.seed = seed, .effects = 0, .library = true})).effects.empty())
        << seed;
}

TEST(ResidualTrace, CallsAFormThatNoLibraryHoldsEmpirical) {
  const blind::World world = blind::makeWorld({.seed = 2, .effects = 1, .library = false});
  const blind::Marks marks = blind::judge(world, claims(traced(world)));
  EXPECT_EQ(marks.located, 1) << world.hidden[0].kind;
  EXPECT_EQ(marks.family, 1) << world.hidden[0].kind;
}

TEST(ResidualTrace, TellsTwoEffectsApartThatOneCurveWouldTakeTogether) {
  // Property: a pile behind beside a tilted load cell, and a torque offset beside a soft wheel; without a
  // look at pairs a curve over slip or sinkage stands for both.
  for (const std::uint64_t seed : {8027U, 8032U}) {
    const blind::World world = blind::makeWorld({.seed = seed, .effects = 2, .library = true, .wide = true});
    const blind::Marks marks = blind::judge(world, claims(traced(world)));
    EXPECT_EQ(marks.located, 2) << seed;
    EXPECT_EQ(marks.family, 2) << seed;
    EXPECT_EQ(marks.claimed, 2) << seed;
  }
}

TEST(ResidualTrace, SameSeedSameAnswer) {
  const blind::World world = blind::makeWorld({.seed = 10, .effects = 1, .library = true});
  const TraceResult a = traced(world), b = traced(world);
  ASSERT_EQ(a.effects.size(), b.effects.size());
  ASSERT_FALSE(a.effects.empty());
  EXPECT_EQ(a.effects[0].chosen.candidate.parts[0].parameters,
            b.effects[0].chosen.candidate.parts[0].parameters);
}

TEST(HeldOut, WholeBandsAreHeldOut) {
  const blind::World world = blind::makeWorld({.seed = 10, .effects = 1, .library = true});
  const TraceResult result = traced(world);
  const HeldOut held = holdOut(result, {}).front();
  EXPECT_FALSE(held.scheme.empty());
  EXPECT_LT(held.refined_rmse[1], held.base_rmse[1]);
}

// Columns that the found effects name, for rows of five boxes whose pull is off by turns; `datum_m`: error of
// the sinkage's zero.
std::vector<std::string> causesInBoxes(double datum_m) {
  RefinedModel base;
  base.soil = madeSand();
  std::vector<std::string> columns = wheelColumns();
  columns.emplace_back("box");
  MadeRows rows(columns);
  std::mt19937_64 random(3);
  for (int k = 0; k < 100; ++k) {
    const int box = (k * 7) % 5;
    std::vector<double> row = wheelRow(base.soil, 50.0 + k % 30, 0.1 + 0.05 * (k % 12), 0.02, random);
    row[3] += datum_m;
    row[4] += (box % 2 == 0 ? 0.06 : -0.06) * row[0];
    row.push_back(box);
    rows.add(row);
  }
  std::vector<std::string> causes;
  for (const TracedEffect& e :
       traceResiduals(base, makeTrial(rows.telemetry(), base), {.flips = 499}).effects)
    causes.push_back(e.chosen.candidate.covariate());
  return causes;
}

TEST(ResidualTrace, AFurtherCurveMustTellLevelsThatItHasNotSeen) {
  // No curve over the boxes' number foretells the sixth: alone it is told all the same, since the boxes do
  // differ; beside a known effect it is not taken for a part of the model.
  EXPECT_THAT(causesInBoxes(0.0), ::testing::ElementsAre("box"));
  EXPECT_THAT(causesInBoxes(0.02), ::testing::ElementsAre("constant"));
}

}  // namespace
}  // namespace talus::terramech
