#include <chrono>
#include <cmath>
#include <thread>

#include <talus/planner/bench/benchmark.hpp>
#include <talus/planner/bench/benchmark_log.hpp>

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

TEST(Benchmark, StopsBetweenRuns) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_TRUE(runBenchmark(smallPlan(), {.progress = {}, .stop = stop.get_token()}).empty());
}

TEST(Benchmark, StopEndsTheCurrentRun) {
  BenchmarkPlan plan = smallPlan();
  plan.planners = {"RRTstar"};
  plan.time_limit_s = 600.0;
  std::jthread stopper;
  std::stop_source stop;
  const ProgressMonitor watch{.progress = {}, .stop = stop.get_token()};
  stopper = std::jthread([&stop] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    stop.request_stop();
  });
  EXPECT_TRUE(runBenchmark(plan, watch).empty());  // otherwise the test takes ten minutes
}

}  // namespace benchmark_test
}  // namespace talus::planner
