#include <algorithm>
#include <bit>
#include <cstdlib>

#include <talus/planner/field/bucket_queue.hpp>
#include <talus/planner/field/patch_bound.hpp>

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

}  // namespace talus::planner
