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
};

/// What the best way along the grid's eight headings costs from every cell to the nearest of the goals,
/// climbing and descending told apart. Settled from the goals outwards, only as far as asked; asking further
/// goes on from there. Exact in the units of EdgeUnits, so the same whatever the order of work. One object
/// one thread at a time.
class CostToGo {
 public:
  static constexpr std::uint32_t kUnreached = std::numeric_limits<std::uint32_t>::max();

  CostToGo(std::shared_ptr<const EdgeLayer> edges, const std::vector<FieldGoal>& goals);

  /// Settles until the cell has its final value or cannot be reached; false when stopped before.
  bool settle(maps::Cell until, const StopCheck& stop = {});

  /// Settles every cell that can reach a goal; false when stopped before.
  bool settleAll(const StopCheck& stop = {});

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
  bool settleBucketsUntil(std::uint32_t index, const StopCheck& stop);
  bool endsAt(std::size_t index) const noexcept;
  void settleBucket(std::vector<std::uint32_t>& bucket);

  std::shared_ptr<const EdgeLayer> edges_;
  std::vector<std::uint32_t> distance_;              // padded, units
  std::vector<std::vector<std::uint32_t>> buckets_;  // a ring; each holds indices of cells of like distance
  std::uint64_t current_ = 0;                        // bucket whose turn it is, counted without wrapping
  std::uint64_t queued_ = 0;                         // entries in all buckets
  std::uint64_t settled_ = 0;
  std::vector<std::uint32_t> goals_;     // padded indices
  std::vector<std::uint32_t> at_goals_;  // distances there at the beginning
  unsigned shift_ = 0;                   // log2 of a bucket's width in units
};

}  // namespace talus::planner
