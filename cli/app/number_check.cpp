#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <talus/cli/app/number_check.hpp>

namespace talus::cli {
namespace {

constexpr double kNoEnd = std::numeric_limits<double>::infinity();

std::string bound(double low, double high) {
  if (low == -kNoEnd) return "a finite number";
  return high == kNoEnd ? fmt::format("finite, >= {:g}", low) : fmt::format("{:g} to {:g}", low, high);
}

}  // namespace

CLI::Validator within(double low, double high) {
  const auto check = [low, high](const std::string& text) -> std::string {
    double value = 0.0;
    const bool number = CLI::detail::lexical_cast(text, value) && std::isfinite(value);
    if (number && value >= low && value <= high) return "";
    return fmt::format("{}, must be {}", text, bound(low, high));
  };
  return CLI::Validator(check, "");
}

CLI::Validator notNegative() {
  return within(0.0, kNoEnd);
}

CLI::Validator positive() {
  const auto check = [](const std::string& text) -> std::string {
    double value = 0.0;
    const bool number = CLI::detail::lexical_cast(text, value) && std::isfinite(value);
    return number && value > 0.0 ? "" : text + ", must be finite, > 0";
  };
  return CLI::Validator(check, "");
}

CLI::Validator finite() {
  return within(-kNoEnd, kNoEnd);
}

}  // namespace talus::cli
