#pragma once

namespace talus::cli {

/// Runs the program and returns its exit code; every error ends as one line on stderr.
int run(int argc, const char* const* argv);

}  // namespace talus::cli
