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

/// Result of one job.
struct JobOutcome {
  bool failed = false;
  bool stopped = false;  ///< true if the job failed because a stop was requested before the job had a result
  std::string text;      ///< result of the job, or reason of its failure
};

/// Results by job; a missing job is of another part, or was stopped.
using JobResults = std::map<std::size_t, std::string>;

/// Part K of N of a list of jobs, for array jobs of a queue: the jobs k with k modulo N = K - 1.
class Part {
 public:
  /// Reads "K/N" with 1 <= K <= N <= 10000; empty: the whole list. @throws InputError
  explicit Part(const std::string& text);
  /// Returns the indices of the part's jobs of `count`.
  std::vector<std::size_t> of(std::size_t count) const;
  /// Returns the results of all parts in a folder and of this part (`own`), which is written to its file there. Each row
  /// has a checksum over `hash` (of the jobs and their inputs), job and result. Throws InputError, and writes
  /// nothing, for a row that is of other jobs or damaged.
  JobResults joined(const std::string& folder, const std::string& hash, const JobResults& own) const;
  /// Returns the result of joined(), or `own` for the whole list. Prints how many of `all` jobs, which are called `what`,
  /// are in the folder, and returns nullopt, while some are missing there.
  std::optional<JobResults> completed(const std::string& folder, const std::string& hash,
                                      const JobResults& own, std::size_t all, const char* what) const;

 private:
  bool stated_ = false;
  std::size_t index_ = 0, parts_ = 1;
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

  /// Returns on rank 0 the outcomes of job(0) .. job(count - 1) in order, and an empty vector on other ranks.
  /// A job that throws is marked as failed; the other jobs continue. After a stop request, each rank
  /// completes its current job; jobs not started, and jobs that return an empty text, are marked as failed
  /// and stopped. Without MPI, `workers` jobs run concurrently and must be thread-safe. With MPI, a rank runs
  /// one job at a time.
  std::vector<JobOutcome> run(std::size_t count, const std::function<std::string(std::size_t)>& job,
                              const ProgressMonitor& watch = {}, std::size_t workers = 1) const;

 private:
  struct Ranks;
  std::unique_ptr<Ranks> mpi_;  // null in a plain run
};

/// Throws std::invalid_argument in a program built without MPI of which a launcher started several ranks: each
/// would run the whole job and write the same files.
void requireMpiForRanks();

}  // namespace talus::cli
