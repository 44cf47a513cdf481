#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include <talus/planner/field/edge_layer.hpp>
#include <talus/planner/route/large_array.hpp>

namespace talus::planner {

/// A cell where the field begins, and what is left to pay from its centre.
struct FieldGoal {
  maps::Cell cell;
  double cost_J = 0.0;  ///< >= 0; a few cells' worth at most

  friend bool operator==(const FieldGoal&, const FieldGoal&) = default;
};

/// What the best way along the grid's eight headings costs from every cell to the nearest of the goals,
/// climbing and descending distinguished. Settled from the goals outwards, only as far as needed; going
/// further goes on from there. Exact in the units of EdgeUnits, so the same whatever the order of work. One
/// object one thread at a time.
class CostToGo {
 public:
  static constexpr std::uint32_t kUnreached = std::numeric_limits<std::uint32_t>::max();

  /// A goal by padded index, and what is left to pay there in units.
  struct Goal {
    std::uint32_t index;
    std::uint32_t units;
  };

  CostToGo(std::shared_ptr<const EdgeLayer> edges, const std::vector<FieldGoal>& goals,
           Kernels kernels = Kernels::Best);

  /// Settles until the cell has its final value or cannot be reached; false when stopped before.
  bool settle(maps::Cell until, const StopCheck& stop = {});

  /// Settles every cell that can reach a goal; false when stopped before.
  bool settleAll(const StopCheck& stop = {});

  /// Takes in that the edge layer was updated for cells of this box: afterwards the field is the one that
  /// would be found by a new search. What is nearer to the goal than anything in the box stays; the rest is
  /// settled again when it is needed. PatchedField serves one start with less work.
  void repair(CellBox changed);

  /// Cost from the cell's centre to a goal's centre, in units; kUnreached when there is no way. Final for
  /// settled cells.
  std::uint32_t units(maps::Cell cell) const noexcept { return distance_[edges_->padded().index(cell)]; }

  /// The same in joules; nothing when there is no way.
  std::optional<double> cost_J(maps::Cell cell) const noexcept;

  /// No more than the cost of the best way from a padded index, in units, whether it is settled or not;
  /// kUnreached where there is surely no way.
  std::uint32_t atLeast(std::size_t index) const noexcept {
    const std::uint64_t front = current_ << shift_;
    return distance_[index] < front || queued_ == 0 ? distance_[index] : static_cast<std::uint32_t>(front);
  }

  /// The least left to pay at a goal in this cell, in units; kUnreached where no goal is.
  std::uint32_t atGoal(std::size_t index) const noexcept;

  /// Where the field begins; a cell may stand there more than once.
  const std::vector<Goal>& goals() const noexcept { return goals_; }

  /// Cells of the best way from a settled cell to a goal, both included; empty when there is none.
  std::vector<maps::Cell> path(maps::Cell from) const;

  /// Cells settled so far.
  std::uint64_t settled() const noexcept { return settled_; }

  const EdgeLayer& edges() const noexcept { return *edges_; }

 private:
  using Bucket = std::vector<std::uint32_t>;

  bool settleBucketsUntil(std::uint32_t index, const StopCheck& stop);
  void settleCurrent();
  std::uint32_t leastTouched(CellBox changed) const noexcept;
  void enqueue(std::size_t cell);
  void seedGoals();
  template <typename Improved>
  void settleBucket(Bucket& bucket);
  void settleByVector(Bucket& bucket);

  std::shared_ptr<const EdgeLayer> edges_;
  LargeArray<std::uint32_t> distance_;  // padded, units
  std::vector<Bucket> buckets_;         // a ring; each holds indices of cells of like distance
  std::uint64_t current_ = 0;           // bucket whose turn it is, counted without wrapping
  std::uint64_t queued_ = 0;            // entries in all buckets
  std::uint64_t settled_ = 0;
  std::vector<Goal> goals_;
  bool vectors_ = false;
  unsigned shift_ = 0;  // log2 of a bucket's width in units
};

}  // namespace talus::planner
