// talus bench SUITE: compares planners on the same problems.
#include <algorithm>
#include <ctime>
#include <exception>
#include <filesystem>
#include <optional>

#include <fmt/chrono.h>

#include <talus/cli/app/campaign.hpp>
#include <talus/cli/app/command.hpp>
#include <talus/cli/ground/mission.hpp>
#include <talus/cli/study/bench_suite.hpp>
#include <talus/planner/bench/benchmark.hpp>
#include <talus/planner/sampling/sampling_planner.hpp>

namespace talus::cli {
namespace {

struct BenchOptions {
  SuiteOptions suite;
  std::vector<std::string> planners, plugins;
  int runs = 3;
  double time_limit_s = 2.0;
  std::string folder = "bench", part;
};

void bind(CLI::App& command, BenchOptions& options) {
  addOption(command, "suite", options.suite.names);
  addOption(command, "--planners", options.planners)->delimiter(',');
  addOption(command, "--plugin FILE.so", options.plugins);
  addOption(command, "--runs", options.runs)->check(positive());
  addOption(command, "--time S", options.time_limit_s)->check(positive());
  addOption(command, "--pairs", options.suite.pairs)->check(positive());
  addOption(command, "--turning-radius METRES", options.suite.turning_radius_m)->check(turningRadius());
  addOption(command, "--side", options.suite.side_cells)->check(CLI::Range(32, 10000));
  addOption(command, "--part K/N", options.part);
  addReadOptions(command, options.suite.ground.elevation);
  addGroundChoices(command, options.suite.ground);
  addOption(command, "-o,--output FOLDER", options.folder);
}

std::string fileName(std::string name) {
  for (char& c : name)
    if (c == ' ' || c == '/') c = '_';
  return name;
}

// The runs of a name given twice would enter the statistics twice.
void refuseTwice(const std::string& what, std::vector<std::string> names) {
  std::ranges::sort(names);
  const auto twice = std::ranges::adjacent_find(names);
  if (twice != names.end()) throw InputError({what + " " + *twice, "is named twice", "name it once"});
}

void write(const std::filesystem::path& folder, const planner::BenchmarkPlan& plan,
           const std::vector<planner::BenchmarkRun>& runs) {
  for (std::size_t c = 0; c < plan.cases.size(); ++c)
    if (std::ranges::any_of(runs, [c](const auto& run) { return run.case_index == c; }))
      writeFile(folder / (fileName(plan.cases[c].name) + ".log"), planner::benchmarkLog(plan, runs, c));
  const Report report = benchReport(plan, runs);
  writeFile(folder / "table.txt", report.text());
  writeFile(folder / "index.html", report.html());
}

// The runs of all parts, or the runs completed before a stop; nothing while parts are missing.
std::optional<std::vector<planner::BenchmarkRun>> runsOf(const BenchOptions& options,
                                                         const planner::BenchmarkPlan& plan,
                                                         const Campaign& campaign, const Context& context) {
  const auto jobs = planner::jobsOf(plan);
  std::string identity = fmt::format("{} {} {}", plan.seeds, plan.time_limit_s, context.seed);
  for (const std::string& planner : plan.planners) identity += "\n" + planner;
  for (const auto& one : plan.cases)
    identity +=
        fmt::format("\n{} {} {} {} {}", one.name, one.start.x_m, one.start.y_m, one.goal.x_m, one.goal.y_m);
  context.answerStop();
  const ProgressMonitor watch = context.watch("bench");
  const auto run = [&](std::size_t k) {
    try {
      return planner::runIsolated(plan, jobs[k], watch);
    } catch (const std::exception&) {
      return std::string();  // a crash
    }
  };
  const auto results = campaign.results({.count = jobs.size(),
                                         .part = options.part,
                                         .folder = options.folder,
                                         .identity = identity,
                                         .what = "runs"},
                                        run, watch);
  if (!results) return std::nullopt;
  std::vector<planner::BenchmarkRun> runs;
  for (const auto& [job, text] : *results) runs.push_back(planner::benchmarkRun(jobs[job], text));
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
    const std::string name = planner::PluginPlanner(file).name();
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
  const auto all = runsOf(options, plan, campaign, context);
  if (!all) return context.stop.stop_requested() ? Exit::kCancelled : Exit::kDone;
  const auto& runs = *all;
  if (runs.size() < planner::jobsOf(plan).size()) return cancelled(options, plan, runs, made, context);
  write(options.folder, plan, runs);
  context.answer(asJson(compared(plan, runs), drivesOf(plan, runs)), benchReport(plan, runs).text());
  return Exit::kDone;
}

}  // namespace

void addBench(CLI::App& app, Context& context) {
  addCommand<BenchOptions>(app, context, "bench", bind, run);
}

}  // namespace talus::cli
