#pragma once

#include <compare>

#include <talus/costmap/ground/ground_model.hpp>

namespace talus::costmap {

/// A belief in whole steps from the prior of its class, rounded towards danger: pull down in steps of 0.02, its standard
/// deviation up in quarters of an octave from 1/64 to 256 of the prior's, sinkage over radius up in steps of 0.1. At level n
/// steps are 2^n times as large. What is no worse than the prior is rounded to nothing worse: little evidence makes no ground
/// dearer. What is rounded twice, to the same level or a higher one, is rounded as at once. The deviation has the finest
/// steps, because the probability of immobilisation of ground with a reserve of z deviations depends on it most: a
/// step of a whole octave would halve z.
struct GroundKind {
  static constexpr int kCoarsest = 3;        ///< highest level
  static constexpr double kPullStep = 0.02;  ///< at level 0 [-]

  int class_index = 0;
  int other_class = 0;  ///< ground is as bad as the worse of its own class and this one; its own: none
  int pull = 0;
  int pull_std = 0;  ///< quarters of an octave above the prior's
  int sinkage = 0;

  auto operator<=>(const GroundKind&) const = default;  // NOLINT(modernize-use-nullptr): of clang 14

  /// `prior`: of the class, whatever was learned (GroundModel::prior()).
  static GroundKind of(const GroundBelief& prior, int class_index, int other_class,
                       const GroundBelief& belief, int level = 0) noexcept;

  /// The belief that stands for all that are rounded to this: the worst of them. The standard deviation of sinkage
  /// shrinks with that of the pull, as far as the class says.
  GroundBelief belief(const GroundBelief& prior, const GroundClass& ground) const noexcept;
};

/// Whether ground of one belief costs no less than ground of the other, at any gradient, on any class: no
/// stronger, no surer, sinking no less.
bool noBetter(const GroundBelief& belief, const GroundBelief& than) noexcept;

}  // namespace talus::costmap
