#pragma once

namespace talus::terramech {

/// x x.
constexpr double squared(double x) noexcept {
  return x * x;
}

}  // namespace talus::terramech
