#include <algorithm>
#include <bit>
#include <cstdlib>

#include <talus/planner/field/bucket_queue.hpp>
#include <talus/planner/field/patch_bound.hpp>

namespace talus::planner {
namespace {

using maps::Cell;

constexpr std::uint32_t kUnreached = CostToGo::kUnreached;

}  // namespace

PatchBound::PatchBound(const CostToGo& before, CellBox changed)
    : before_(before),
      box_(grown(changed, 1, before.edges().padded())),
      columns_(static_cast<std::size_t>(box_.last.column - box_.first.column + 1)),
      first_index_(before.edges().padded().index(box_.first)),
      last_index_(before.edges().padded().index(box_.last)),
      inside_(columns_ * static_cast<std::size_t>(box_.last.row - box_.first.row + 1), kUnreached) {
  const auto cells = rim();
  settleInwards(cells);
  for (const RimCell& cell : cells) {
    const std::uint32_t now = inside_[local(cell.cell)];
    if (now >= cell.before) continue;
    holds_ = holds_ && cell.before != kUnreached;
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

// The least that a way outside the box costs between two cells of its rim.
std::uint32_t PatchBound::excursion(const RimCell& from, const RimCell& to) const noexcept {
  const auto steps = static_cast<std::uint32_t>(
      std::max(std::abs(from.cell.column - to.cell.column), std::abs(from.cell.row - to.cell.row)));
  const std::uint32_t straight = steps * before_.edges().units().cheapestEdge();
  const bool drop_known = to.exact && from.before > to.before;
  return drop_known ? std::max(straight, from.before - to.before) : straight;
}

void PatchBound::settleInwards(const std::vector<RimCell>& rim) {
  const EdgeLayer& edges = before_.edges();
  const PaddedGrid& padded = edges.padded();
  BucketQueue queue(static_cast<unsigned>(std::bit_width(edges.units().cheapestEdge()) - 1),
                    EdgeLayer::kBlocked);
  std::vector<const RimCell*> on_rim(inside_.size(), nullptr);
  const auto reach = [&](Cell c, std::uint32_t units) {
    std::uint32_t& present = inside_[local(c)];
    if (units >= present) return;
    present = units;
    queue.push(units, static_cast<std::uint32_t>(local(c)));
  };
  for (const RimCell& cell : rim) on_rim[local(cell.cell)] = &cell;
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
        if (queue.bucketOf(here) < queue.current()) return;
        const Cell cell{box_.first.column + static_cast<int>(at % columns_),
                        box_.first.row + static_cast<int>(at / columns_)};
        const std::uint16_t* into = edges.into(padded.index(cell));
        for (std::size_t k = 0; k < 8; ++k) {
          const Cell from{cell.column + kStep[k].column, cell.row + kStep[k].row};
          if (into[k] != EdgeLayer::kBlocked && contains(from)) reach(from, here + into[k]);
        }
        if (const RimCell* own = on_rim[at]; own && here < own->before)
          for (const RimCell& other : rim)
            if (&other != own && other.before != kUnreached) reach(other.cell, here + excursion(other, *own));
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
  if (gain_ == 0 || before == kUnreached) return before;
  return std::max(std::min(before, least_), before - std::min(before, gain_));
}

}  // namespace talus::planner
