#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

namespace talus::cli {

/// Widest line of --help, in characters.
inline constexpr std::size_t kHelpWidth = 100;

/// Where a type's name ends: the first colon, behind which CLI11 has the checks, but none in "[:UNIT]".
std::size_t endOfTypeName(const std::string& type);

/// The text broken at blanks into lines of at most `width` characters; a longer word has a line of its own.
std::string wrapped(std::string_view text, std::size_t width);

/// --help within kHelpWidth: an option's value in its left column; its default, its choices and what it
/// excludes in brackets after its description.
class HelpFormat : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override;
  std::string make_option(const CLI::Option* option, bool is_positional) const override;
  std::string make_subcommand(const CLI::App* command) const override;
};

/// Puts the options of the command that have no heading in --help yet under this one.
void groupOptions(CLI::App& command, const std::string& heading);

/// Makes the option the old name of another: it stays accepted, is hidden from --help, and a call that uses
/// it gets a warning.
void makeOldName(CLI::Option& option, const std::string& new_name);

/// "'--old' is deprecated: use '--new'" of each old name that the call used.
std::vector<std::string> oldNamesUsed(CLI::App& command);

}  // namespace talus::cli
