#pragma once

#include <optional>
#include <string>

namespace talus::cli {

/// Launch of this process by an MPI launcher (mpirun, mpiexec), according to the environment variables of the
/// process.
struct MpiLaunch {
  std::string variable;  ///< environment variable that contains the number of ranks
  int ranks = 1;         ///< number of processes that the launcher started
};

/// Returns the launch by Open MPI, MVAPICH2, MPICH or Intel MPI; nullopt if the process was started without a
/// launcher.
std::optional<MpiLaunch> mpiLaunch();

/// Throws std::invalid_argument if the launcher started more ranks than the `joined` ranks that cooperate:
/// each rank would run the whole job and write the same files. `reason` is the cause that the message states.
void requireJoinedRanks(int joined, const std::string& reason);

/// Calls requireJoinedRanks() for one rank in a program built without MPI; has no effect in a program built
/// with MPI.
void requireMpiForRanks();

}  // namespace talus::cli
