#pragma once

#include <CLI/CLI.hpp>

namespace talus::cli {

/// Refuses, of a parsed call, every number that is not plausible(), whatever option it was given to: NaN passes a test of
/// a range; and one that is hexadecimal or octal to the option's parser. Throws InputError that names the option.
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
