#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <stdexcept>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <planner/benchmark.hpp>
#include <planner/named_planner.hpp>
#include <planner/route_check.hpp>

namespace talus::planner {
namespace {

using Clock = std::chrono::steady_clock;

// What a run sends home through a pipe: this, then its progress. Same program on both ends, so the layout
// agrees.
struct Answer {
  RouteStatus status = RouteStatus::NoRoute;
  bool breached = false;
  double seconds = 0.0, cost_J = 0.0, lower_bound_J = 0.0, length_m = 0.0;
  int turns = 0;
  double megabytes = 0.0;
};

double lengthOf(const std::vector<maps::Point>& points) {
  double metres = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i)
    metres += std::hypot(points[i].x_m - points[i - 1].x_m, points[i].y_m - points[i - 1].y_m);
  return metres;
}

void sendAll(int pipe, const void* data, std::size_t bytes) {
  const char* from = static_cast<const char*>(data);
  while (bytes > 0) {
    const ssize_t sent = write(pipe, from, bytes);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return;
    from += sent;
    bytes -= static_cast<std::size_t>(sent);
  }
}

std::string receivedAll(int pipe) {
  std::string bytes;
  char part[4096];
  for (;;) {
    const ssize_t got = read(pipe, part, sizeof part);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return bytes;
    bytes.append(part, static_cast<std::size_t>(got));
  }
}

std::string answered(const BenchmarkPlan& plan, const BenchmarkJob& job) {
  const BenchmarkCase& asked = plan.cases[job.case_index];
  std::vector<CostAtTime> progress;
  const auto begin = Clock::now();
  const auto elapsed = [begin] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
  NamedPlanner named(job.planner);
  const auto note = [&](double cost_J) {
    // A planner starts from a route it was given; its own first ones may be worse.
    if (progress.empty() || cost_J < progress.back().cost_J) progress.push_back({elapsed(), cost_J});
  };
  named.onBetter(note);
  Problem problem;
  problem.map = asked.map;
  problem.start = asked.start;
  problem.goal = asked.goal;
  problem.time_limit_s = plan.time_limit_s;
  problem.seed = job.seed;
  const Plan found = named.plan(problem);
  if (found.status == RouteStatus::Found) note(found.cost_J);
  const Answer result{.status = found.status,
                      .breached = !found.points.empty() && !violations(*asked.map, found.points).empty(),
                      .seconds = elapsed(),
                      .cost_J = found.cost_J,
                      .lower_bound_J = found.lower_bound_J,
                      .length_m = lengthOf(found.points),
                      .turns = std::max(0, static_cast<int>(found.points.size()) - 2),
                      .megabytes = 0.0};
  std::string bytes(sizeof result + progress.size() * sizeof(CostAtTime), '\0');
  std::memcpy(bytes.data(), &result, sizeof result);
  if (!progress.empty())
    std::memcpy(bytes.data() + sizeof result, progress.data(), bytes.size() - sizeof result);
  return bytes;
}

}  // namespace

std::string runIsolated(const BenchmarkPlan& plan, const BenchmarkJob& job) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error(std::string("no pipe for a run: ") + std::strerror(errno));
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error(std::string("no process for a run: ") + std::strerror(errno));
  if (child == 0) {
    close(ends[0]);
    alarm(static_cast<unsigned>(std::min(1e6, 10.0 * plan.time_limit_s + 60.0)));  // a run-away ends here
    try {
      const std::string bytes = answered(plan, job);
      sendAll(ends[1], bytes.data(), bytes.size());
    } catch (...) {  // the border of the process: no answer is the answer
      _exit(1);
    }
    _exit(0);
  }
  close(ends[1]);
  std::string bytes = receivedAll(ends[0]);
  close(ends[0]);
  rusage used{};
  wait4(child, nullptr, 0, &used);
  if (bytes.size() < sizeof(Answer)) return {};
  const double megabytes = static_cast<double>(used.ru_maxrss) / 1024.0;
  std::memcpy(bytes.data() + offsetof(Answer, megabytes), &megabytes, sizeof megabytes);
  return bytes;
}

BenchmarkRun benchmarkRun(const BenchmarkJob& job, const std::string& bytes) {
  BenchmarkRun run;
  run.planner = job.planner;
  run.case_index = job.case_index;
  run.seed = job.seed;
  run.crashed = bytes.size() < sizeof(Answer);
  if (run.crashed) return run;
  Answer result;
  std::memcpy(&result, bytes.data(), sizeof result);
  run.progress.resize((bytes.size() - sizeof result) / sizeof(CostAtTime));
  if (!run.progress.empty())
    std::memcpy(run.progress.data(), bytes.data() + sizeof result, run.progress.size() * sizeof(CostAtTime));
  run.status = result.status;
  run.breached = result.breached;
  run.seconds = result.seconds;
  run.megabytes = result.megabytes;
  run.cost_J = result.cost_J;
  run.lower_bound_J = result.lower_bound_J;
  run.length_m = result.length_m;
  run.turns = result.turns;
  return run;
}

std::vector<BenchmarkJob> jobsOf(const BenchmarkPlan& plan) {
  std::vector<BenchmarkJob> jobs;
  for (const std::string& planner : plan.planners)
    for (std::size_t c = 0; c < plan.cases.size(); ++c)
      for (int seed = 1; seed <= plan.seeds; ++seed)
        jobs.push_back({.planner = planner, .case_index = c, .seed = static_cast<std::uint64_t>(seed)});
  return jobs;
}

std::vector<BenchmarkRun> runBenchmark(const BenchmarkPlan& plan, const Watch& watch) {
  const std::vector<BenchmarkJob> jobs = jobsOf(plan);
  std::vector<BenchmarkRun> runs;
  for (const BenchmarkJob& job : jobs) {
    if (watch.stopped()) return runs;
    runs.push_back(benchmarkRun(job, runIsolated(plan, job)));
    watch.report(static_cast<double>(runs.size()) / static_cast<double>(jobs.size()));
  }
  return runs;
}

double bestKnown_J(const BenchmarkPlan& plan, const std::vector<BenchmarkRun>& runs, std::size_t case_index) {
  if (std::isfinite(plan.cases[case_index].optimum_J)) return plan.cases[case_index].optimum_J;
  double best_J = std::numeric_limits<double>::infinity();
  for (const BenchmarkRun& run : runs)
    if (run.case_index == case_index && !run.breached) best_J = std::min(best_J, run.cost_J);
  return best_J;
}

}  // namespace talus::planner
