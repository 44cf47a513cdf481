#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include <talus/costmap/category_table.hpp>
#include <talus/costmap/ground_model.hpp>

namespace talus::costmap {

/// Gives curve numbers to beliefs. The priors of the classes are numbers 0 .. classes-1, exactly; a learned
/// belief is rounded (pull 0.02, sinkage 0.1, standard deviations to a power of two of 0.02 and 0.05) and
/// gets its number when it first occurs. When the 254 numbers are used up, the nearest belief of the same
/// class stands in. Not thread-safe.
class CostCurveTable {
 public:
  explicit CostCurveTable(std::shared_ptr<const GroundModel> model);

  /// Number of ground of a class that nobody drove on.
  std::uint8_t prior(int class_index) const noexcept { return static_cast<std::uint8_t>(class_index); }
  /// Number of ground under a learned belief.
  std::uint8_t learned(int class_index, const GroundBelief& belief);

  /// Replaces the belief of a class prior, after its soil was learned. False when it rounds to what it was
  /// (0.005 in pull and its standard deviation, 0.02 in sinkage).
  bool setPrior(int class_index, const GroundBelief& belief);

  /// Category of ground of this number over the steepness of its plane.
  const CategoryTable& categories(std::uint8_t number) const { return categories_[number]; }

  /// The cost function over all numbers given so far; the same object until one is added.
  std::shared_ptr<const DriveCost> cost() const;

 private:
  struct Key {
    int class_index;
    int pull;
    int pull_std;
    int sinkage;
    auto operator<=>(const Key&) const = default;
  };

  // The bits of a prior: while a class is learned it moves to and fro between a few.
  using PriorKey = std::array<std::int64_t, 5>;
  struct Worked {
    DriveGround ground;
    CategoryTable categories;
  };
  const Worked& worked(int class_index, const GroundBelief& prior);

  static Key rounded(int class_index, const GroundBelief& belief) noexcept;
  std::uint8_t nearest(const Key& key) const noexcept;

  std::shared_ptr<const GroundModel> model_;
  std::vector<DriveGround> grounds_;
  std::vector<CategoryTable> categories_;
  std::vector<GroundBelief> priors_;
  std::map<Key, std::uint8_t> numbers_;
  std::map<PriorKey, Worked> worked_;
  mutable std::shared_ptr<const DriveCost> cost_;
};

}  // namespace talus::costmap
