#pragma once

#include <string>

namespace CLI {
class App;
}

namespace talus::cli {

/// The manual page talus(1), of all calls and their options.
std::string manualPage(const CLI::App& app);

/// A script for bash that completes calls, options and the words that an option takes.
std::string bashCompletion(const CLI::App& app);

}  // namespace talus::cli
