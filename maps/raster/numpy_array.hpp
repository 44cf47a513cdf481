#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace talus::maps {

/// A NumPy array of numbers, converted to double, in C order (last index fastest).
struct NumpyArray {
  std::vector<std::size_t> shape;  ///< size of each dimension; empty for a scalar
  std::vector<double> values;
};

/// Returns the array that the bytes of a .npy file contain (format versions 1 to 3; integers, float32,
/// float64; either byte order). `where` names the file in error messages. @throws InputError
NumpyArray parseNumpy(const std::string& bytes, const std::string& where);

}  // namespace talus::maps
