#include <talus/common/common.hpp>
#include <talus/planner/field/patched_field.hpp>

#include "changed_map.hpp"

namespace talus::planner {
namespace patched_field_test {

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

constexpr std::uint64_t kAll = 1'000'000'000;

// Property: for any change of a patch, the cost at the start and the path from it are byte-identical to
// those of the recomputed field, or neither field has a path.
TEST(PatchedField, PatchedFieldEqualsTheRecomputedField) {
  int compared = 0, without_way = 0, moved = 0;
  for (const Change change : {Change::Anew, Change::Cheaper, Change::Dearer, Change::Either})
    for (unsigned seed = 1; seed <= 100; ++seed) {
      const Trial trial = randomTrial(seed, change);
      PatchedField field(trial.before, trial.box);
      const auto outcome = field.settle({{trial.start, 0.0}}, kAll);
      if (outcome == PatchedField::Outcome::TooMuch) continue;
      ASSERT_EQ(field.cost_J(trial.start), trial.anew.cost_J(trial.start)) << seed;
      ASSERT_EQ(field.path(trial.start), trial.anew.path(trial.start)) << seed;
      ++compared;
      without_way += !trial.anew.cost_J(trial.start);
      moved += trial.anew.cost_J(trial.start) != trial.before.cost_J(trial.start);
    }
  EXPECT_GT(compared, 350);
  EXPECT_GT(without_way, 10);
  EXPECT_GT(moved, 50);
}

TEST(PatchedField, StopsAtCellLimitAndOnRequest) {
  const Trial trial = randomTrial(4, Change::Dearer);
  PatchedField field(trial.before, trial.box);
  EXPECT_EQ(field.settle({{trial.start, 0.0}}, 1), PatchedField::Outcome::TooMuch);
  std::stop_source source;
  source.request_stop();
  EXPECT_EQ(
      field.settle({{trial.start, 0.0}}, kAll, ProgressMonitor{.progress = {}, .stop = source.get_token()}),
      PatchedField::Outcome::Stopped);
}

}  // namespace patched_field_test
}  // namespace talus::planner
