#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <talus/costmap/ground/category_table.hpp>
#include <talus/costmap/ground/ground_kind.hpp>
#include <talus/costmap/ground/ground_model.hpp>

namespace talus::costmap {

/// Table of the cost curves of a map, at most 254. A cost curve is the cost per metre over the gradient for
/// ground of one estimated strength. The table assigns an index (0 to 253) to each estimate. The indices 0 ..
/// classes-1 belong to the priors of the terrain classes. The curve of a prior is computed at the first call
/// of prior() for its class; before that call, it refuses every heading, i.e. has infinite cost. The
/// constructor computes the curve of the first class. An estimate from telemetry is quantised towards danger
/// (GroundKind) and receives an index at its first occurrence. If no index is free, the estimate receives the
/// first that exists of:
///   - the index of a class whose prior was not requested;
///   - the index of the strongest earlier estimate of the same classes that is no better in any quantity;
///   - CellCode::kBlocked, which refuses every heading.
/// A lack of indices therefore never reduces a cost. Not thread-safe.
class CostCurveTable {
 public:
  explicit CostCurveTable(std::shared_ptr<const GroundModel> model);

  /// Returns the index of the curve of a class's prior. priorBelief() returns the prior itself.
  std::uint8_t prior(int class_index);
  const GroundBelief& priorBelief(int class_index) const {
    return priors_[static_cast<std::size_t>(class_index)];
  }
  /// Returns the index of the curve of an estimate from telemetry, for ground of the class `class_index`, or
  /// possibly of `other_class`. No cost of the curve is below the cost of the same estimate on either class.
  std::uint8_t learned(int class_index, int other_class, const GroundBelief& belief);
  std::uint8_t learned(int class_index, const GroundBelief& belief) {
    return learned(class_index, class_index, belief);
  }

  /// Returns the index of a curve that equals the curve with index `number` except that `added_J_per_m` is
  /// added to the energy. `number` must not be a result of dearer(). `step` > 0 identifies the added energy
  /// and increases with it. If no index is free, returns the index assigned to the next greater step of the
  /// same curve, or CellCode::kBlocked if there is no such index.
  std::uint8_t dearer(std::uint8_t number, int step, double added_J_per_m);

  /// Returns true if an estimate received a substitute curve since the last restart().
  bool overflowed() const noexcept { return overflowed_; }
  /// Returns the fraction, 0 to 1, of the indices for estimates from telemetry that are in use.
  double used() const noexcept;
  /// Discards all estimates from telemetry; later estimates are quantised at this level (coarseness) of
  /// GroundKind.
  void restart(int level);
  int level() const noexcept { return level_; }

  /// Replaces the prior of a class by the estimate `next` from evidence. Returns false if the prior is
  /// unchanged, as in most calls.
  bool setPrior(int class_index, const GroundBelief& next);

  /// Returns the estimate from which the curve with an index was computed.
  const GroundBelief& belief(std::uint8_t number) const { return beliefs_[number]; }
  /// Returns the categories of the ground with a curve index, tabulated over the gradient of the plane of a
  /// cell.
  const CategoryTable& categories(std::uint8_t number) const { return categories_[number]; }

  /// Returns the cost function with the curves of all assigned indices. Calls return the same object until a
  /// curve is added.
  std::shared_ptr<const TravelCost> cost() const;

 private:
  // Bits of a prior, as the key of a cache: during learning, a class alternates between few priors.
  using PriorKey = std::array<std::int64_t, 5>;
  struct Worked {
    GroundCost ground;
    CategoryTable categories;
  };
  const Worked& worked(int class_index, const GroundBelief& prior);
  std::uint8_t standIn(const GroundKind& kind) const;
  GroundCost dearer(const GroundCost& ground, double added_J_per_m) const;
  SoilUncertainty uncertainty() const;
  void price(std::size_t class_index);
  std::optional<std::uint8_t> freeNumber();
  std::size_t classes() const noexcept { return model_->parts().classes.size(); }

  std::shared_ptr<const GroundModel> model_;
  int level_ = 0;
  bool overflowed_ = false;
  std::vector<GroundCost> grounds_;
  std::vector<CategoryTable> categories_;
  std::vector<GroundBelief> beliefs_;
  std::vector<GroundBelief> priors_;  // priors of the classes
  // Use of the index of a class: free; by the prior of the class; by another estimate; by another estimate
  // although prior() was called for the class.
  enum class Slot : std::uint8_t { Free, Own, Lent, Wanted };
  std::vector<Slot> slots_;
  struct Dearer {
    std::uint8_t number;
    double added_J_per_m;
  };
  std::map<GroundKind, std::uint8_t> numbers_;
  std::map<std::pair<std::uint8_t, int>, Dearer> dearer_;  // curves of dearer(), by curve index and step
  std::map<PriorKey, Worked> worked_;
  mutable std::shared_ptr<const TravelCost> cost_;
};

}  // namespace talus::costmap
