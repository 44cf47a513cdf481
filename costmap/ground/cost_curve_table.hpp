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

/// Assigns curve numbers (0 to 253) to estimates of ground. Numbers 0 .. classes-1 belong to the priors of
/// the classes. A prior is refused in every heading until its number is requested, so that only classes that
/// occur are computed; the first class, the default, is computed at once. A learned estimate is quantised
/// towards danger (GroundKind) and gets a number at its first occurrence. If no number is left, numbers of
/// unrequested classes are used; then a known number with no better ground substitutes, and without such a
/// number the ground is blocked. Exhaustion therefore never reduces a cost. Not thread-safe.
class CostCurveTable {
 public:
  explicit CostCurveTable(std::shared_ptr<const GroundModel> model);

  /// Returns the number of the prior of a class; priorBelief() is the estimate itself.
  std::uint8_t prior(int class_index);
  const GroundBelief& priorBelief(int class_index) const {
    return priors_[static_cast<std::size_t>(class_index)];
  }
  /// Returns the number of ground with a learned estimate. The curve is nowhere below that of the same
  /// estimate on `other_class`.
  std::uint8_t learned(int class_index, int other_class, const GroundBelief& belief);
  std::uint8_t learned(int class_index, const GroundBelief& belief) {
    return learned(class_index, class_index, belief);
  }

  /// Returns the number of the curve of `number` with `added_J_per_m` added to its energy. `number` must not
  /// be a result of dearer(). `step` > 0 identifies the added energy and increases with it. If no number is
  /// free, returns the number assigned to the next greater step of the same curve, else CellCode::kBlocked.
  std::uint8_t dearer(std::uint8_t number, int step, double added_J_per_m);

  /// Whether a substitute was needed since the last restart.
  bool overflowed() const noexcept { return overflowed_; }
  /// Fraction of the numbers for learned estimates that are in use, 0 to 1.
  double used() const noexcept;
  /// Discards all learned estimates; later estimates are quantised at this level of GroundKind.
  void restart(int level);
  int level() const noexcept { return level_; }

  /// Replaces the prior of a class after learning its soil; returns false if unchanged. Priors learned in
  /// steps (EvidenceField::Classes::InSteps) are mostly unchanged.
  bool setPrior(int class_index, const GroundBelief& next);

  /// The estimate from which the curve of a number was made.
  const GroundBelief& belief(std::uint8_t number) const { return beliefs_[number]; }
  /// Category of the ground of a number over the gradient of its plane.
  const CategoryTable& categories(std::uint8_t number) const { return categories_[number]; }

  /// Returns the cost function with the curves of all assigned indices; the same object until a curve is added.
  std::shared_ptr<const TravelCost> cost() const;

 private:
  // Bits of a prior, as the key of a cache: a class that is being learned alternates between few priors.
  using PriorKey = std::array<std::int64_t, 5>;
  struct Worked {
    GroundCost ground;
    CategoryTable categories;
  };
  const Worked& worked(int class_index, const GroundBelief& prior);
  std::uint8_t standIn(const GroundKind& kind) const;
  GroundCost dearer(const GroundCost& ground, double added_J_per_m) const;
  SoilUncertainty doubt() const;
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
  // Use of a class's number: none, the class, another estimate, or another estimate while the class waits for
  // its number.
  enum class Slot : std::uint8_t { Free, Own, Lent, Wanted };
  std::vector<Slot> slots_;
  struct Dearer {
    std::uint8_t number;
    double added_J_per_m;
  };
  std::map<GroundKind, std::uint8_t> numbers_;
  std::map<std::pair<std::uint8_t, int>, Dearer> dearer_;  // by number and step
  std::map<PriorKey, Worked> worked_;
  mutable std::shared_ptr<const TravelCost> cost_;
};

}  // namespace talus::costmap
