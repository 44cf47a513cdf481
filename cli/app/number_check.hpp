#pragma once

#include <CLI/CLI.hpp>

namespace talus::cli {

/// Makes every option and argument of the program and its subcommands refuse a value that is empty or blank: to the
/// parser of numbers it is 0, and to a path it is as if nothing had been given. Call it once all options are declared.
/// The parse then throws InputError that names the option.
void refuseEmptyValues(CLI::App& program);

/// Refuses, of a parsed call, every number that is not plausible(), whatever option of the subcommand or the program it
/// was given to: NaN passes a test of a range; and one that is hexadecimal or octal to the option's parser. Throws
/// InputError that names the option.
void checkNumbers(const CLI::App& command);

/// Refuses a number outside [low, high], an infinite one and NaN; an infinite end does not bind.
CLI::Validator within(double low, double high);

/// Refuses what is not a finite number >= 0.
CLI::Validator notNegative();

/// Refuses what is not a finite number > 0.
CLI::Validator positive();

/// Refuses NaN and infinity.
CLI::Validator finite();

}  // namespace talus::cli
