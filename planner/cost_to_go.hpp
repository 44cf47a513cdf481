#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include <planner/edge_layer.hpp>
namespace talus::planner {

/// A cell where the field begins, and what is left to pay from its centre.
struct FieldGoal {
  maps::Cell cell;
  double cost_J = 0.0;  ///< >= 0; a few cells' worth at most

  friend bool operator==(const FieldGoal&, const FieldGoal&) = default;
};

/// What the best way along the grid's eight headings costs from every cell to the nearest of the goals,
/// climbing and descending told apart. Settled from the goals outwards, only as far as asked; asking further
/// goes on from there. Exact in the units of EdgeUnits, so the same whatever the order of work. One object
/// one thread at a time.
class CostToGo {
 public:
  static constexpr std::uint32_t kUnreached = std::numeric_limits<std::uint32_t>::max();

  CostToGo(std::shared_ptr<const EdgeLayer> edges, const std::vector<FieldGoal>& goals,
           Kernels kernels = Kernels::Best);

  /// Settles until the cell has its final value or cannot be reached; false when stopped before.
  bool settle(maps::Cell until, const StopCheck& stop = {});

  /// Settles every cell that can reach a goal; false when stopped before.
  bool settleAll(const StopCheck& stop = {});

  /// Takes in that the edge layer was updated for cells of this box: afterwards the field is the one that
  /// would be found anew. Only what depended on the change, or gains by it, is worked on
  /// [ramalingam_reps_1996].
  void repair(CellBox changed);

  /// Cost from the cell's centre to a goal's centre, in units; kUnreached when there is no way. Final for
  /// settled cells.
  std::uint32_t units(maps::Cell cell) const noexcept { return distance_[edges_->padded().index(cell)]; }

  /// The same in joules; nothing when there is no way.
  std::optional<double> cost_J(maps::Cell cell) const noexcept;

  /// Cells of the best way from a settled cell to a goal, both included; empty when there is none.
  std::vector<maps::Cell> path(maps::Cell from) const;

  /// Cells settled so far.
  std::uint64_t settled() const noexcept { return settled_; }

  const EdgeLayer& edges() const noexcept { return *edges_; }

 private:
  using Bucket = std::vector<std::uint32_t>;

  bool settleBucketsUntil(std::uint32_t index, const StopCheck& stop);
  void settleBelow(std::uint64_t bucket);
  void settleCurrent();
  struct Seed {
    std::uint32_t distance;
    std::uint32_t index;
  };
  static bool fartherFirst(Seed a, Seed b) noexcept { return a.distance > b.distance; }

  std::vector<Seed> cellsThatLostTheirWay(const std::vector<std::uint32_t>& suspects);
  bool supported(std::size_t index) const noexcept;
  std::uint32_t throughNeighbours(std::size_t index) const noexcept;
  void plant(std::vector<Seed> seeds);
  bool feed(std::uint64_t below);
  bool endsAt(std::size_t index) const noexcept;
  template <typename Improved>
  void settleBucket(Bucket& bucket, Improved improved);
  void prefetch(std::size_t cell, std::ptrdiff_t stride) const noexcept;

  std::shared_ptr<const EdgeLayer> edges_;
  std::vector<std::uint32_t> distance_;  // padded, units
  std::vector<Bucket> buckets_;          // a ring; each holds indices of cells of like distance
  std::vector<Seed> seeds_;              // of a repair, farthest first: wait for their bucket
  std::uint64_t current_ = 0;            // bucket whose turn it is, counted without wrapping
  std::uint64_t queued_ = 0;             // entries in all buckets
  std::uint64_t settled_ = 0;
  std::vector<std::uint32_t> goals_;     // padded indices
  std::vector<std::uint32_t> at_goals_;  // distances there at the beginning
  bool vectors_ = false;
  unsigned shift_ = 0;  // log2 of a bucket's width in units
};

}  // namespace talus::planner
