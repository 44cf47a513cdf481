#pragma once

#include <string>

namespace talus::cli {

/// Runs a shell line that executes talus or mpirun and sends SIGINT once `runs` runs of the campaign
/// (processes) have used 0.5 s of CPU time each. Returns the exit code.
int interruptedWhenBusy(const std::string& line, int runs);

}  // namespace talus::cli
