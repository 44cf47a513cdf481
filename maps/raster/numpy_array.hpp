#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace talus::maps {

/// A NumPy array of numbers, converted to double, in C order.
struct NumpyArray {
  std::vector<std::size_t> shape;  ///< empty for a scalar
  std::vector<double> values;
};

/// Parses the bytes of a .npy file (format versions 1 to 3; integers, float32, float64; either byte order).
/// `where` is the location in error messages. @throws InputError
NumpyArray parseNumpy(const std::string& bytes, const std::string& where);

}  // namespace talus::maps
