#pragma once

#include <string>
#include <vector>

#include <talus/terramech/effects/effects.hpp>

namespace talus::terramech {

/// A possible addition to a model: an effect of the library, or curves of one covariate in some channels.
struct Candidate {
  std::vector<Effect> parts;  ///< one effect, or one curve per channel
  std::string family;         ///< "empirical" for curves
  int parameters = 0;         ///< number of fitted parameters

  /// Returns true for curves.
  bool empirical() const { return parts.front().empirical(); }
  /// The explaining column; for an effect on one group of rows, the column of the group.
  const std::string& covariate() const {
    const Effect& front = parts.front();
    return front.only_column.empty() ? front.covariate : front.only_column;
  }
};

}  // namespace talus::terramech
