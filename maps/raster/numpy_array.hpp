#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace talus::maps {

/// A NumPy array of numbers, as float64, in C order.
struct NumpyArray {
  std::vector<std::size_t> shape;  ///< empty for a single number
  std::vector<double> values;
};

/// Reads the bytes of a .npy file (format 1 to 3; integers, float32, float64; either byte order).
/// `where` opens the error line. @throws InputError
NumpyArray parseNumpy(const std::string& bytes, const std::string& where);

}  // namespace talus::maps
