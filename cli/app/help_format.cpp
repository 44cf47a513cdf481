#include <algorithm>
#include <regex>
#include <set>
#include <sstream>

#include <fmt/format.h>

#include <talus/cli/app/help_format.hpp>

namespace talus::cli {
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
  if (check.front() == '{') {
    std::string words = "one of";
    std::istringstream choices(check.substr(1, check.size() - 2));
    for (std::string word; std::getline(choices, word, ',');)
      words += (words == "one of" ? " " : ", ") + word;
    return words;
  }
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
  add("default: ", option->get_default_str());
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

std::string wrapped(std::string_view text, std::size_t width) {
  std::string out;
  std::size_t used = 0;
  std::istringstream words{std::string(text)};
  for (std::string word; words >> word; used += word.size()) {
    if (used > 0 && used + 1 + word.size() > width) {
      out += '\n';
      used = 0;
    } else if (used > 0) {
      out += ' ';
      ++used;
    }
    out += word;
  }
  return out;
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

void groupOptions(CLI::App& command, const std::string& heading) {
  for (CLI::Option* option : command.get_options())
    if (option->get_group() == "Options" && option != command.get_help_ptr()) option->group(heading);
}

}  // namespace talus::cli
