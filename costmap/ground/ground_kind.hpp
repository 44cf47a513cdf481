#pragma once

#include <compare>

#include <talus/costmap/ground/ground_model.hpp>

namespace talus::costmap {

/// Estimate of ground quantised relative to the prior of its class and rounded towards danger, in steps of
///   - pull: 0.02, rounded down;
///   - standard deviation of the pull: a quarter octave, from 1/64 to 256 of the prior's, rounded up;
///   - sinkage divided by radius: 0.1, rounded up.
/// At level n, steps are 2^n times as large. An estimate no worse than the prior is not rounded beyond the
/// prior, so that little evidence never increases a cost. Rounding at a level after rounding at the same or a
/// lower level equals rounding once. The standard deviation has the finest steps, because the probability of
/// immobilisation with a reserve of z deviations is most sensitive to the standard deviation: a step of one
/// octave would halve z.
struct GroundKind {
  static constexpr int kCoarsest = 3;        ///< highest level
  static constexpr double kPullStep = 0.02;  ///< at level 0 [-]

  int class_index = 0;
  int other_class = 0;  ///< second possible class of the ground, else equal to class_index
  int pull = 0;
  int pull_std = 0;  ///< quarter octaves relative to the prior's standard deviation
  int sinkage = 0;

  auto operator<=>(const GroundKind&) const = default;  // NOLINT(modernize-use-nullptr): of clang 14

  /// Quantises `belief`. `prior` is the estimate of the class before any evidence (GroundModel::prior()).
  static GroundKind of(const GroundBelief& prior, int class_index, int other_class,
                       const GroundBelief& belief, int level = 0) noexcept;

  /// Returns the worst estimate that is quantised to this kind. The standard deviation of sinkage decreases
  /// in proportion to that of the pull, up to the class's sinkage_std.
  GroundBelief belief(const GroundBelief& prior, const GroundClass& ground) const noexcept;
};

/// True if ground of the estimate `belief` costs at least as much as ground of `than`, at any gradient and on
/// any class: the pull is no greater, its standard deviation and the sinkage are no smaller.
bool noBetter(const GroundBelief& belief, const GroundBelief& than) noexcept;

}  // namespace talus::costmap
