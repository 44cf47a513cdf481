#include <chrono>
#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <thread>

#include <gmock/gmock.h>

#include <talus/planner/bench/benchmark.hpp>

#include "drawn_map.hpp"

namespace talus::planner {

namespace benchmark_test {

using ::testing::HasSubstr;

BenchmarkPlan smallPlan() {
  const auto map = testing::drawn({"........", "...#....", "...#....", "........"});
  return {.cases = {{.name = "gap", .map = map, .start = {0.5, 1.5}, .goal = {7.5, 1.5}},
                    {.name = "shut in",
                     .map = testing::drawn({"..#.", "..#."}),
                     .start = {0.5, 0.5},
                     .goal = {3.5, 0.5}}},
          .planners = {"field", "RRTstar"},
          .seeds = 2,
          .time_limit_s = 0.2};
}

std::vector<BenchmarkRun> runBenchmark(const BenchmarkPlan& plan) {
  std::vector<BenchmarkRun> runs;
  for (const BenchmarkJob& job : jobsOf(plan)) runs.push_back(benchmarkRun(job, runIsolated(plan, job)));
  return runs;
}

TEST(Benchmark, RunsEveryPlannerCaseAndSeed) {
  const BenchmarkPlan plan = smallPlan();
  const auto runs = runBenchmark(plan);
  ASSERT_EQ(runs.size(), 8u);
  for (const BenchmarkRun& run : runs) {
    EXPECT_FALSE(run.crashed);
    EXPECT_FALSE(run.breached);
    EXPECT_GT(run.megabytes, 1.0);
    EXPECT_EQ(run.status == RouteStatus::Found, run.case_index == 0);
    // Property: no intermediate cost is below that of the checked route; a run without a route has no
    // intermediate costs.
    EXPECT_EQ(run.progress.empty(), run.case_index != 0);
    for (const CostAtTime& at : run.progress) EXPECT_GE(at.cost_J, run.cost_J);
  }
  // Property: the cost of a route is at least its lower bound, and the best known cost is the least over all
  // runs.
  EXPECT_GE(runs[0].cost_J, runs[0].lower_bound_J);
  EXPECT_LE(bestKnown_J(plan, runs, 0), runs[0].cost_J);
  EXPECT_TRUE(std::isinf(bestKnown_J(plan, runs, 1)));
}

TEST(Benchmark, CrashedRunIsARecordedResult) {
  BenchmarkPlan plan = smallPlan();
  plan.cases[0].map = nullptr;  // the run in its own process throws
  const BenchmarkJob job{.planner = "field", .case_index = 0, .seed = 1};
  const BenchmarkRun run = benchmarkRun(job, runIsolated(plan, job));
  EXPECT_TRUE(run.crashed);
  EXPECT_TRUE(std::isinf(run.cost_J));
}

TEST(Benchmark, LogFollowsTheOmplFormat) {
  const BenchmarkPlan plan = smallPlan();
  const std::string log = benchmarkLog(plan, runBenchmark(plan), 0);
  // Printed in: OMPL's "Sample benchmark log files" (ompl.kavrakilab.org/benchmark.html), the order of its
  // lines.
  EXPECT_THAT(log, ::testing::StartsWith("OMPL version 1.5.2\nExperiment gap\n"));
  EXPECT_THAT(log, HasSubstr("\n1 enum type\nstatus|"));
  EXPECT_THAT(log,
              HasSubstr("\n2 planners\nfield\n0 common properties\n13 properties for each run\ntime REAL\n"));
  EXPECT_THAT(log, HasSubstr("\n2 progress properties for each run\ntime REAL\nbest cost REAL\n2 runs\n"));
  EXPECT_THAT(log, ::testing::EndsWith("\n.\n"));
}

TEST(Benchmark, StopEndsTheCurrentRun) {
  BenchmarkPlan plan = smallPlan();
  plan.time_limit_s = 600.0;
  std::jthread stopper;
  std::stop_source stop;
  const ProgressMonitor watch{.progress = {}, .stop = stop.get_token()};
  stopper = std::jthread([&stop] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    stop.request_stop();
  });
  EXPECT_TRUE(runIsolated(plan, {.planner = "RRTstar", .seed = 1}, watch)
                  .empty());  // otherwise the test takes ten minutes
}

// An independent reader of the log grammar that OMPL's ompl_benchmark_statistics.py (1.6) parses line by
// line for Planner Arena. Throws where that script would fail.
class ArenaReader {
 public:
  struct Planner {
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> runs;
    std::vector<std::vector<std::pair<double, double>>> progress;
  };

  explicit ArenaReader(const std::string& log) : stream_(log) {
    words({{1, "version"}});
    experiment = words({{0, "Experiment"}}).back();
    const int properties = std::stoi(words({{-2, "experiment"}, {-1, "properties"}}).front());
    for (int k = 0; k < properties; ++k)
      if (line().find(" = ") == std::string::npos) throw std::runtime_error("property without ' = '");
    words({{0, "Running"}});
    words({{0, "Starting"}});
    block();
    std::stoi(words({{-2, "random"}, {-1, "seed"}}).front());
    std::stod(words({{-3, "seconds"}, {-2, "per"}, {-1, "run"}}).front());
    std::stod(words({{-3, "MB"}, {-2, "per"}, {-1, "run"}}).front());
    std::stoi(words({{-3, "runs"}, {-2, "per"}, {-1, "planner"}}).front());
    std::stod(words({{-3, "collect"}, {-2, "the"}, {-1, "data"}}).front());
    const int enums = std::stoi(words({{-2, "enum"}}).front());
    for (int k = 0; k < enums; ++k) {
      const auto parts = split(line(), "|");
      for (std::size_t i = 1; i < parts.size(); ++i) meanings[parts[0]].push_back(parts[i]);
    }
    const int count = std::stoi(words({{-1, "planners"}}).front());
    for (int k = 0; k < count; ++k) readPlanner();
    std::string rest;
    if (std::getline(stream_, rest)) throw std::runtime_error("more than the planners: " + rest);
  }

  std::string experiment;
  std::map<std::string, std::vector<std::string>> meanings;
  std::map<std::string, Planner> planners;

 private:
  static std::vector<std::string> split(const std::string& text, const std::string& by) {
    std::vector<std::string> parts;
    std::size_t from = 0;
    for (std::size_t at; (at = text.find(by, from)) != std::string::npos; from = at + by.size())
      parts.push_back(text.substr(from, at - from));
    parts.push_back(text.substr(from));
    return parts;
  }

  std::string line() {
    std::string text;
    if (!std::getline(stream_, text)) throw std::runtime_error("the log ends early");
    return text;
  }

  // The words of a line. `expected` gives some of them by position; negative positions count from the end.
  std::vector<std::string> words(const std::map<int, std::string>& expected) {
    std::istringstream text(line());
    std::vector<std::string> all;
    for (std::string word; text >> word;) all.push_back(word);
    for (const auto& [place, word] : expected) {
      const int at = place < 0 ? static_cast<int>(all.size()) + place : place;
      if (at < 0 || at >= static_cast<int>(all.size()) || all[static_cast<std::size_t>(at)] != word)
        throw std::runtime_error("expected '" + word + "' in '" + text.str() + "'");
    }
    return all;
  }

  void block() {
    if (!line().starts_with("<<<|")) throw std::runtime_error("no <<<|");
    while (!line().starts_with("|>>>")) {
    }
  }

  std::vector<std::string> columns(int count) {
    std::vector<std::string> names;
    const std::set<std::string> types{"REAL", "INTEGER", "BOOLEAN", "ENUM"};
    for (int k = 0; k < count; ++k) {
      const auto field = words({});
      if (!types.contains(field.back())) throw std::runtime_error("unknown type " + field.back());
      std::string name;
      for (std::size_t i = 0; i + 1 < field.size(); ++i) name += (i == 0 ? "" : "_") + field[i];
      names.push_back(name);
    }
    return names;
  }

  void readPlanner() {
    const std::string name = line();
    for (int k = std::stoi(line()); k > 0; --k) line();  // common properties
    Planner& planner = planners[name];
    planner.columns = columns(std::stoi(line()));
    for (int k = std::stoi(line()); k > 0; --k) {
      auto values = split(line(), "; ");
      values.pop_back();
      if (values.size() != planner.columns.size()) throw std::runtime_error("a run of another width");
      for (const std::string& value : values)
        if (!value.empty()) std::stod(value);
      planner.runs.push_back(values);
    }
    const std::string next = line();
    if (next == ".") return;
    if (columns(std::stoi(next)).front() != "time") throw std::runtime_error("progress without time");
    if (std::stoul(line()) != planner.runs.size()) throw std::runtime_error("progress of other runs");
    for (std::size_t k = 0; k < planner.runs.size(); ++k) {
      auto samples = split(line(), ";");
      samples.pop_back();
      std::set<double> times;  // with the run, a primary key
      planner.progress.emplace_back();
      for (const std::string& sample : samples) {
        const auto values = split(sample, ",");
        if (values.size() != 3) throw std::runtime_error("a sample of another width");
        if (!times.insert(std::stod(values[0])).second) throw std::runtime_error("a time twice");
        planner.progress.back().emplace_back(std::stod(values[0]), std::stod(values[1]));
      }
    }
    if (line() != ".") throw std::runtime_error("no full stop after a planner");
  }

  std::istringstream stream_;
};

BenchmarkPlan plan() {
  const auto map = testing::drawn({"......", "..##..", "......"});
  return {.cases = {{.name = "two words", .map = map, .start = {0.5, 1.5}, .goal = {5.5, 1.5}}},
          .planners = {"field", "hybrid", "RRTstar"},
          .seeds = 2,
          .time_limit_s = 0.5};
}

TEST(BenchmarkLog, PlannerArenaReadsTheLog) {
  const BenchmarkPlan asked = plan();
  const auto runs = runBenchmark(asked);
  const ArenaReader arena(benchmarkLog(asked, runs, 0));
  EXPECT_EQ(arena.experiment, "two_words");
  ASSERT_EQ(arena.planners.size(), 3u);
  EXPECT_EQ(arena.meanings.at("status").at(6), "Exact solution");
  for (const auto& [name, planner] : arena.planners) {
    EXPECT_EQ(planner.runs.size(), 2u) << name;
    EXPECT_EQ(planner.columns.at(5), "solution_cost");
    EXPECT_EQ(planner.runs[0].at(2), "6") << name;
    EXPECT_FALSE(planner.progress.at(1).empty()) << name;
  }
}

TEST(BenchmarkLog, FailuresAndEqualTimesAreReadable) {
  BenchmarkPlan asked = plan();
  asked.planners = {"field"};
  asked.seeds = 3;
  std::vector<BenchmarkRun> runs(3);
  for (std::size_t k = 0; k < 3; ++k) runs[k].planner = "field";
  runs[0].crashed = true;
  runs[1].status = RouteStatus::NoRoute;
  runs[2].status = RouteStatus::Found;
  runs[2].cost_J = 50.0;
  runs[2].progress = {{0.25, 70.0}, {0.25, 60.0}, {0.5, 50.0}};
  const ArenaReader arena(benchmarkLog(asked, runs, 0));
  const auto& planner = arena.planners.at("field");
  EXPECT_EQ(arena.meanings.at("status").at(std::stoul(planner.runs[0].at(2))), "Crash");
  EXPECT_EQ(planner.runs[0].at(5), "");
  EXPECT_EQ(planner.runs[1].at(3), "0");
  ASSERT_EQ(planner.progress[2].size(), 2u);
  EXPECT_DOUBLE_EQ(planner.progress[2][0].second, 60.0);
}

}  // namespace benchmark_test

}  // namespace talus::planner
