#pragma once

#include <compare>

#include <talus/costmap/ground/ground_model.hpp>

namespace talus::costmap {

/// Estimated strength of ground, quantised so that similar estimates share one cost curve. Each quantity is
/// relative to the prior of the terrain class and rounded towards danger, in steps of
///   - drawbar pull over load DP/W: 0.005, rounded down;
///   - standard deviation of DP/W: a factor 2^(1/8), from 1/64 to 256 times that of the prior, rounded up;
///   - sinkage over wheel radius: 0.02, rounded up.
/// An estimate no worse than the prior is not rounded beyond the prior, so that little evidence never increases a
/// cost.
struct GroundKind {
  static constexpr double kPullStep = 0.005;  ///< step of DP/W [-]

  int class_index = 0;
  /// Second possible terrain class of the ground; equal to class_index if there is only one.
  int other_class = 0;
  /// DP/W minus that of the prior, in steps of kPullStep.
  int pull = 0;
  int pull_std = 0;  ///< standard deviation of DP/W, in steps of a factor 2^(1/8) relative to the prior's
  /// Sinkage over wheel radius minus that of the prior, in steps of 0.02.
  int sinkage = 0;

  auto operator<=>(const GroundKind&) const = default;  // NOLINT(modernize-use-nullptr): of clang 14

  /// Returns the quantised form of the estimate `belief`. `prior` is the estimate of the class before any
  /// evidence (GroundModel::prior()).
  static GroundKind of(const GroundBelief& prior, int class_index, int other_class,
                       const GroundBelief& belief) noexcept;

  /// Returns the worst estimate that is quantised to this kind. The standard deviation of sinkage is reduced
  /// in proportion to that of DP/W, and is at most ground.sinkage_std.
  GroundBelief belief(const GroundBelief& prior, const GroundClass& ground) const noexcept;
};

}  // namespace talus::costmap
