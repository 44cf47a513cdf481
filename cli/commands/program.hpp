#pragma once

namespace CLI {
class App;
}

namespace talus::cli {

struct Context;

/// Runs the program with the subcommands that the function `add` registers, and returns the exit code. Every
/// error is printed as one line to stderr.
int run(int argc, const char* const* argv, void (*add)(CLI::App&, Context&));

}  // namespace talus::cli
