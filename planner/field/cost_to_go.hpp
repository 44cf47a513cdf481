#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include <talus/planner/field/edge_layer.hpp>
#include <talus/planner/route/kernels.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::planner {

/// Priority queue of indices with integer keys, sorted into buckets of 2^shift consecutive keys. Buckets are
/// taken in increasing order, indices of one bucket in the order of insertion. The buckets form a ring of
/// limited length: an index with a key beyond the ring is taken too early, and an index with a key below the
/// current bucket is taken next. Therefore the caller must look up the true key of each index that is taken.
class BucketQueue {
 public:
  /// `shift` is the binary logarithm of the bucket width, `reach` the largest difference of two queued keys.
  BucketQueue(unsigned shift, std::uint64_t reach)
      : shift_(shift), ring_(std::bit_ceil((reach >> shift) + 2)) {}

  /// Returns the index of the bucket of a key.
  std::uint64_t bucketOf(std::uint64_t key) const noexcept { return key >> shift_; }

  /// Returns the index of the current bucket.
  std::uint64_t current() const noexcept { return current_; }

  /// Returns the number of queued indices.
  std::uint64_t queued() const noexcept { return queued_; }

  /// Sets the current bucket to the bucket of `key`.
  void startAt(std::uint64_t key) noexcept { current_ = bucketOf(key); }

  /// Adds an index with a key.
  void push(std::uint64_t key, std::uint32_t index) {
    const std::uint64_t bucket = std::clamp(bucketOf(key), current_, current_ + ring_.size() - 1);
    ring_[bucket & (ring_.size() - 1)].push_back(index);
    ++queued_;
  }

  /// Calls take(index) for every queued index, including the indices that take() adds, as long as more(first
  /// key of the bucket) returns true.
  template <typename Take, typename More>
  void run(Take take, More more) {
    for (; queued_ > 0 && more(current_ << shift_); ++current_) {
      auto& bucket = ring_[current_ & (ring_.size() - 1)];
      for (std::size_t i = 0; i < bucket.size(); ++i) take(bucket[i]);
      queued_ -= bucket.size();
      bucket.clear();
    }
  }

 private:
  unsigned shift_;
  std::vector<std::vector<std::uint32_t>> ring_;
  std::uint64_t current_ = 0, queued_ = 0;
};

/// Goal of a cost-to-go field: a cell, and the remaining cost from its centre to the goal of the problem.
struct FieldGoal {
  maps::Cell cell;
  double cost_J = 0.0;  ///< remaining cost, >= 0; values above EdgeLayer::kBlocked units are clamped

  friend bool operator==(const FieldGoal&, const FieldGoal&) = default;
};

/// Cost-to-go field: for every cell, the minimum cost of a path to the nearest goal that leads from cell
/// centre to cell centre in the eight headings of the grid. Ascent and descent have different costs. A cell
/// is settled when its final value is known. Cells are settled from the goals outwards, only as far as
/// needed; a later call continues from there. Costs are integer multiples of the unit of EdgeUnits; therefore
/// the result is exact and does not depend on the order of computation. Not thread-safe.
class CostToGo {
 public:
  /// Value of a cell from which no goal can be reached, or that the computation has not reached yet.
  static constexpr std::uint32_t kUnreached = std::numeric_limits<std::uint32_t>::max();

  /// Goal by its padded index (index in PaddedGrid), and the remaining cost at the goal in units.
  struct Goal {
    std::uint32_t index;
    std::uint32_t units;
  };

  /// `edges` are the costs of all steps between neighbouring cells. No cell is settled at construction.
  CostToGo(std::shared_ptr<const EdgeLayer> edges, const std::vector<FieldGoal>& goals,
           Kernels kernels = Kernels::Best);

  /// Settles cells until `until` is settled or no goal can be reached from it. Returns false if a stop ended
  /// the computation earlier.
  bool settle(maps::Cell until, const StopCheck& stop = {});

  /// Settles every cell from which a goal can be reached. Returns false if a stop ended the computation
  /// earlier.
  bool settleAll(const StopCheck& stop = {});

  /// Updates the field after the edge layer was updated for the cells of the box `changed`. The result
  /// equals that of a new computation. Cells that are nearer to the goal than all cells of the box keep their
  /// values; the other cells are settled again when needed.
  void repair(CellBox changed);

  /// Returns the cost from the centre of a cell to the goal in units; kUnreached if there is no path. The
  /// value is final for settled cells.
  std::uint32_t units(maps::Cell cell) const noexcept { return distance_[edges_->padded().index(cell)]; }

  /// Returns units() converted to joules; empty if there is no path.
  std::optional<double> cost_J(maps::Cell cell) const noexcept;

  /// Returns the lowest remaining cost, in units, of the goals in the cell with a padded index; kUnreached if
  /// the cell is not a goal.
  std::uint32_t atGoal(std::size_t index) const noexcept;

  /// Returns the goals of the field. A cell may occur more than once.
  const std::vector<Goal>& goals() const noexcept { return goals_; }

  /// Returns the cells of the cheapest path from a settled cell to a goal, including both; empty if there is
  /// no path. Of equally cheap paths, the first in the order of headings is returned.
  std::vector<maps::Cell> path(maps::Cell from) const;

  /// Returns the number of settled cells.
  std::uint64_t settled() const noexcept { return settled_; }

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
  LargeArray<std::uint32_t> distance_;  // cost to the goal in units, by padded index
  std::vector<Bucket> buckets_;         // ring; each bucket holds the indices of cells of similar cost
  std::uint64_t current_ = 0;           // number of the current bucket, without wrapping
  std::uint64_t queued_ = 0;            // number of entries in all buckets
  std::uint64_t settled_ = 0;
  std::vector<Goal> goals_;
  bool vectors_ = false;
  unsigned shift_ = 0;  // binary logarithm of the bucket width in units
};

/// Link of a point to the grid: a cell, and the cost of the straight motion between the point and the cell
/// centre.
struct GridLink {
  maps::Cell cell;
  double cost_J = 0.0;
};

/// Returns the links from `place` to the centres of its cell and of the eight neighbours of this cell, for
/// the straight motions that are allowed.
std::vector<GridLink> linksFrom(const MotionCost& cost, maps::Point place);

/// Returns the links to `place` from the centres of its cell and of the eight neighbours of this cell, for
/// the straight motions that are allowed.
std::vector<GridLink> linksTo(const MotionCost& cost, maps::Point place);

/// Returns the goals of the cost-to-go field for `goal`: the cells of linksTo(), and every cell that allows
/// some heading and has its centre within the tolerance of the goal, with remaining cost 0.
std::vector<FieldGoal> fieldGoals(const MotionCost& cost, maps::Point goal, double tolerance_m);

}  // namespace talus::planner
