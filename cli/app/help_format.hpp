#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

namespace talus::cli {

/// Width of the longest line of --help, in characters.
inline constexpr std::size_t kHelpWidth = 100;

/// Returns the index at which the type name ends in `type`: that of the first colon, after which CLI11 lists
/// the checks. A colon in "[:UNIT]" is skipped.
std::size_t endOfTypeName(const std::string& type);

/// Returns the text broken at blanks into lines of at most `width` characters; a longer word has its own
/// line.
std::string wrapped(std::string_view text, std::size_t width);

/// Formatter of --help within kHelpWidth. The left column has the option and its value; the right column has
/// the description, with default, choices and exclusions in brackets.
class HelpFormat : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override;
  std::string make_option(const CLI::Option* option, bool is_positional) const override;
  std::string make_subcommand(const CLI::App* command) const override;
};

/// Assigns the heading `heading` in --help to all options of the command that have no heading yet.
void groupOptions(CLI::App& command, const std::string& heading);

}  // namespace talus::cli
