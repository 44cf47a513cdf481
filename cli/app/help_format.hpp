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

/// Makes an option a deprecated name of another option: the old name is accepted, hidden from --help, and
/// causes a warning.
void makeOldName(CLI::Option& option, const std::string& new_name);

/// Returns the messages "'--old' is deprecated: use '--new'" for all deprecated names in the call.
std::vector<std::string> oldNamesUsed(CLI::App& command);

}  // namespace talus::cli
