#pragma once

#include <CLI/CLI.hpp>

namespace talus::cli {

/// Refuses a number outside [low, high], an infinite one and NaN; an infinite end does not bind.
CLI::Validator within(double low, double high);

/// Refuses what is not a finite number >= 0.
CLI::Validator notNegative();

/// Refuses what is not a finite number > 0.
CLI::Validator positive();

/// Refuses NaN and infinity.
CLI::Validator finite();

}  // namespace talus::cli
