#include <cmath>
#include <cstdlib>
#include <limits>
#include <sstream>
#include <string_view>

#include <fmt/format.h>

#include <talus/cli/app/number_check.hpp>
#include <talus/plausible.hpp>
#include <talus/talus.hpp>

namespace talus::cli {
namespace {

constexpr double kNoEnd = std::numeric_limits<double>::infinity();

std::string bound(double low, double high) {
  if (low == -kNoEnd) return "a finite number";
  return high == kNoEnd ? fmt::format("finite, >= {:g}", low) : fmt::format("{:g} to {:g}", low, high);
}

// Whether a word is a number in itself, such as "nan"; a whole number is not judged by its size: seeds are large.
bool isImpossible(std::string_view word) {
  if (word.ends_with('d')) word.remove_suffix(1);  // degrees of a place
  const std::string text(word);
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || end != text.c_str() + text.size()) return false;
  const bool whole = text.find_first_not_of("+-0123456789") == text.npos;
  return !whole && !plausible(value);
}

// Whether a word would be taken for another number than it shows: 0x10 for 16, 010 for 8.
bool isNotDecimal(std::string_view word) {
  if (word.starts_with('-') || word.starts_with('+')) word.remove_prefix(1);
  if (word.size() < 2 || word[0] != '0') return false;
  if (word[1] == 'x' || word[1] == 'X') {
    const std::string text(word);
    char* end = nullptr;
    std::strtod(text.c_str(), &end);
    return end == text.c_str() + text.size();
  }
  return word.find_first_not_of("0123456789") == word.npos;
}

}  // namespace

void checkNumbers(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options()) {
    if (option->empty()) continue;
    for (const std::string& result : option->results()) {
      const auto refuse = [&](const std::string& word, const char* reason) {
        throw InputError(
            {fmt::format("{} {}", option->get_name(), result), reason, "a file of that name is ./" + word});
      };
      std::istringstream words(result);
      for (std::string word; std::getline(words, word, ',');) {
        if (isImpossible(word)) refuse(word, kPlausible);
        if (isNotDecimal(word)) refuse(word, "must be decimal, without leading zeros");
      }
    }
  }
}

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
