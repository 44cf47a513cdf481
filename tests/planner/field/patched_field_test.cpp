#include <talus/common/progress_monitor.hpp>
#include <talus/planner/field/patched_field.hpp>

#include "changed_map.hpp"

namespace talus::planner {
namespace patched_field_test {

using testing::Change;
using testing::randomTrial;
using testing::Trial;

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

// Property: of several links the patched field selects the same cheapest link, with the same cost, as the
// recomputed field.
TEST(PatchedField, CheapestLinkEqualsThatOfTheRecomputedField) {
  for (unsigned seed = 1; seed <= 100; ++seed) {
    const Trial trial = randomTrial(seed, Change::Either);
    std::vector<GridLink> links;
    for (int row = trial.start.row - 1; row <= trial.start.row + 1; ++row)
      for (int column = trial.start.column - 1; column <= trial.start.column + 1; ++column)
        if (trial.edges->map().grid().contains({column, row}))
          links.push_back({{column, row}, 0.37 * (row + column - trial.start.row - trial.start.column + 2)});
    PatchedField field(trial.before, trial.box);
    if (field.settle(links, kAll) != PatchedField::Outcome::Settled) continue;
    double best = std::numeric_limits<double>::infinity(), best_anew = best;
    for (const GridLink& link : links) {
      if (const auto rest = field.cost_J(link.cell)) best = std::min(best, link.cost_J + *rest);
      if (const auto rest = trial.anew.cost_J(link.cell))
        best_anew = std::min(best_anew, link.cost_J + *rest);
    }
    ASSERT_EQ(best, best_anew) << seed;
  }
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
