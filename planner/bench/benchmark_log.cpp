#include <algorithm>
#include <cctype>
#include <cmath>
#include <sstream>

#include <talus/planner/bench/benchmark_log.hpp>

namespace talus::planner {
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
