// talus bench SUITE: compares planners on the same problems.
#include <algorithm>
#include <ctime>
#include <filesystem>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <talus/cli/app/campaign.hpp>
#include <talus/cli/app/command.hpp>
#include <talus/cli/app/commands.hpp>
#include <talus/cli/app/number_check.hpp>
#include <talus/cli/app/output_file.hpp>
#include <talus/cli/ground/motion_options.hpp>
#include <talus/cli/ground/plan_options.hpp>
#include <talus/cli/study/bench_report.hpp>
#include <talus/cli/study/bench_suite.hpp>
#include <talus/common/input_error.hpp>
#include <talus/common/progress_monitor.hpp>
#include <talus/planner/bench/benchmark_log.hpp>
#include <talus/planner/sampling/sampling_settings.hpp>

namespace talus::cli {
namespace {

struct BenchOptions {
  SuiteOptions suite;
  std::vector<std::string> planners, plugins;
  int runs = 3;
  double time_limit_s = 2.0;
  std::string folder = "bench";
};

void bind(CLI::App& command, BenchOptions& options) {
  command
      .add_option("suite", options.suite.names,
                  "one or more of: generated (crater field, dunes, rocks), slip (uncertain slip; routes are "
                  "driven over the true slip), grids (walls, known optimum), an elevation file, a MovingAI "
                  ".scen beside its .map")
      ->capture_default_str();
  command
      .add_option("--planners", options.planners,
                  "planners to compare, separated by commas (default: all). OMPL's begin with the field's "
                  "route, but those with "
                  ":cold; NAME:range=20 sets a parameter by OMPL's name")
      ->delimiter(',');
  command.add_option("--plugin", options.plugins, "planner plugin to compare, too; may be repeated")
      ->type_name("FILE.so");
  command.add_option("--runs", options.runs, "runs per case and planner, each with its own seed")
      ->check(positive())
      ->capture_default_str();
  command.add_option("--time", options.time_limit_s, "time limit of one run")
      ->type_name("S")
      ->check(positive())
      ->capture_default_str();
  command.add_option("--pairs", options.suite.pairs, "start and goal pairs per map")
      ->check(positive())
      ->capture_default_str();
  command
      .add_option("--turning-radius", options.suite.turning_radius_m,
                  "minimum turning radius of planners with kinematics; 0: the rover turns in place (default: "
                  "the rover's)")
      ->type_name("METRES")
      ->check(turningRadius());
  command.add_option("--side", options.suite.side_cells, "side of a generated site, in cells")
      ->check(CLI::Range(32, 10000))
      ->capture_default_str();
  groupOptions(command, "Cases and runs");
  addReadOptions(command, options.suite.ground.dem);
  addGroundChoices(command, options.suite.ground);
  command.add_option("-o,--output", options.folder, "folder for the OMPL logs, the table and the page")
      ->type_name("FOLDER")
      ->capture_default_str();
  groupOptions(command, "Output");
}

std::string fileName(std::string name) {
  for (char& c : name)
    if (c == ' ' || c == '/') c = '_';
  return name;
}

// Creates the folder before the runs, so that an unusable path is reported immediately, and after the suite
// is read, so that an invalid suite creates no folder. Returns true if the folder did not exist.
bool makeFolder(const std::string& folder) {
  std::error_code error;
  const bool made = std::filesystem::create_directories(folder, error);
  if (error)
    throw InputError({folder, "cannot be created: " + error.message(), "name another folder with -o"});
  const OutputFile can_be_written(std::filesystem::path(folder) / "table.txt");
  return made;
}

// The runs of a name given twice would enter the statistics twice.
void refuseTwice(const std::string& what, std::vector<std::string> names) {
  std::ranges::sort(names);
  const auto twice = std::ranges::adjacent_find(names);
  if (twice != names.end()) throw InputError({what + " " + *twice, "is named twice", "name it once"});
}

std::string benchText(const planner::BenchmarkPlan& plan, const std::vector<planner::BenchmarkRun>& runs) {
  const std::size_t asked = planner::jobsOf(plan).size();
  return (runs.size() < asked ? fmt::format("cancelled: {} of {} runs\n", runs.size(), asked) : "") +
         asText(compared(plan, runs)) + asText(drivesOf(plan, runs)) +
         "OMPL's planners begin with the field's route, those with :cold with nothing\n";
}

void write(const std::filesystem::path& folder, const planner::BenchmarkPlan& plan,
           const std::vector<planner::BenchmarkRun>& runs) {
  for (std::size_t c = 0; c < plan.cases.size(); ++c)
    if (std::ranges::any_of(runs, [c](const auto& run) { return run.case_index == c; }))
      writeFile(folder / (fileName(plan.cases[c].name) + ".log"), planner::benchmarkLog(plan, runs, c));
  writeFile(folder / "table.txt", benchText(plan, runs));
  writeFile(folder / "index.html", asPage(plan, runs));
}

// Runs all jobs. After a requested stop, only the runs completed before are returned.
std::vector<planner::BenchmarkRun> allRuns(const planner::BenchmarkPlan& plan, const Campaign& campaign,
                                           const Context& context) {
  const auto jobs = planner::jobsOf(plan);
  context.answerStop();
  const ProgressMonitor watch =
      campaign.leads() ? context.watch("bench") : ProgressMonitor{.progress = {}, .stop = context.stop};
  const auto outcomes = campaign.run(
      jobs.size(), [&](std::size_t i) { return planner::runIsolated(plan, jobs[i], watch); }, watch);
  std::vector<planner::BenchmarkRun> runs;
  for (std::size_t i = 0; i < outcomes.size(); ++i)
    if (!outcomes[i].stopped)
      runs.push_back(planner::benchmarkRun(jobs[i], outcomes[i].failed ? std::string() : outcomes[i].text));
  return runs;
}

// Writes the results of completed runs and reports the cancellation on stderr, so that stdout contains either
// a complete table or nothing.
int cancelled(const BenchOptions& options, const planner::BenchmarkPlan& plan,
              const std::vector<planner::BenchmarkRun>& runs, bool made, const Context& context) {
  if (!runs.empty()) {
    write(options.folder, plan, runs);
    context.warn(fmt::format("cancelled after {} of {} runs; their results are in {}", runs.size(),
                             planner::jobsOf(plan).size(), options.folder));
  } else if (made) {
    std::filesystem::remove(options.folder);  // still empty
  }
  return Exit::kCancelled;
}

int run(const BenchOptions& options, Context& context) {
  const Campaign campaign;
  if (!campaign.leads()) context.quiet = true;
  planner::BenchmarkPlan plan;
  refuseTwice("suite", options.suite.names);
  for (const std::string& words : options.planners.empty() ? planner::warmAndCold() : options.planners)
    plan.planners.push_back(planner::wordsOf(planner::samplingSettings(words)));
  for (const std::string& file : options.plugins) {
    const std::string name = pluginOf(file).name();
    plan.planners.push_back(name);
    plan.plugins[name] = file;
  }
  refuseTwice("planner", plan.planners);
  plan.cases = suiteCases(options.suite, context);
  if (plan.cases.empty())
    throw InputError({"talus bench", "the suite has no pair of distant places with a route between them",
                      "choose another map, rover or --seed"});
  const bool made = campaign.leads() && makeFolder(options.folder);
  plan.seeds = options.runs;
  plan.time_limit_s = options.time_limit_s;
  plan.began = fmt::format("{:%Y-%m-%d %H:%M:%S}", fmt::gmtime(std::time(nullptr)));
  const auto runs = allRuns(plan, campaign, context);
  if (!campaign.leads()) return context.stop.stop_requested() ? Exit::kCancelled : Exit::kDone;
  if (runs.size() < planner::jobsOf(plan).size()) return cancelled(options, plan, runs, made, context);
  write(options.folder, plan, runs);
  const auto lines = compared(plan, runs);
  if (context.json)
    printJson(asJson(lines, drivesOf(plan, runs)));
  else
    print(benchText(plan, runs));
  return Exit::kDone;
}

}  // namespace

void addBench(CLI::App& app, Context& context) {
  addCommand<BenchOptions>(
      app, context,
      {.name = "bench",
       .group = Group::kRoutes,
       .description = "compare planners on the same cases; write logs, a table and a page",
       .examples = "  talus bench --planners field,RRTstar:cold --time 5\n"
                   "  talus bench gale.tif --pairs 10 -o gale_bench\n"
                   "  talus bench room.scen --planners field\n"
                   "  talus bench generated slip grids maps/*.tif --pairs 4\n"},
      bind, run);
}

}  // namespace talus::cli
