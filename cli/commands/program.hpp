#pragma once

namespace CLI {
class App;
}

namespace talus::cli {

struct Context;

/// Runs the program with the subcommands that `add` registers and returns its exit code; every error ends as one line on stderr.
int run(int argc, const char* const* argv, void (*add)(CLI::App&, Context&));

}  // namespace talus::cli
