#pragma once

#include <functional>
#include <string>
#include <string_view>

#include <CLI/CLI.hpp>

namespace talus::cli {

/// Makes every option and argument of the program and its subcommands reject empty or blank values: the
/// number parser would read such a value as 0, and a path option would treat it as not given. Must be called
/// once, after all options are declared. The parse then throws InputError with the name of the option.
void refuseEmptyValues(CLI::App& program);

/// Checks all numbers of a parsed call, in options of the subcommand and of the program. Rejects numbers that
/// are not plausible(), because NaN passes range tests, and numbers that the option's parser reads as
/// hexadecimal or octal. Throws InputError with the name of the option.
void checkNumbers(const CLI::App& command);

/// Adds an option or argument to a command. `name` may end in the name of its value, after a blank: "--rover ROVER".
template <typename T>
CLI::Option* addOption(CLI::App& command, const std::string& name, T& value) {
  const std::size_t blank = name.find(' ');
  CLI::Option* option = command.add_option(name.substr(0, blank), value);
  return blank == name.npos ? option : option->type_name(name.substr(blank + 1));
}

/// Returns a check that rejects values other than finite numbers for which `holds` is true; the reason ends in `must`.
CLI::Validator numberThat(std::function<bool(double)> holds, const std::string& must);

/// Returns a check that rejects numbers outside [low, high], infinities and NaN. With an infinite `high`, or
/// both ends infinite, the numbers have no bound at that end.
CLI::Validator within(double low, double high);

/// Returns a check that rejects values other than finite numbers >= 0.
CLI::Validator notNegative();

/// Returns a check that rejects values other than finite numbers > 0.
CLI::Validator positive();

/// Returns a check that rejects NaN and infinity.
CLI::Validator finite();

/// Returns a check that rejects values other than angles in radians from -2 pi to 2 pi, such as degrees.
CLI::Validator heading();

/// Width of the longest line of --help, in characters.
inline constexpr std::size_t kHelpWidth = 100;

/// Returns the index at which the type name ends in `type`: that of the first colon, after which CLI11 lists
/// the checks. A colon in "[:UNIT]" is skipped.
std::size_t endOfTypeName(const std::string& type);

/// Returns the text broken at blanks into lines of at most `width` characters; a longer word has its own
/// line.
std::string wrapped(const std::string& text, std::size_t width);

/// Formatter of --help within kHelpWidth. The left column has the option and its value; the right column has
/// the description, with default, choices and exclusions in brackets.
class HelpFormat : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override;
  std::string make_option(const CLI::Option* option, bool is_positional) const override;
  std::string make_subcommand(const CLI::App* command) const override;
};

/// Adds a subcommand with its texts in cli/app/texts.yaml: group, purpose, and examples with remarks as footer.
CLI::App& addSubcommand(CLI::App& app, const std::string& name);

/// Assigns the options of a subcommand, or of the program, their headings and texts in cli/app/texts.yaml.
void describeOptions(CLI::App& command);

}  // namespace talus::cli
