#pragma once

#include <functional>
#include <string>
#include <vector>

namespace talus::fuzz {

/// A reader of bytes from elsewhere. It may refuse them by the exceptions that the program turns into exit 2; all else
/// that ends it is a fault.
struct Target {
  std::string name;
  std::vector<std::string> seeds;  ///< that it accepts
  std::function<void(const std::string&)> read;
};

/// Readers of telemetry, wheel tables, YAML, GeoJSON, .npy, .npz, MAP.ot, octrees, journals and MovingAI files.
const std::vector<Target>& targets();

/// Whether the target accepts the bytes; false where it refuses them by an error of input.
bool accepts(const Target& target, const std::string& bytes);

}  // namespace talus::fuzz
