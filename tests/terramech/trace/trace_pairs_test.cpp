#include "traced_world.hpp"

namespace talus::terramech {
namespace {

TEST(TracePairs, TellsTwoEffectsApartThatOneCurveWouldTakeTogether) {
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

}  // namespace
}  // namespace talus::terramech
