#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include <talus/planner/field/edge_layer.hpp>
#include <talus/planner/route/large_array.hpp>

namespace talus::planner {

/// Cell from which the field is computed, and the remaining cost from the cell's centre to the goal.
struct FieldGoal {
  maps::Cell cell;
  double cost_J = 0.0;  ///< >= 0; values above EdgeLayer::kBlocked units are clamped

  friend bool operator==(const FieldGoal&, const FieldGoal&) = default;
};

/// Cost-to-go field: the minimum cost over the grid's eight headings from every cell to the nearest goal,
/// with ascent and descent distinguished. Cells are settled from the goals outwards, only as far as needed; a
/// later call continues from there. Exact in the units of EdgeUnits, so the result does not depend on the
/// order of work. Not thread-safe.
class CostToGo {
 public:
  static constexpr std::uint32_t kUnreached = std::numeric_limits<std::uint32_t>::max();

  /// A goal's padded index and the remaining cost at the goal in units.
  struct Goal {
    std::uint32_t index;
    std::uint32_t units;
  };

  CostToGo(std::shared_ptr<const EdgeLayer> edges, const std::vector<FieldGoal>& goals,
           Kernels kernels = Kernels::Best);

  /// Settles until the cell's value is final or the cell is known to be unreachable. Returns false when
  /// stopped before.
  bool settle(maps::Cell until, const StopCheck& stop = {});

  /// Settles every cell from which a goal can be reached. Returns false when stopped before.
  bool settleAll(const StopCheck& stop = {});

  /// Updates the field after the edge layer was updated for cells of this box. The result equals that of a
  /// new search. Cells nearer to the goal than any cell of the box keep their values; the others are settled
  /// again when needed. For a single start, PatchedField needs less work.
  void repair(CellBox changed);

  /// Returns the cost from the cell's centre to a goal's centre in units; kUnreached if there is no path.
  /// Final for settled cells.
  std::uint32_t units(maps::Cell cell) const noexcept { return distance_[edges_->padded().index(cell)]; }

  /// Returns units() in joules; empty if there is no path.
  std::optional<double> cost_J(maps::Cell cell) const noexcept;

  /// Returns a lower bound of the minimum cost from a padded index in units, whether settled or not;
  /// kUnreached if no path exists.
  std::uint32_t atLeast(std::size_t index) const noexcept {
    const std::uint64_t front = current_ << shift_;
    return distance_[index] < front || queued_ == 0 ? distance_[index] : static_cast<std::uint32_t>(front);
  }

  /// Lowest remaining cost of the goals in this cell in units; kUnreached if the cell is no goal.
  std::uint32_t atGoal(std::size_t index) const noexcept;

  /// Goals of the field. A cell may occur more than once.
  const std::vector<Goal>& goals() const noexcept { return goals_; }

  /// Returns the cells of the cheapest path from a settled cell to a goal, both included; empty if there is
  /// no path.
  std::vector<maps::Cell> path(maps::Cell from) const;

  /// Returns the number of settled cells.
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
  std::vector<Bucket> buckets_;         // ring; each bucket holds the indices of cells of similar distance
  std::uint64_t current_ = 0;           // current bucket, counted without wrapping
  std::uint64_t queued_ = 0;            // entries in all buckets
  std::uint64_t settled_ = 0;
  std::vector<Goal> goals_;
  bool vectors_ = false;
  unsigned shift_ = 0;  // log2 of a bucket's width in units
};

}  // namespace talus::planner
