#pragma once

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

}  // namespace talus::cli
