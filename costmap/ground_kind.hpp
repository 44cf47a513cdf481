#pragma once

#include <compare>

#include <talus/costmap/ground_model.hpp>

namespace talus::costmap {

/// A belief in whole steps, rounded towards danger: pull down in steps of 0.02, its standard deviation up to a
/// power of two of 0.02, sinkage over radius up in steps of 0.1. At level n steps are 2^n times as large, and
/// those of the deviation two octaves from level 2 on. What is rounded twice, to the same level or a higher one, is rounded
/// as at once.
struct GroundKind {
  static constexpr int kCoarsest = 3;  ///< highest level

  int class_index = 0;
  int other_class = 0;  ///< ground is as bad as the worse of its own class and this one; its own: none
  int pull = 0;
  int pull_std = 0;  ///< exponent
  int sinkage = 0;

  auto operator<=>(const GroundKind&) const = default;

  static GroundKind of(int class_index, int other_class, const GroundBelief& belief, int level = 0) noexcept;

  /// The belief that stands for all that are rounded to this: the worst of them. The standard deviation of sinkage
  /// shrinks with that of the pull, as far as the class says.
  GroundBelief belief(const GroundClass& ground) const noexcept;
};

/// Whether ground of one belief costs no less than ground of the other, at any gradient, on any class: no
/// stronger, no surer, sinking no less.
bool noBetter(const GroundBelief& belief, const GroundBelief& than) noexcept;

}  // namespace talus::costmap
