#pragma once

#include <algorithm>
#include <vector>

namespace talus::terramech {

/// Returns the median of the values. For an even count this is the upper of the two middle values, for an
/// empty vector 0.
inline double medianOf(std::vector<double> v) {
  if (v.empty()) return 0.0;
  std::nth_element(v.begin(), v.begin() + static_cast<long>(v.size() / 2), v.end());
  return v[v.size() / 2];
}

}  // namespace talus::terramech
