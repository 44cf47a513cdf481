#pragma once

namespace talus::terramech {

/// Returns x^2.
constexpr double squared(double x) noexcept {
  return x * x;
}

}  // namespace talus::terramech
