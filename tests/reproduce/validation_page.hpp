#pragma once

namespace talus::cli {
struct Context;
struct ReproduceOptions;
}  // namespace talus::cli

namespace talus::reproduce {

/// Measures the estimators and draws the figures: prints the table alone, or writes validation.md and its pictures. Returns the
/// exit code.
int run(const cli::ReproduceOptions& options, cli::Context& context);

}  // namespace talus::reproduce
