#include <talus/costmap/surface/cell_belief.hpp>

namespace talus::costmap {
namespace cell_belief_test {

constexpr Hazard kAll[] = {Hazard::Unknown, Hazard::Slope,   Hazard::Step,     Hazard::Roughness,
                           Hazard::Rocks,   Hazard::KeepOut, Hazard::Obstacle, Hazard::Near};

// Property: a hazard value is a set; each of the 256 subsets contains exactly its members.
TEST(CellBelief, HazardSubsetsAreRepresentedExactly) {
  for (unsigned subset = 0; subset < 256; ++subset) {
    Hazard set = Hazard::None;
    for (unsigned k = 0; k < 8; ++k)
      if (subset >> k & 1U) set |= kAll[k];
    for (unsigned k = 0; k < 8; ++k) ASSERT_EQ(has(set, kAll[k]), (subset >> k & 1U) != 0) << subset;
    EXPECT_FALSE(has(set, Hazard::None));
    EXPECT_EQ(set | set, set);
  }
}

TEST(CellBelief, DefaultBeliefIsUnknown) {
  const CellBelief none;
  EXPECT_EQ(none.category, 3);  // unknown
  EXPECT_EQ(none.confidence, 0);
  EXPECT_EQ(none.evidence, 0.0F);
}

}  // namespace cell_belief_test
}  // namespace talus::costmap
