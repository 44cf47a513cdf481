#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

namespace talus::cli {

/// Widest line of --help, in characters.
inline constexpr std::size_t kHelpWidth = 100;

/// Returns the index at which a type name ends: that of the first colon, after which CLI11 lists the checks.
/// A colon in "[:UNIT]" is skipped.
std::size_t endOfTypeName(const std::string& type);

/// Breaks the text at blanks into lines of at most `width` characters; a longer word gets its own line.
std::string wrapped(std::string_view text, std::size_t width);

/// Formats --help within kHelpWidth: the option and its value in the left column, then the description with
/// default, choices and exclusions in brackets.
class HelpFormat : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override;
  std::string make_option(const CLI::Option* option, bool is_positional) const override;
  std::string make_subcommand(const CLI::App* command) const override;
};

/// Assigns the --help heading to all options of the command that have no heading yet.
void groupOptions(CLI::App& command, const std::string& heading);

/// Makes the option a deprecated name of another option: the old name is accepted, hidden from --help, and
/// causes a warning.
void makeOldName(CLI::Option& option, const std::string& new_name);

/// Messages "'--old' is deprecated: use '--new'" for all deprecated names in the call.
std::vector<std::string> oldNamesUsed(CLI::App& command);

}  // namespace talus::cli
