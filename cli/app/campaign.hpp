#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <talus/common/progress_monitor.hpp>

namespace talus::cli {

/// What became of one job.
struct JobOutcome {
  bool failed = false;
  bool stopped = false;  ///< failed because a stop was requested before it had an answer
  std::string text;      ///< the job's result, or why it failed
};

/// Many independent jobs, one after another or some at a time, or over the ranks of an MPI run when the
/// program was started by mpirun and built with Boost.MPI. Job i runs on rank i modulo their number, so
/// results do not depend on how many there are.
class Campaign {
 public:
  /// Joins the MPI run that the process was started in, if any. Throws std::invalid_argument where the
  /// launcher belongs to another MPI, so that its ranks would not know of each other.
  Campaign();
  ~Campaign();
  Campaign(const Campaign&) = delete;
  Campaign& operator=(const Campaign&) = delete;

  int ranks() const noexcept;
  bool leads() const noexcept;  ///< rank 0, the only one that gets the results and prints

  /// Outcomes of job(0) .. job(count - 1) in order; empty on the other ranks. A job that throws has failed
  /// and stops nothing; a requested stop ends each rank after its job in work, and the rest have failed and
  /// say that they were stopped, as does a job in work that answers with an empty text. In a plain run
  /// `workers` jobs run at a time, which must then be safe to; a rank runs one.
  std::vector<JobOutcome> run(std::size_t count, const std::function<std::string(std::size_t)>& job,
                              const ProgressMonitor& watch = {}, std::size_t workers = 1) const;

 private:
  struct Ranks;
  std::unique_ptr<Ranks> mpi_;  // null in a plain run
};

}  // namespace talus::cli
