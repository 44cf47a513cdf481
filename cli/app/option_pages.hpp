#pragma once

#include <string>

namespace CLI {
class App;
}

namespace talus::cli {

/// Returns the manual page talus(1) with all subcommands and their options.
std::string manualPage(const CLI::App& app);

/// Returns a bash script that completes subcommands, options and the choices of an option.
std::string bashCompletion(const CLI::App& app);

}  // namespace talus::cli
