#pragma once

#include <optional>
#include <string>

namespace talus::cli {

/// MPI launch (mpirun, mpiexec) of this process according to its environment.
struct MpiLaunch {
  std::string variable;  ///< environment variable that contains the number of ranks
  int ranks = 1;         ///< number of processes started
};

/// Launch by Open MPI, MVAPICH2, MPICH or Intel MPI; nothing if the process was started without a launcher.
std::optional<MpiLaunch> mpiLaunch();

/// Throws std::invalid_argument if the launcher started more ranks than the `joined` ranks that cooperate:
/// each rank would run the whole job and write the same files. `reason` is the cause in the message.
void requireJoinedRanks(int joined, const std::string& reason);

/// requireJoinedRanks() for one rank in a program built without MPI; no effect in a program built with MPI.
void requireMpiForRanks();

}  // namespace talus::cli
