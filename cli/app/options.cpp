#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <regex>
#include <set>
#include <sstream>
#include <utility>

#include <boost/algorithm/string/replace.hpp>
#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <talus/cli/app/context.hpp>
#include <talus/cli/app/options.hpp>
#include <talus/cli/app/texts.hpp>
#include <talus/common/common.hpp>
#include <talus/common/limits.hpp>

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

CLI::Validator numberThat(std::function<bool(double)> holds, const std::string& must) {
  const auto check = [holds = std::move(holds), must](const std::string& text) -> std::string {
    double value = 0.0;
    const bool number = CLI::detail::lexical_cast(text, value) && std::isfinite(value);
    return number && holds(value) ? "" : text + ", must be " + must;
  };
  return CLI::Validator(check, "");
}

CLI::Validator within(double low, double high) {
  return numberThat([low, high](double value) { return value >= low && value <= high; }, bound(low, high));
}

CLI::Validator notNegative() {
  return within(0.0, kNoEnd);
}

CLI::Validator positive() {
  return numberThat([](double value) { return value > 0.0; }, "finite, > 0");
}

CLI::Validator finite() {
  return within(-kNoEnd, kNoEnd);
}

CLI::Validator heading() {
  return numberThat([](double rad) { return std::abs(rad) <= 2 * std::numbers::pi; },
                    "an angle in radians, -2 pi to 2 pi; for degrees use the option with -deg");
}

namespace {

constexpr std::size_t kColumn = 30;

// "  NAME      description" with the description wrapped; the description begins on the next line if the name
// is too long.
std::string entry(const std::string& name, const std::string& description) {
  std::string text = "  " + name;
  if (text.size() + 2 > kColumn)
    text += "\n" + std::string(kColumn, ' ');
  else
    text.resize(kColumn, ' ');
  for (const char c : wrapped(description, kHelpWidth - kColumn)) {
    text += c;
    if (c == '\n') text.append(kColumn, ' ');
  }
  return text + "\n";
}

// CLI11's description of a check, such as "{a,b}" or "INT in [1 - 9]", in words.
std::string checkText(const std::string& check) {
  if (check.empty()) return "";
  if (check.front() == '{')
    return "one of " + boost::replace_all_copy(check.substr(1, check.size() - 2), ",", ", ");
  std::smatch range;
  return std::regex_search(check, range, std::regex(R"(in \[(\S+) - (\S+)\])"))
             ? range[1].str() + " to " + range[2].str()
             : "";
}

std::string namesOf(const std::set<CLI::Option*>& options) {
  std::string names;
  for (const CLI::Option* other : options)
    if (!other->get_group().empty()) names += (names.empty() ? "" : ", ") + other->get_name();
  return names;
}

// Remarks in brackets after the description: "[one of a, b; default: a]".
std::string remarks(const CLI::Option* option) {
  std::vector<std::string> parts;
  const auto add = [&parts](const std::string& before, const std::string& text) {
    if (!text.empty()) parts.push_back(before + text);
  };
  const std::string type = option->get_type_name();
  const auto colon = endOfTypeName(type);
  if (option->get_required()) add("required", " ");
  if (colon != std::string::npos) add("", checkText(type.substr(colon + 1)));
  // 0 and NaN mean that the option has no effect unless it is given, and the description may name the default.
  const std::string value = option->get_default_str();
  const bool shown = value != "0" && value != "nan" && value != "[]" &&
                     option->get_description().find("default") == std::string::npos;
  if (shown) add("default: ", value);
  add("not with ", namesOf(option->get_excludes()));
  add("needs ", namesOf(option->get_needs()));
  std::string text;
  for (std::string& part : parts) {
    if (part.back() == ' ') part.pop_back();
    text += (text.empty() ? " [" : "; ") + part;
  }
  return text.empty() ? text : text + "]";
}

}  // namespace

std::size_t endOfTypeName(const std::string& type) {
  std::size_t at = type.find(':');
  while (at != std::string::npos && at > 0 && type[at - 1] == '[') at = type.find(':', at + 1);
  return at;
}

std::string wrapped(const std::string& text, std::size_t width) {
  const auto fits = [width](const std::string& line) { return line.size() <= width; };
  return listText(wrappedLines(text, fits), std::identity(), "\n");
}

// Headings appear in the order of their first options; options without a heading come last.
std::string HelpFormat::make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const {
  std::string text = wrapped(app->get_description(), kHelpWidth) + "\n" + make_usage(app, std::move(name)) +
                     make_positionals(app);
  std::vector<std::string> headings = app->get_groups();
  std::stable_partition(headings.begin(), headings.end(),
                        [](const std::string& heading) { return heading != "Options"; });
  for (const std::string& heading : headings) {
    const auto options = app->get_options(
        [&heading](const CLI::Option* o) { return o->get_group() == heading && o->nonpositional(); });
    if (!heading.empty() && !options.empty()) text += make_group(heading, false, options);
  }
  text += make_subcommands(app, mode);
  return app->get_footer().empty() ? text : text + "\n" + app->get_footer();
}

std::string HelpFormat::make_option(const CLI::Option* option, bool is_positional) const {
  std::string name = make_option_name(option, is_positional);
  if (const auto brace = name.find('{'); brace != std::string::npos) name.resize(brace);  // --no-x{false}
  const std::string type = option->get_type_name();
  if (!is_positional && option->get_type_size() != 0) name += " " + type.substr(0, endOfTypeName(type));
  if (option->get_expected_max() == CLI::detail::expected_max_vector_size) name += " ...";
  return entry(name, make_option_desc(option) + remarks(option));
}

std::string HelpFormat::make_subcommand(const CLI::App* command) const {
  return entry(command->get_display_name(true), command->get_description());
}

CLI::App& addSubcommand(CLI::App& app, const std::string& name) {
  const YAML::Node text = texts()["calls"][name];
  CLI::App& command = *app.add_subcommand(name, text["description"].as<std::string>());
  command.group(text["group"].as<std::string>());
  command.set_help_flag("-h,--help", "print this help; `talus --help` lists the options of all calls");
  std::string footer = "Examples:\n";
  for (const YAML::Node& example : text["examples"]) footer += "  " + example.as<std::string>() + "\n";
  if (text["remarks"]) footer += "\n" + text["remarks"].as<std::string>();
  command.footer(footer);
  return command;
}

void describeOptions(CLI::App& command) {
  for (const YAML::Node& headings : {texts()["options"], texts()["calls"][command.get_name()]["options"]})
    for (const auto& heading : headings)
      for (const auto& text : heading.second)
        if (CLI::Option* option = command.get_option_no_throw(text.first.Scalar())) {
          option->group(heading.first.Scalar());
          if (!text.second.IsNull()) option->description(text.second.Scalar());
        }
}

}  // namespace talus::cli
