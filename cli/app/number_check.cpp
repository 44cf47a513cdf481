#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <sstream>
#include <string_view>

#include <fmt/format.h>

#include <talus/cli/app/number_check.hpp>
#include <talus/common/input_error.hpp>
#include <talus/common/plausible.hpp>

namespace talus::cli {
namespace {

constexpr double kNoEnd = std::numeric_limits<double>::infinity();

// Shortest of {:g} and {} that represents the value exactly: a bound of 1 - 1e-12 must not be printed as 1.
std::string end(double value) {
  std::string few = fmt::format("{:g}", value);
  return std::strtod(few.c_str(), nullptr) == value ? few : fmt::format("{}", value);
}

std::string bound(double low, double high) {
  if (low == -kNoEnd) return "a finite number";
  return high == kNoEnd ? "finite, >= " + end(low) : end(low) + " to " + end(high);
}

// Returns true for an implausible number such as "nan". Integers are always accepted, because seeds are
// large.
bool isImpossible(std::string_view word) {
  if (word.ends_with('d')) word.remove_suffix(1);  // suffix of degrees of a place
  const std::string text(word);
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || end != text.c_str() + text.size()) return false;
  const bool whole = text.find_first_not_of("+-0123456789") == text.npos;
  return !whole && !plausible(value);
}

// Returns true for a number that strtod() reads but that is not decimal, such as 0x10. A name such as 0xfile
// is not a number.
bool isNotDecimal(std::string_view word) {
  const std::string text(word);
  char* end = nullptr;
  std::strtod(text.c_str(), &end);
  return !isDecimal(word) && end == text.c_str() + text.size();
}

// CLI11's get_name() is empty for hidden options.
std::string nameOf(const CLI::Option& option) {
  return option.get_lnames().empty() ? option.get_name(true) : "--" + option.get_lnames().front();
}

void refuseEmptyValue(CLI::Option& option) {
  const std::string name = nameOf(option);
  const char* remedy = option.get_positional() ? "give a value" : "leave the option out or give a value";
  const auto check = [name, remedy](std::string& value) -> std::string {
    if (value.find_first_not_of(" \t\r\n\v\f") == value.npos)
      throw InputError({name, "its value is empty", remedy});
    return "";
  };
  option.transform(CLI::Validator(check, ""));  // runs before all other checks
}

}  // namespace

void refuseEmptyValues(CLI::App& program) {
  for (CLI::Option* option : program.get_options())
    if (option->get_items_expected_max() > 0) refuseEmptyValue(*option);
  for (CLI::App* command : program.get_subcommands({})) refuseEmptyValues(*command);
}

// Returns true if values of the option may be file names, for which a number can be a valid name.
bool takesFiles(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  return option.get_positional() || type == "TEXT" || type.find("FILE") != type.npos ||
         type.find('.') != type.npos;
}

void checkNumbers(const CLI::App& command) {
  if (command.get_parent() != nullptr) checkNumbers(*command.get_parent());
  for (const CLI::Option* option : command.get_options()) {
    if (option->empty()) continue;
    for (const std::string& result : option->results()) {
      const auto refuse = [&](const std::string& word, const char* reason) {
        throw InputError({fmt::format("{} {}", option->get_name(), result), reason,
                          takesFiles(*option) ? "a file of that name is ./" + word : "give another number"});
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

CLI::Validator heading() {
  const auto check = [](const std::string& text) -> std::string {
    if (within(-2 * std::numbers::pi, 2 * std::numbers::pi)(text).empty()) return "";
    return text + ", must be an angle in radians, -2 pi to 2 pi; for degrees use the option with -deg";
  };
  return CLI::Validator(check, "");
}

}  // namespace talus::cli
