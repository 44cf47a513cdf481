#include <random>

#include <talus/planner/field/patch_bound.hpp>
#include <talus/planner/field/patched_field.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace {

using maps::Cell;
using testing::drawn;
using testing::randomMap;
using MapPointer = std::shared_ptr<const costmap::CostGrid>;

constexpr std::uint64_t kAll = 1'000'000'000;

// Random numbers below a limit.
class Below {
 public:
  explicit Below(unsigned seed) : random_(seed) {}
  int operator()(int limit) { return static_cast<int>(random_() % static_cast<unsigned>(limit)); }

 private:
  std::mt19937 random_;
};

// How a patch changes: every cell anew, or each cell's soil cheaper, dearer or either.
enum class Change { Anew, Cheaper, Dearer, Either };

MapPointer changed(const MapPointer& map, CellBox box, Change change, Below& below) {
  maps::Raster<costmap::CellCode> cells(map->grid());
  for (int row = 0; row < map->grid().height; ++row)
    for (int column = 0; column < map->grid().width; ++column) {
      costmap::CellCode& cell = cells[{column, row}];
      cell = map->at({column, row});
      if (column < box.first.column || column > box.last.column || row < box.first.row || row > box.last.row)
        continue;
      costmap::CellCode::Parts parts{.dz_dx = cell.dzDx(), .dz_dy = cell.dzDy(), .curve = cell.curve()};
      const int step = change == Change::Cheaper ? -1 : change == Change::Dearer ? 1 : below(3) - 1;
      if (parts.curve < 5) parts.curve = static_cast<std::uint8_t>(std::clamp(parts.curve + step, 0, 4));
      if (change == Change::Anew)
        parts = {0.004 * below(100) - 0.2, 0.1, static_cast<std::uint8_t>(below(4) == 0 ? 255 : below(5))};
      cell = costmap::CellCode(parts);
    }
  return std::make_shared<costmap::CostGrid>(costmap::flattened(cells, map->content().cost));
}

struct Trial {
  std::shared_ptr<EdgeLayer> edges;
  CostToGo before;
  CostToGo anew;
  CellBox box;
  Cell start;

  Trial(const MapPointer& map, const MapPointer& newer, CellBox changed_box,
        const std::vector<FieldGoal>& goals, Cell from, bool whole)
      : edges(std::make_shared<EdgeLayer>(map, EdgeUnits(map->cost(), 1.0))),
        before(edges, goals),
        anew(std::make_shared<EdgeLayer>(newer, edges->units()), goals),
        box(changed_box),
        start(from) {
    whole ? before.settleAll() : before.settle(from);
    edges->update(newer, edges->units(), box);
    anew.settleAll();
  }
};

Trial randomTrial(unsigned seed, Change change) {
  Below below(seed);
  const auto map = randomMap(
      {.width = 70, .height = 60, .seed = seed, .blocked = 0.02 * below(10), .roughness = 0.05 * below(5)});
  const Cell first{below(40), below(30)};
  const CellBox box{first, {first.column + below(30), first.row + below(30)}};
  std::vector<FieldGoal> goals{{.cell = {below(70), below(60)}}};
  for (int k = below(3); k > 0; --k)
    goals.push_back({.cell = {below(70), below(60)}, .cost_J = 3.0 * below(9)});
  const Cell start{below(70), below(60)};
  return Trial(map, changed(map, box, change, below), box, goals, start, below(2) == 0);
}

// Property: the bound is never above the field found anew, at any cell; and where nothing became cheaper it
// is not below the old field, which is what keeps the search narrow.
TEST(PatchBound, NeverAboveTheNewField) {
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

// Property: however a patch changes, the distance of the start and the path from it, byte for byte, are those
// of the field found anew, or both have no way.
TEST(PatchedField, IsTheFieldFoundAnew) {
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

// Property: of several links the cheapest is the one that the field found anew names, with the same cost.
TEST(PatchedField, BestOfSeveralLinks) {
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

TEST(PatchedField, GivesUpAfterSoManyCellsAndWhenStopped) {
  const Trial trial = randomTrial(4, Change::Dearer);
  PatchedField field(trial.before, trial.box);
  EXPECT_EQ(field.settle({{trial.start, 0.0}}, 1), PatchedField::Outcome::TooMuch);
  std::stop_source source;
  source.request_stop();
  EXPECT_EQ(
      field.settle({{trial.start, 0.0}}, kAll, ProgressMonitor{.progress = {}, .stop = source.get_token()}),
      PatchedField::Outcome::Stopped);
}

// A wall that opens lets ground reach the goal that could not before: the old field bounds nothing there.
TEST(PatchBound, SaysWhenItDoesNotHold) {
  const std::vector<std::string> walled(11, ".....#.....");
  auto opened = walled;
  opened[5] = "...........";
  const auto map = drawn(walled), newer = drawn(opened);
  const Trial trial(map, newer, {{5, 5}, {5, 5}}, {{.cell = {0, 5}}}, {10, 5}, true);
  EXPECT_FALSE(PatchBound(trial.before, trial.box).holds());
}

}  // namespace
}  // namespace talus::planner
