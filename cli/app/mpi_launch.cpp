#include <cstdlib>
#include <stdexcept>

#include <fmt/format.h>

#include <talus/cli/app/mpi_launch.hpp>

namespace talus::cli {

std::optional<MpiLaunch> mpiLaunch() {
  for (const char* variable : {"OMPI_COMM_WORLD_SIZE", "MV2_COMM_WORLD_SIZE", "PMI_SIZE"})
    if (const char* ranks = std::getenv(variable)) return MpiLaunch{variable, std::atoi(ranks)};
  return std::nullopt;
}

void requireJoinedRanks(int joined, const std::string& reason) {
  const auto launch = mpiLaunch();
  if (!launch || launch->ranks <= joined) return;
  throw std::invalid_argument(
      fmt::format("started as one of {} MPI ranks ({}), each of which would do the whole job: {}",
                  launch->ranks, launch->variable, reason));
}

void requireMpiForRanks() {
#ifndef TALUS_MPI
  requireJoinedRanks(
      1,
      "this program was built without MPI; start it without mpirun, or install libboost-mpi-dev "
      "and libopenmpi-dev and build again");
#endif
}

}  // namespace talus::cli
