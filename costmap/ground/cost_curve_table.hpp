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

/// Gives curve numbers to beliefs. The priors of the classes are numbers 0 .. classes-1, refused in every heading until
/// their number is asked for: only classes that occur are priced, and the first, the default. A learned belief is
/// rounded towards danger (GroundKind) and gets its number when it first occurs. When the 254 numbers are used
/// up, those of classes that nobody asked for are lent; then a known number whose ground is no better in anything stands in, and where there is none the ground is
/// blocked: running out makes ground dearer, never cheaper. Not thread-safe.
class CostCurveTable {
 public:
  explicit CostCurveTable(std::shared_ptr<const GroundModel> model);

  /// Number of ground of a class that nobody drove on, and what is believed of it.
  std::uint8_t prior(int class_index);
  const GroundBelief& priorBelief(int class_index) const {
    return priors_[static_cast<std::size_t>(class_index)];
  }
  /// Number of ground under a learned belief. `other_class`: its curve is nowhere below that of the same belief
  /// on that class either.
  std::uint8_t learned(int class_index, int other_class, const GroundBelief& belief);
  std::uint8_t learned(int class_index, const GroundBelief& belief) {
    return learned(class_index, class_index, belief);
  }

  /// Number of the ground of another number, any but those of dearer(), where a metre costs so much more energy.
  /// `step` > 0 stands for the joules and grows with them; where numbers run out, a greater one of the ground stands in.
  std::uint8_t dearer(std::uint8_t number, int step, double added_J_per_m);

  /// Whether some belief had to do with another's number since the last restart.
  bool overflowed() const noexcept { return overflowed_; }
  /// Share of the numbers for learned beliefs that are given away, 0 to 1.
  double used() const noexcept;
  /// Forgets all learned beliefs; those to come are rounded at this level of GroundKind.
  void restart(int level);
  int level() const noexcept { return level_; }

  /// Replaces the belief of a class prior, after its soil was learned. False when it is what it was: in steps
  /// (EvidenceField::Classes::InSteps) that is most often so.
  bool setPrior(int class_index, const GroundBelief& next);

  /// The belief that a number's curve was made from.
  const GroundBelief& belief(std::uint8_t number) const { return beliefs_[number]; }
  /// Category of ground of this number over the steepness of its plane.
  const CategoryTable& categories(std::uint8_t number) const { return categories_[number]; }

  /// The cost function over all numbers given so far; the same object until one is added.
  std::shared_ptr<const DriveCost> cost() const;

 private:
  // The bits of a prior: while a class is learned it moves to and fro between a few.
  using PriorKey = std::array<std::int64_t, 5>;
  struct Worked {
    DriveGround ground;
    CategoryTable categories;
  };
  const Worked& worked(int class_index, const GroundBelief& prior);
  std::uint8_t standIn(const GroundKind& kind) const;
  DriveGround dearer(const DriveGround& ground, double added_J_per_m) const;
  SoilDoubt doubt() const;
  void price(std::size_t class_index);
  std::optional<std::uint8_t> freeNumber();
  std::size_t classes() const noexcept { return model_->parts().classes.size(); }

  std::shared_ptr<const GroundModel> model_;
  int level_ = 0;
  bool overflowed_ = false;
  std::vector<DriveGround> grounds_;
  std::vector<CategoryTable> categories_;
  std::vector<GroundBelief> beliefs_;
  std::vector<GroundBelief> priors_;  // of the classes
  // What the numbers of the classes stand for: nothing yet, the class, another belief, or one that the class is to have back.
  enum class Slot : std::uint8_t { Free, Own, Lent, Wanted };
  std::vector<Slot> slots_;
  struct Dearer {
    std::uint8_t number;
    double added_J_per_m;
  };
  std::map<GroundKind, std::uint8_t> numbers_;
  std::map<std::pair<std::uint8_t, int>, Dearer> dearer_;  // by number and step
  std::map<PriorKey, Worked> worked_;
  mutable std::shared_ptr<const DriveCost> cost_;
};

}  // namespace talus::costmap
