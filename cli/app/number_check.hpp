#pragma once

#include <CLI/CLI.hpp>

namespace talus::cli {

/// Makes every option and argument of the program and its subcommands refuse empty or blank values. The
/// number parser would read such a value as 0, and a path option as not given. Call once after all options
/// are declared. The parse then throws InputError with the name of the option.
void refuseEmptyValues(CLI::App& program);

/// Checks all numbers of a parsed call, of options of the subcommand and of the program. Refuses numbers that
/// are not plausible(), because NaN passes range tests, and numbers that the option's parser reads as
/// hexadecimal or octal. Throws InputError with the name of the option.
void checkNumbers(const CLI::App& command);

/// Refuses numbers outside [low, high], infinities and NaN. An infinite `high`, or both ends infinite, means
/// no bound.
CLI::Validator within(double low, double high);

/// Refuses values other than finite numbers >= 0.
CLI::Validator notNegative();

/// Refuses values other than finite numbers > 0.
CLI::Validator positive();

/// Refuses NaN and infinity.
CLI::Validator finite();

}  // namespace talus::cli
