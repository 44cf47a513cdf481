#include <talus/planner/field/patch_bound.hpp>

#include "changed_map.hpp"

namespace talus::planner {
namespace patch_bound_test {

using testing::Change;
using testing::drawn;
using testing::randomTrial;
using testing::Trial;

// Property: the bound is never above the recomputed field at any cell. If no cell became cheaper, the bound
// is not below the old field, which keeps the search narrow.
TEST(PatchBound, BoundIsNeverAboveTheNewField) {
  int held = 0, gained = 0;
  for (const Change change : {Change::Anew, Change::Cheaper, Change::Dearer, Change::Either})
    for (unsigned seed = 1; seed <= 60; ++seed) {
      const Trial trial = randomTrial(seed, change);
      const PatchBound bound(trial.before, trial.box);
      if (!bound.holds()) continue;
      ++held;
      for (int row = 0; row < 60; ++row)
        for (int column = 0; column < 70; ++column) {
          const std::size_t cell = trial.edges->padded().index({column, row});
          ASSERT_LE(bound(cell), trial.anew.units({column, row})) << seed << ": " << column << "," << row;
          if (change == Change::Dearer) {
            ASSERT_GE(bound(cell), trial.before.atLeast(cell)) << seed;
          }
          gained += trial.anew.units({column, row}) < trial.before.atLeast(cell);
        }
    }
  EXPECT_GT(held, 200);
  EXPECT_GT(gained, 10'000);
}

// An opened wall connects ground to the goal that was not connected before: the old field is no bound there.
TEST(PatchBound, InvalidBoundIsReported) {
  const std::vector<std::string> walled(11, ".....#.....");
  auto opened = walled;
  opened[5] = "...........";
  const auto map = drawn(walled), newer = drawn(opened);
  const Trial trial(map, newer, {{5, 5}, {5, 5}}, {{.cell = {0, 5}}}, {10, 5}, true);
  EXPECT_FALSE(PatchBound(trial.before, trial.box).holds());
}

}  // namespace patch_bound_test
}  // namespace talus::planner
