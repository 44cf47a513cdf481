#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <talus/cli/app/campaign.hpp>
#include <talus/cli/app/context.hpp>
#include <talus/common/checksum.hpp>
#include <talus/common/common.hpp>
#include <talus/common/output_file.hpp>
#include <talus/common/parallel_for.hpp>
#include <talus/terramech/io/csv_reader.hpp>

#ifdef TALUS_MPI
#include <boost/mpi/communicator.hpp>
#include <boost/mpi/environment.hpp>
#include <boost/serialization/string.hpp>
#endif

namespace talus::cli {
namespace {

/// Launch of this process by an MPI launcher (mpirun, mpiexec), according to the environment variables of the
/// process.
struct MpiLaunch {
  std::string variable;  ///< environment variable that contains the number of ranks
  int ranks = 1;         ///< number of processes that the launcher started
};

/// Returns the launch by Open MPI, MVAPICH2, MPICH or Intel MPI; nullopt if the process was started without a
/// launcher.
std::optional<MpiLaunch> mpiLaunch() {
  for (const char* variable : {"OMPI_COMM_WORLD_SIZE", "MV2_COMM_WORLD_SIZE", "PMI_SIZE"})
    if (const char* ranks = std::getenv(variable)) return MpiLaunch{variable, std::atoi(ranks)};
  return std::nullopt;
}

/// Throws std::invalid_argument if the launcher started more ranks than the `joined` ranks that cooperate:
/// each rank would run the whole job and write the same files. `reason` is the cause that the message states.
void requireJoinedRanks(int joined, const std::string& reason) {
  const auto launch = mpiLaunch();
  if (!launch || launch->ranks <= joined) return;
  throw std::invalid_argument(
      fmt::format("started as one of {} MPI ranks ({}), each of which would do the whole job: {}",
                  launch->ranks, launch->variable, reason));
}

/// Part of a list of jobs: the jobs k with k modulo `parts` = `index`.
struct Part {
  std::size_t index = 0, parts = 1;
};

// The part that a text K/N names.
Part partOf(const std::string& text) {
  if (text.empty()) return {};
  int index = 0, parts = 0, end = 0;
  if (std::sscanf(text.c_str(), "%5d/%5d%n", &index, &parts, &end) != 2 ||
      end != static_cast<int>(text.size()) || index < 1 || index > parts || parts > 10000)
    throw InputError({"--part " + text, "is not K/N with K from 1 to N", "write --part 1/4"});
  return {static_cast<std::size_t>(index - 1), static_cast<std::size_t>(parts)};
}

}  // namespace

bool makeFolder(const std::string& folder) {
  std::error_code error;
  const bool made = std::filesystem::create_directories(folder, error);
  if (error)
    throw InputError({folder, "cannot be created: " + error.message(), "name another folder with -o"});
  const OutputFile can_be_written(std::filesystem::path(folder) / "table.txt");
  return made;
}

namespace {

// A row of a part: job, checksum over identity, job and result, and the result in hexadecimal digits.
std::string rowOf(std::size_t job, const std::string& identity, const std::string& text) {
  const std::string whole = fmt::format("{} {} {}", identity, job, text);
  Checksum sum;
  sum.add(whole.data(), whole.size());
  std::string row = fmt::format("{},{:016x},", job, sum.value());
  for (const char c : text) row += fmt::format("{:02x}", static_cast<unsigned char>(c));
  return row;
}

// The results of all parts in the folder of the jobs and of this part (`own`), which is written to its file there.
JobResults joined(const JobList& jobs, const Part& part, const JobResults& own) {
  JobResults results = own;
  for (const auto& entry : std::filesystem::directory_iterator(jobs.folder)) {
    if (!entry.path().filename().string().starts_with("part_")) continue;
    terramech::CsvReader reader(entry.path().string());
    for (terramech::CsvRow row; reader.next(row);) {
      double job = -1.0;
      std::string text;
      if (row.fields.size() == 3 && terramech::parseNumber(row.fields[0], job))
        for (std::size_t i = 0; i + 1 < row.fields[2].size(); i += 2)
          text += static_cast<char>(std::strtol(row.fields[2].substr(i, 2).c_str(), nullptr, 16));
      const bool counts = job >= 0.0 && job < 1e9;
      const std::size_t index = counts ? static_cast<std::size_t>(job) : 0;
      if (!counts || rowOf(index, jobs.identity, text) != fmt::format("{}", fmt::join(row.fields, ",")))
        throw InputError({fmt::format("{}:{}", entry.path().string(), row.line),
                          "is not of these jobs and their options, or damaged",
                          "name another folder with -o, or remove the file"});
      results.emplace(index, std::move(text));
    }
  }
  std::string rows = "job,checksum,result\n";
  for (const auto& [job, text] : own) rows += rowOf(job, jobs.identity, text) + "\n";
  writeFile(std::filesystem::path(jobs.folder) / fmt::format("part_{}_of_{}.csv", part.index + 1, part.parts),
            rows);
  return results;
}

}  // namespace

// The outcome of a job, which a rank sends as one message.
struct Campaign::Outcome {
  std::size_t job = 0;
  bool stopped = false;  // true if a stop was requested before the job had a result
  std::string text;      // result of the job, or reason of its failure

  static Outcome of(const std::function<std::string(std::size_t)>& job, std::size_t i,
                    const ProgressMonitor& watch) {
    if (watch.stopped()) return {i, true, {}};
    try {
      const std::string text = job(i);
      return {i, text.empty() && watch.stopped(), text};
    } catch (const std::exception& error) {
      return {i, false, error.what()};
    }
  }

  template <typename Archive>
  void serialize(Archive& archive, unsigned) {
    archive& job& stopped& text;
  }
};

std::optional<JobResults> Campaign::results(const JobList& jobs,
                                            const std::function<std::string(std::size_t)>& job,
                                            const ProgressMonitor& watch) const {
  const Part part = partOf(jobs.part);
  const bool joins = !jobs.part.empty() && !jobs.folder.empty();
  if (joins && leads()) makeFolder(jobs.folder);
  std::vector<std::size_t> own;
  for (std::size_t k = part.index; k < jobs.count; k += part.parts) own.push_back(k);
  const auto outcomes = run(
      own.size(), [&](std::size_t i) { return job(own[i]); }, watch, jobs.workers);
  if (!leads()) return std::nullopt;
  JobResults results;
  for (const Outcome& one : outcomes)
    if (!one.stopped) results[own[one.job]] = one.text;
  if (!joins || watch.stopped()) return results;
  results = joined(jobs, part, results);
  if (results.size() == jobs.count) return results;
  print(fmt::format("part {}: {} of {} {} are in {}\n", jobs.part, results.size(), jobs.count, jobs.what,
                    jobs.folder));
  return std::nullopt;
}

#ifdef TALUS_MPI

struct Campaign::Ranks {
  boost::mpi::environment environment;
  boost::mpi::communicator world;
};

Campaign::Campaign() {
  if (!mpiLaunch()) return;
  mpi_ = std::make_unique<Ranks>();
  const int joined = ranks();
  if (joined < mpiLaunch()->ranks)
    mpi_.reset();  // ~environment() would abort the process during the exception
  requireJoinedRanks(joined,
                     "the launcher belongs to another MPI than this program; start it by Open MPI's mpirun");
}

int Campaign::ranks() const noexcept {
  return mpi_ ? mpi_->world.size() : 1;
}
bool Campaign::leads() const noexcept {
  return !mpi_ || mpi_->world.rank() == 0;
}

// Rank 0 runs its own jobs and receives the outcomes of other ranks between them, then the remaining
// outcomes.
std::vector<Campaign::Outcome> Campaign::runRanks(std::size_t count,
                                                  const std::function<std::string(std::size_t)>& job,
                                                  const ProgressMonitor& watch) const {
  constexpr int kTag = 1;
  const boost::mpi::communicator& world = mpi_->world;
  std::vector<Outcome> outcomes;
  const auto keep = [&](Outcome outcome) {
    outcomes.push_back(std::move(outcome));
    watch.report(static_cast<double>(outcomes.size()) / static_cast<double>(count));
  };
  const auto receive = [&] {
    Outcome outcome;
    world.recv(boost::mpi::any_source, kTag, outcome);
    keep(std::move(outcome));
  };
  for (auto i = static_cast<std::size_t>(world.rank()); i < count; i += static_cast<std::size_t>(ranks())) {
    Outcome own = Outcome::of(job, i, watch);
    if (!leads()) {
      world.send(0, kTag, own);
      continue;
    }
    while (world.iprobe(boost::mpi::any_source, kTag)) receive();
    keep(std::move(own));
  }
  while (leads() && outcomes.size() < count) receive();
  return outcomes;
}

#else

struct Campaign::Ranks {};

Campaign::Campaign() = default;
int Campaign::ranks() const noexcept {
  return 1;
}
bool Campaign::leads() const noexcept {
  return true;
}

std::vector<Campaign::Outcome> Campaign::runRanks(std::size_t, const std::function<std::string(std::size_t)>&,
                                                  const ProgressMonitor&) const {
  return {};
}

#endif

Campaign::~Campaign() = default;

// In one process, each job writes its own element of the result, so that the order of the jobs does not matter. Only the
// caller's thread reports progress.
std::vector<Campaign::Outcome> Campaign::run(std::size_t count,
                                             const std::function<std::string(std::size_t)>& job,
                                             const ProgressMonitor& watch, std::size_t workers) const {
  if (mpi_) return runRanks(count, job, watch);
  std::vector<Outcome> outcomes(count);
  std::atomic<std::size_t> done{0};
  const auto caller = std::this_thread::get_id();
  parallelFor(count, static_cast<int>(workers), [&](std::size_t i) {
    outcomes[i] = Outcome::of(job, i, watch);
    ++done;
    if (std::this_thread::get_id() == caller)
      watch.report(static_cast<double>(done) / static_cast<double>(count));
  });
  return outcomes;
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
