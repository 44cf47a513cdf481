// Repairs a field after edges changed: resets the field to its state when the first changed cell was reached.
#include <algorithm>

#include <talus/planner/field/cost_to_go.hpp>

namespace talus::planner {

// Returns the smallest distance of any cell with a changed step. The paths of nearer cells contain no changed
// step, neither before nor after the change, because the last cell with a changed step leaves by an unchanged
// step.
std::uint32_t CostToGo::leastTouched(CellBox changed) const noexcept {
  const PaddedGrid& padded = edges_->padded();
  const CellBox box = grown(changed, 1, padded);
  std::uint32_t least = kUnreached;
  for (int row = box.first.row; row <= box.last.row; ++row)
    for (int column = box.first.column; column <= box.last.column; ++column)
      least = std::min(least, units({column, row}));
  return least;
}

void CostToGo::repair(CellBox changed) {
  const std::uint64_t front = queued_ > 0 ? current_ << shift_ : kUnreached;
  const std::uint64_t stays = std::min<std::uint64_t>(leastTouched(changed), front);
  if (stays == kUnreached) return;
  for (Bucket& bucket : buckets_) bucket.clear();
  queued_ = settled_ = 0;
  // Cells that keep their values but have steps to reset cells are processed again.
  const std::uint64_t again = stays - std::min<std::uint64_t>(stays, EdgeLayer::kBlocked);
  current_ = again >> shift_;
  for (std::size_t cell = 0; cell < edges_->padded().size(); ++cell) {
    if (distance_[cell] >= stays) distance_[cell] = kUnreached;
    if (distance_[cell] >> shift_ < current_)
      ++settled_;
    else if (distance_[cell] != kUnreached)
      enqueue(cell);
  }
  seedGoals();
}

}  // namespace talus::planner
