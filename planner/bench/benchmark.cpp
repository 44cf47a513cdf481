#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <sstream>

#include <talus/planner/bench/benchmark.hpp>
#include <talus/planner/bench/slip_world.hpp>
#include <talus/planner/check/route_check.hpp>
#include <talus/planner/plan/named_planner.hpp>
#include <talus/planner/plugin/plugin_planner.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::planner {

namespace {

using Clock = std::chrono::steady_clock;

// Result of a run as sent through the pipe, followed by the progress. Both ends run the same program, so the
// memory layout is identical.
struct RunResult {
  RouteStatus status = RouteStatus::NoneFound;
  bool breached = false;
  double seconds = 0.0, cost_J = 0.0, lower_bound_J = 0.0, length_m = 0.0;
  int turns = 0;
  RouteShape drive;
  double clearance_cells = 0.0;
  double megabytes = 0.0;
  SlipTraverse went;
};

double lengthOf(const std::vector<maps::Point>& points) {
  double metres = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i)
    metres += std::hypot(points[i].x_m - points[i - 1].x_m, points[i].y_m - points[i - 1].y_m);
  return metres;
}

bool breached(const BenchmarkCase& asked, const Plan& found) {
  return found.refused || (!found.points.empty() && !violations(*asked.map, found.points).empty()) ||
         (!found.drive.legs.empty() &&
          !violations(*asked.map, found.drive, asked.kinematics.turning_radius_m).empty());
}

// Returns the smallest distance [cells] of points on the route, half a cell apart, to a cell without a drive
// curve; at most 10.
double clearance_cells(const costmap::CostGrid& map, const std::vector<maps::Point>& points) {
  constexpr int kReach = 10;
  const maps::Grid& grid = map.grid();
  double least = kReach;
  for (const maps::Point p : subdivided(points, 0.5 * grid.resolution_m)) {
    const double x = (p.x_m - grid.south_west.x_m) / grid.resolution_m,
                 y = (p.y_m - grid.south_west.y_m) / grid.resolution_m;
    const int reach = static_cast<int>(std::ceil(least)), column = static_cast<int>(x),
              row = static_cast<int>(y);
    for (int r = row - reach; r <= row + reach; ++r)
      for (int c = column - reach; c <= column + reach; ++c) {
        if (!grid.contains({c, r}) || map.at({c, r}).curve() < map.cost().curves().size()) continue;
        least =
            std::min(least, std::hypot(std::max({c - x, x - c - 1, 0.0}), std::max({r - y, y - r - 1, 0.0})));
      }
  }
  return least;
}

std::string answered(const BenchmarkPlan& plan, const BenchmarkJob& job) {
  const BenchmarkCase& asked = plan.cases[job.case_index];
  std::vector<CostAtTime> progress;
  const auto begin = Clock::now();
  const auto elapsed = [begin] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
  const auto plugin = plan.plugins.find(job.planner);
  NamedPlanner named(plugin == plan.plugins.end() ? job.planner : std::string());
  const auto note = [&](double cost_J) {
    // A planner may start from a given route; its own first routes may cost more and are not recorded.
    if (progress.empty() || cost_J < progress.back().cost_J) progress.push_back({elapsed(), cost_J});
  };
  named.onBetter(note);
  Problem problem;
  problem.map = asked.map;
  problem.start = asked.start;
  problem.goal = asked.goal;
  problem.time_limit_s = plan.time_limit_s;
  problem.seed = job.seed;
  problem.kinematics = asked.kinematics;
  const Plan found =
      plugin == plan.plugins.end() ? named.plan(problem) : PluginPlanner(plugin->second).plan(problem);
  // Costs reported during planning were not checked: costs below that of the final route are removed.
  if (found.status != RouteStatus::Found) progress.clear();
  std::erase_if(progress, [&](const CostAtTime& at) { return at.cost_J < found.cost_J; });
  if (found.status == RouteStatus::Found) note(found.cost_J);
  const double seconds = elapsed();
  const RunResult result{.status = found.status,
                         .breached = breached(asked, found),
                         .seconds = seconds,
                         .cost_J = found.cost_J,
                         .lower_bound_J = found.lower_bound_J,
                         .length_m = lengthOf(found.points),
                         .turns = std::max(0, static_cast<int>(found.points.size()) - 2),
                         .drive = shape(found.drive),
                         .clearance_cells = clearance_cells(*asked.map, found.points),
                         .megabytes = 0.0,
                         .went = asked.world ? driven(*asked.world, found.points) : SlipTraverse{}};
  std::string bytes(sizeof result + progress.size() * sizeof(CostAtTime), '\0');
  std::memcpy(bytes.data(), &result, sizeof result);
  if (!progress.empty())
    std::memcpy(bytes.data() + sizeof result, progress.data(), bytes.size() - sizeof result);
  return bytes;
}

}  // namespace

std::string runIsolated(const BenchmarkPlan& plan, const BenchmarkJob& job, const ProgressMonitor& watch) {
  const double longest_s = std::min(1e6, 10.0 * plan.time_limit_s + 60.0);  // time limit of the child process
  const ChildAnswer answer = inChild([&] { return answered(plan, job); }, {.seconds = longest_s}, watch);
  if (answer.bytes.size() < sizeof(RunResult)) return {};
  RunResult result;
  std::memcpy(&result, answer.bytes.data(), sizeof result);
  result.megabytes = answer.megabytes;
  return std::string(reinterpret_cast<const char*>(&result), sizeof result) +
         answer.bytes.substr(sizeof result);
}

BenchmarkRun benchmarkRun(const BenchmarkJob& job, const std::string& bytes) {
  BenchmarkRun run;
  run.planner = job.planner;
  run.case_index = job.case_index;
  run.seed = job.seed;
  run.crashed = bytes.size() < sizeof(RunResult);
  if (run.crashed) return run;
  RunResult result;
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
  run.cusps = result.drive.cusps;
  run.turns_in_place = result.drive.turns_in_place;
  run.max_curvature_1_m = result.drive.max_curvature_1_m;
  run.clearance_cells = result.clearance_cells;
  run.reached = result.status == RouteStatus::Found && result.went.reached;
  run.drive_s = result.went.time_s;
  run.max_slip = result.went.max_slip;
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

bool stands(const BenchmarkRun& run) noexcept {
  return run.status == RouteStatus::Found && !run.crashed && !run.breached;
}

double bestKnown_J(const BenchmarkPlan& plan, const std::vector<BenchmarkRun>& runs, std::size_t case_index) {
  if (std::isfinite(plan.cases[case_index].optimum_J)) return plan.cases[case_index].optimum_J;
  double best_J = std::numeric_limits<double>::infinity();
  for (const BenchmarkRun& run : runs)
    if (run.case_index == case_index && stands(run)) best_J = std::min(best_J, run.cost_J);
  return best_J;
}

namespace {

// OMPL's PlannerStatus::StatusType in order.
constexpr const char* kStatusNames =
    "Unknown status|Invalid start|Invalid goal|Unrecognized goal type|Timeout|Approximate solution|Exact "
    "solution|Crash|"
    "Abort";

int omplStatus(const BenchmarkRun& run) {
  if (run.crashed) return 7;
  switch (run.status) {
    case RouteStatus::Found:
      return 6;
    case RouteStatus::StartInvalid:
      return 1;
    case RouteStatus::GoalInvalid:
      return 2;
    case RouteStatus::Cancelled:
      return 8;
    case RouteStatus::NoRoute:
    case RouteStatus::NoneFound:
    case RouteStatus::TimedOut:
      return 4;
  }
  return 0;
}

// OMPL omits missing values: an empty field between semicolons.
std::string number(double value) {
  if (!std::isfinite(value)) return {};
  std::ostringstream text;
  text.precision(10);
  text << value;
  return text.str();
}

void writeRuns(std::ostream& log, const std::vector<const BenchmarkRun*>& runs, double best_J) {
  log << "13 properties for each run\ntime REAL\nmemory REAL\nstatus ENUM\nsolved BOOLEAN\ncorrect solution "
         "BOOLEAN\n"
         "solution cost REAL\nsolution length REAL\nsolution turns INTEGER\ngap to best known REAL\n"
         "solution cusps INTEGER\nturns in place INTEGER\nmax curvature REAL\nclearance in cells REAL\n"
      << runs.size() << " runs\n";
  for (const BenchmarkRun* run : runs) {
    const bool solved = run->status == RouteStatus::Found && !run->crashed;
    log << number(run->seconds) << "; " << number(run->megabytes) << "; " << omplStatus(*run) << "; "
        << solved << "; " << (solved && !run->breached) << "; " << (solved ? number(run->cost_J) : "") << "; "
        << (solved ? number(run->length_m) : "") << "; " << (solved ? std::to_string(run->turns) : "") << "; "
        << (solved ? number(run->cost_J / best_J - 1.0) : "") << "; "
        << (solved ? std::to_string(run->cusps) : "") << "; "
        << (solved ? std::to_string(run->turns_in_place) : "") << "; "
        << (solved ? number(run->max_curvature_1_m) : "") << "; "
        << (solved ? number(run->clearance_cells) : "") << "; \n";
  }
  log << "2 progress properties for each run\ntime REAL\nbest cost REAL\n" << runs.size() << " runs\n";
  for (const BenchmarkRun* run : runs) {
    for (std::size_t i = 0; i < run->progress.size(); ++i) {
      const CostAtTime& at = run->progress[i];
      // Run and time form a key in Planner Arena's tables, so only the last entry of equal times is written.
      const bool again =
          i + 1 < run->progress.size() && number(run->progress[i + 1].seconds) == number(at.seconds);
      if (!again) log << number(at.seconds) << "," << number(at.cost_J) << ",;";
    }
    log << "\n";
  }
  log << ".\n";
}

// Planner Arena reads the last word of the line as the experiment's name.
std::string oneWord(std::string name) {
  for (char& c : name)
    if (std::isspace(static_cast<unsigned char>(c))) c = '_';
  return name;
}

// Note for a case with fewer runs than planned, because of a stop.
std::string cutShort(const BenchmarkPlan& plan, const std::vector<BenchmarkRun>& runs,
                     std::size_t case_index) {
  const auto asked = plan.planners.size() * static_cast<std::size_t>(plan.seeds);
  const auto made = static_cast<std::size_t>(
      std::ranges::count_if(runs, [&](const BenchmarkRun& run) { return run.case_index == case_index; }));
  return made == asked ? ""
                       : "\ncancelled: " + std::to_string(made) + " of " + std::to_string(asked) + " runs";
}

}  // namespace

std::string benchmarkLog(const BenchmarkPlan& plan, const std::vector<BenchmarkRun>& runs,
                         std::size_t case_index) {
  const BenchmarkCase& asked = plan.cases[case_index];
  const maps::Grid& grid = asked.map->grid();
  std::ostringstream log;
  // The host name is omitted: equal runs give equal logs except for date, seconds and megabytes.
  log << "OMPL version 1.5.2\nExperiment " << oneWord(asked.name)
      << "\n3 experiment properties\nwidth INTEGER = " << grid.width << "\nheight INTEGER = " << grid.height
      << "\nresolution_m REAL = " << grid.resolution_m << "\nRunning on talus\nStarting at " << plan.began
      << "\n<<<|\nfrom " << asked.start.x_m << "," << asked.start.y_m << " to " << asked.goal.x_m << ","
      << asked.goal.y_m << cutShort(plan, runs, case_index) << "\n|>>>\n1 is the random seed\n"
      << plan.time_limit_s << " seconds per run\n0 MB per run\n"
      << plan.seeds << " runs per planner\n";
  double total_s = 0.0;
  for (const BenchmarkRun& run : runs)
    if (run.case_index == case_index) total_s += run.seconds;
  log << total_s << " seconds spent to collect the data\n1 enum type\nstatus|" << kStatusNames << "\n"
      << plan.planners.size() << " planners\n";
  const double best_J = bestKnown_J(plan, runs, case_index);
  for (const std::string& planner : plan.planners) {
    std::vector<const BenchmarkRun*> own;
    for (const BenchmarkRun& run : runs)
      if (run.case_index == case_index && run.planner == planner) own.push_back(&run);
    log << planner << "\n0 common properties\n";
    writeRuns(log, own, best_J);
  }
  return log.str();
}

}  // namespace talus::planner
