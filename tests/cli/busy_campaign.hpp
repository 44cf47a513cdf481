#pragma once

#include <string>

namespace talus::cli {

/// Runs a line of shell, which ends in the program or in mpirun, and interrupts that (SIGINT) as soon as so many of the campaign's runs,
/// processes of their own, are at work that takes long: each has used half a second of processor time. The exit code.
int interruptedWhenBusy(const std::string& line, int runs);

/// The same, interrupted as soon as the file is there.
int interruptedWhenWritten(const std::string& line, const std::string& file);

}  // namespace talus::cli
