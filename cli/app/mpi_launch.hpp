#pragma once

#include <optional>
#include <string>

namespace talus::cli {

/// What an MPI launcher (mpirun, mpiexec) told this process by its environment.
struct MpiLaunch {
  std::string variable;  ///< that says so
  int ranks = 1;         ///< processes it started
};

/// The launcher's word (Open MPI, MVAPICH2, MPICH and Intel MPI); none in a plain run.
std::optional<MpiLaunch> mpiLaunch();

/// Throws std::invalid_argument where a launcher started more ranks than `joined`, the number that work
/// together here: each would do the whole job and write the same files. `reason` says why they do not.
void requireJoinedRanks(int joined, const std::string& reason);

/// The same for a program built without MPI, in which no ranks work together; nothing in one built with it.
void requireMpiForRanks();

}  // namespace talus::cli
