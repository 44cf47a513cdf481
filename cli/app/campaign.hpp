#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <talus/common/common.hpp>

namespace talus::cli {

/// Results by job; a missing job is of another part, or was stopped.
using JobResults = std::map<std::size_t, std::string>;

/// Independent jobs, all of them or a part for an array job of a queue.
struct JobList {
  std::size_t count = 0;
  std::string part{};       ///< "K/N", 1 <= K <= N <= 10000: the jobs k with k modulo N = K - 1; empty: all
  std::string folder{};     ///< folder in which the parts keep and find their results; empty: none
  std::string identity{};   ///< text of the jobs and their inputs: results of another text are refused
  std::string what{};       ///< name of the jobs in messages, in plural
  std::size_t workers = 1;  ///< number of jobs that run concurrently without MPI
};

/// Creates a folder for results before the jobs run, so that an unusable path is reported immediately. Returns true if
/// it did not exist. @throws InputError
bool makeFolder(const std::string& folder);

/// Runs independent jobs: one after another, several at a time, or distributed over the ranks (processes) of
/// an MPI run, if mpirun started the program and the program was built with Boost.MPI. Job i runs on rank i
/// modulo the number of ranks; the results do not depend on the number of ranks.
class Campaign {
 public:
  /// Joins the MPI run in which the process was started, if any. Throws std::invalid_argument if the launcher
  /// belongs to another MPI implementation, so that its ranks could not connect to each other.
  Campaign();
  ~Campaign();
  Campaign(const Campaign&) = delete;
  Campaign& operator=(const Campaign&) = delete;

  /// Returns the number of ranks.
  int ranks() const noexcept;
  bool leads() const noexcept;  ///< true on rank 0, the only rank that receives results and prints

  /// Runs the jobs of the part and returns their results on rank 0; the result of a job that throws is its reason. After a
  /// stop request, each rank completes its current job; jobs not started, and jobs that return an empty text, have no
  /// result. Without MPI, `workers` jobs run concurrently and must be thread-safe; with MPI, a rank runs one at a time.
  /// With a folder, writes the results of the part to it, each with a checksum over the identity, and returns those of
  /// all parts, or prints how many there are and returns nullopt while some are missing. Other ranks return nullopt.
  /// Throws InputError, and writes nothing, for a result in the folder that is of other jobs or damaged.
  std::optional<JobResults> results(const JobList& jobs, const std::function<std::string(std::size_t)>& job,
                                    const ProgressMonitor& watch) const;

 private:
  struct Outcome;
  struct Ranks;

  std::vector<Outcome> run(std::size_t count, const std::function<std::string(std::size_t)>& job,
                           const ProgressMonitor& watch, std::size_t workers) const;
  std::vector<Outcome> runRanks(std::size_t count, const std::function<std::string(std::size_t)>& job,
                                const ProgressMonitor& watch) const;

  std::unique_ptr<Ranks> mpi_;  // null in a plain run
};

/// Throws std::invalid_argument in a program built without MPI of which a launcher started several ranks: each
/// would run the whole job and write the same files.
void requireMpiForRanks();

}  // namespace talus::cli
