#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <new>
#include <queue>
#include <utility>

#include <talus/planner/field/bucket_queue.hpp>
#include <talus/planner/field/descent.hpp>
#include <talus/planner/field/patch_bound.hpp>
#include <talus/planner/field/patched_field.hpp>

namespace talus::planner {
namespace {

// [units] Links have costs in joules; rounding may change the order of paths whose costs differ by this much.
constexpr std::uint32_t kSlack = 1;

// Cost from the start [units] by cell index; the largest uint32 until set. Memory pages are allocated only
// when written.
class SparseCosts {
 public:
  explicit SparseCosts(std::size_t cells)
      : below_(static_cast<std::uint32_t*>(std::calloc(cells, sizeof(std::uint32_t))), std::free) {
    if (!below_) throw std::bad_alloc();
  }
  std::uint32_t operator[](std::size_t cell) const noexcept { return ~below_.get()[cell]; }
  void set(std::size_t cell, std::uint32_t units) noexcept { below_.get()[cell] = ~units; }

 private:
  std::unique_ptr<std::uint32_t[], decltype(&std::free)> below_;  // CostToGo::kUnreached minus the cost
};

// A* from the links to the goals.
class ForwardSearch {
 public:
  ForwardSearch(const CostToGo& before, const PatchBound& bound)
      : edges_(before.edges()),
        bound_(bound),
        cost_(edges_.padded().size()),
        taken_(edges_.padded().size()),
        queue_(static_cast<unsigned>(std::bit_width(edges_.units().cheapestEdge()) - 1),
               EdgeLayer::kBlocked) {
    for (const CostToGo::Goal goal : before.goals()) {
      const auto [known, is_new] = at_goal_.try_emplace(goal.index, goal.units);
      if (!is_new) known->second = std::min(known->second, goal.units);
    }
  }

  PatchedField::Outcome run(const std::vector<GridLink>& links, std::uint64_t most_cells,
                            const StopCheck& stop);

  /// Returns the cost to the goal [units] by padded index, for each cell on a path from start to goal that
  /// costs at most kSlack more than the best path.
  std::unordered_map<std::uint32_t, std::uint32_t> bestWays() const;

 private:
  void begin(const std::vector<GridLink>& links);
  void reach(std::uint32_t cell, std::uint32_t units);
  void take(std::uint32_t cell);

  const EdgeLayer& edges_;
  const PatchBound& bound_;
  std::unordered_map<std::uint32_t, std::uint32_t> at_goal_;
  SparseCosts cost_;
  std::vector<bool> taken_;  // at the present cost
  BucketQueue queue_;
  std::uint64_t looked_at_ = 0;
  std::uint32_t found_ = CostToGo::kUnreached;  // cost of the best path found
};

void ForwardSearch::begin(const std::vector<GridLink>& links) {
  std::uint64_t nearest = CostToGo::kUnreached;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> starts;
  for (const GridLink& link : links) {
    const auto cell = static_cast<std::uint32_t>(edges_.padded().index(link.cell));
    const auto units = static_cast<std::uint32_t>(std::floor(link.cost_J / edges_.units().unit_J()));
    starts.emplace_back(cell, units);
    nearest = std::min(nearest, std::uint64_t{units} + bound_(cell));
  }
  queue_.startAt(nearest);
  for (const auto& [cell, units] : starts) reach(cell, units);
}

void ForwardSearch::reach(std::uint32_t cell, std::uint32_t units) {
  if (units >= cost_[cell]) return;
  const std::uint32_t rest = bound_(cell);
  if (rest == CostToGo::kUnreached) return;
  cost_.set(cell, units);
  taken_[cell] = false;
  queue_.push(std::uint64_t{units} + rest, cell);
  if (rest > EdgeLayer::kBlocked) return;  // more than the remaining cost at any goal
  if (const auto goal = at_goal_.find(cell); goal != at_goal_.end())
    found_ = std::min(found_, units + goal->second);
}

void ForwardSearch::take(std::uint32_t cell) {
  if (taken_[cell]) return;
  const std::uint32_t here = cost_[cell];
  const std::uint64_t key = std::uint64_t{here} + bound_(cell);
  if (queue_.bucketOf(key) > queue_.current()) return queue_.push(key, cell);
  taken_[cell] = true;
  ++looked_at_;
  for (int heading = 0; heading < 8; ++heading) {
    const auto next = cell + static_cast<std::uint32_t>(edges_.padded().offset(heading));
    const std::uint16_t edge = edges_.into(next)[opposite(heading)];
    if (edge != EdgeLayer::kBlocked) reach(next, here + edge);
  }
}

PatchedField::Outcome ForwardSearch::run(const std::vector<GridLink>& links, std::uint64_t most_cells,
                                         const StopCheck& stop) {
  begin(links);
  bool stopped = false;
  queue_.run([this](std::uint32_t cell) { take(cell); },
             [&](std::uint64_t key) {
               stopped = stop();
               return !stopped && looked_at_ <= most_cells && key <= std::uint64_t{found_} + kSlack;
             });
  if (stopped) return PatchedField::Outcome::Stopped;
  return looked_at_ <= most_cells ? PatchedField::Outcome::Settled : PatchedField::Outcome::TooMuch;
}

std::unordered_map<std::uint32_t, std::uint32_t> ForwardSearch::bestWays() const {
  std::unordered_map<std::uint32_t, std::uint32_t> distance;
  using Entry = std::pair<std::uint32_t, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  const std::uint64_t most = std::uint64_t{found_} + kSlack;
  const auto reach = [&](std::uint32_t cell, std::uint32_t units) {
    if (cost_[cell] == CostToGo::kUnreached || std::uint64_t{cost_[cell]} + units > most) return;
    const auto [known, is_new] = distance.try_emplace(cell, units);
    if (!is_new && known->second <= units) return;
    known->second = units;
    open.emplace(units, cell);
  };
  for (const auto& [cell, units] : at_goal_) reach(cell, units);
  while (!open.empty()) {
    const auto [units, cell] = open.top();
    open.pop();
    if (distance.at(cell) < units) continue;
    const std::uint16_t* into = edges_.into(cell);
    for (int heading = 0; heading < 8; ++heading)
      if (into[heading] != EdgeLayer::kBlocked)
        reach(cell + static_cast<std::uint32_t>(edges_.padded().offset(heading)), units + into[heading]);
  }
  return distance;
}

}  // namespace

PatchedField::Outcome PatchedField::settle(const std::vector<GridLink>& links, std::uint64_t most_cells,
                                           const StopCheck& stop) {
  const PatchBound bound(before_, changed_);
  if (!bound.holds()) return Outcome::TooMuch;
  ForwardSearch search(before_, bound);
  const Outcome outcome = search.run(links, most_cells, stop);
  if (outcome == Outcome::Settled) distance_ = search.bestWays();
  return outcome;
}

std::uint32_t PatchedField::distance(std::size_t index) const {
  const auto known = distance_.find(static_cast<std::uint32_t>(index));
  return known == distance_.end() ? CostToGo::kUnreached : known->second;
}

std::optional<double> PatchedField::cost_J(maps::Cell cell) const {
  const std::uint32_t found = distance(before_.edges().padded().index(cell));
  if (found == CostToGo::kUnreached) return std::nullopt;
  return found * before_.edges().units().unit_J();
}

std::vector<maps::Cell> PatchedField::path(maps::Cell from) const {
  return descent(
      before_.edges(), from, [this](std::size_t index) { return distance(index); },
      [this](std::size_t index) { return before_.atGoal(index); });
}

}  // namespace talus::planner
