#pragma once

#include <string>

namespace talus::cli {

/// Runs a shell line that executes talus or mpirun and sends SIGINT once `runs` runs of the campaign
/// (processes) have used 0.5 s of CPU time each. Returns the exit code.
int interruptedWhenBusy(const std::string& line, int runs);

/// Runs a shell line and sends SIGINT as soon as the file exists. Returns the exit code.
int interruptedWhenWritten(const std::string& line, const std::string& file);

}  // namespace talus::cli
