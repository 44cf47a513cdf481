#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <new>
#include <queue>
#include <utility>

#include <talus/planner/field/cost_to_go.hpp>
#include <talus/planner/field/edge_layer.hpp>
#include <talus/planner/field/patched_field.hpp>

namespace talus::planner {
namespace {

using maps::Cell;

// Computes lower bounds [units] of the cost of a path that leaves the box at one rim cell and enters the box
// at another. Each quantity has its own array, because to() compares an improved rim cell with all rim cells.
class RimDetours {
 public:
  RimDetours(std::size_t cells, std::uint32_t cheapest) : cheapest_(cheapest) {
    for (auto* values : {&column_, &row_}) values->reserve(cells);
    for (auto* values : {&before_, &now_}) values->reserve(cells);
  }

  void add(Cell cell, std::uint32_t before) {
    column_.push_back(cell.column);
    row_.push_back(cell.row);
    before_.push_back(before);
    now_.push_back(CostToGo::kUnreached);
  }

  // Sets the improved cost of rim cell k.
  void set(std::size_t k, std::uint32_t units) { now_[k] = units; }

  // Calls reach(k, units) for each rim cell k whose cost decreases by a path outside the box to rim cell
  // `to`, which lies `here` units from the goal. If `exact`, the old cost of `to` is known and the difference
  // of the old costs is also a lower bound of the path.
  template <typename Reach>
  void to(std::size_t to, std::uint32_t here, bool exact, Reach reach) const {
    const int column = column_[to], row = row_[to];
    const std::uint32_t level = exact ? before_[to] : CostToGo::kUnreached;
    for (std::size_t k = 0; k < now_.size(); ++k) {
      const auto steps =
          static_cast<std::uint32_t>(std::max(std::abs(column_[k] - column), std::abs(row_[k] - row)));
      const std::uint32_t drop = before_[k] - std::min(before_[k], level);
      const std::uint32_t units = here + std::max(steps * cheapest_, drop);
      if (units < now_[k] && before_[k] != CostToGo::kUnreached) reach(k, units);
    }
  }

 private:
  std::uint32_t cheapest_;
  std::vector<int> column_, row_;
  std::vector<std::uint32_t> before_, now_;
};

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

PatchBound::PatchBound(const CostToGo& before, CellBox changed)
    : before_(before),
      box_(grown(changed, 1, before.edges().padded())),
      columns_(static_cast<std::size_t>(box_.last.column - box_.first.column + 1)),
      first_index_(before.edges().padded().index(box_.first)),
      last_index_(before.edges().padded().index(box_.last)),
      inside_(columns_ * static_cast<std::size_t>(box_.last.row - box_.first.row + 1), CostToGo::kUnreached) {
  const auto cells = rim();
  settleInwards(cells);
  for (const RimCell& cell : cells) {
    const std::uint32_t now = inside_[local(cell.cell)];
    if (now >= cell.before) continue;
    holds_ = holds_ && cell.before != CostToGo::kUnreached;
    gain_ = std::max(gain_, cell.before - now);
    least_ = std::min(least_, now);
  }
}

std::vector<PatchBound::RimCell> PatchBound::rim() const {
  std::vector<RimCell> cells;
  const auto add = [&](Cell c) {
    const std::uint32_t at_least = before_.atLeast(before_.edges().padded().index(c));
    cells.push_back({c, at_least, at_least == before_.units(c)});
  };
  for (int column = box_.first.column; column <= box_.last.column; ++column) {
    add({column, box_.first.row});
    if (box_.last.row > box_.first.row) add({column, box_.last.row});
  }
  for (int row = box_.first.row + 1; row < box_.last.row; ++row) {
    add({box_.first.column, row});
    if (box_.last.column > box_.first.column) add({box_.last.column, row});
  }
  return cells;
}

void PatchBound::settleInwards(const std::vector<RimCell>& rim) {
  const EdgeLayer& edges = before_.edges();
  const PaddedGrid& padded = edges.padded();
  BucketQueue queue(static_cast<unsigned>(std::bit_width(edges.units().cheapestEdge()) - 1),
                    EdgeLayer::kBlocked);
  constexpr std::uint32_t kInner = CostToGo::kUnreached;
  std::vector<std::uint32_t> on_rim(inside_.size(), kInner);  // index of the rim cell; kInner inside
  // Cost [units] at which each cell was last processed, so that no queued cost is processed twice.
  std::vector<std::uint32_t> taken(inside_.size(), CostToGo::kUnreached);
  RimDetours excursions(rim.size(), edges.units().cheapestEdge());
  const auto reach = [&](Cell c, std::uint32_t units) {
    const std::size_t at = local(c);
    if (units >= inside_[at]) return;
    inside_[at] = units;
    if (on_rim[at] != kInner) excursions.set(on_rim[at], units);
    queue.push(units, static_cast<std::uint32_t>(at));
  };
  for (std::size_t k = 0; k < rim.size(); ++k) {
    on_rim[local(rim[k].cell)] = static_cast<std::uint32_t>(k);
    excursions.add(rim[k].cell, rim[k].before);
  }
  const auto contains = [&](Cell c) {
    return c.column >= box_.first.column && c.column <= box_.last.column && c.row >= box_.first.row &&
           c.row <= box_.last.row;
  };
  for (const RimCell& cell : rim) reach(cell.cell, cell.before);
  for (const CostToGo::Goal goal : before_.goals())
    if (contains(padded.cell(goal.index))) reach(padded.cell(goal.index), goal.units);
  queue.run(
      [&](std::uint32_t at) {
        const std::uint32_t here = inside_[at];
        if (queue.bucketOf(here) > queue.current()) return queue.push(here, at);
        if (queue.bucketOf(here) < queue.current() || taken[at] == here) return;
        taken[at] = here;
        const Cell cell{box_.first.column + static_cast<int>(at % columns_),
                        box_.first.row + static_cast<int>(at / columns_)};
        const std::uint16_t* into = edges.into(padded.index(cell));
        for (std::size_t k = 0; k < 8; ++k) {
          const Cell from{cell.column + kStep[k].column, cell.row + kStep[k].row};
          if (into[k] != EdgeLayer::kBlocked && contains(from)) reach(from, here + into[k]);
        }
        if (const std::uint32_t own = on_rim[at]; own != kInner && here < rim[own].before)
          excursions.to(own, here, rim[own].exact,
                        [&](std::size_t k, std::uint32_t units) { reach(rim[k].cell, units); });
      },
      [](std::uint64_t) { return true; });
}

std::uint32_t PatchBound::operator()(std::size_t index) const noexcept {
  if (index >= first_index_ && index <= last_index_) {
    const auto stride = static_cast<std::uint32_t>(before_.edges().padded().stride());
    const std::uint32_t column = static_cast<std::uint32_t>(index - first_index_) % stride;
    if (column < columns_)
      return inside_[static_cast<std::uint32_t>(index - first_index_) / stride * columns_ + column];
  }
  const std::uint32_t before = before_.atLeast(index);
  if (gain_ == 0 || before == CostToGo::kUnreached) return before;
  return std::max(std::min(before, least_), before - std::min(before, gain_));
}

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
