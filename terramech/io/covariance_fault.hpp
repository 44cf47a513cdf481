#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace talus::terramech {

/// What keeps numbers, row by row, from being the covariance of anything; empty: nothing. A variance below 0 would be
/// read as certainty.
std::string faultOfCovariance(const std::vector<double>& values, std::size_t size);

}  // namespace talus::terramech
