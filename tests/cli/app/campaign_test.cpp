#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <stdexcept>
#include <stop_token>

#include <sys/wait.h>

#include <talus/cli/app/campaign.hpp>

#include "bad_input.hpp"
#include "mpi_ranks.hpp"

namespace talus::cli {
namespace campaign_test {

using testing::HasSubstr;
using testing::IsEmpty;

// Property: outcomes are in job order for any number of workers, a job that throws does not stop the other
// jobs, and progress never decreases.
TEST(Campaign, OutcomesAreInJobOrderIncludingFailures) {
  const Campaign campaign;
  for (const std::size_t workers : {1U, 2U, 5U}) {
    std::atomic<int> ran{0};
    double last = 0.0;
    bool backwards = false;
    const ProgressMonitor watch{.progress = [&](double share) { backwards |= share < last, last = share; },
                                .stop = {}};
    const auto results = campaign.results(
        {.count = 40, .workers = workers},
        [&ran](std::size_t i) {
          ++ran;
          if (i % 7 == 3) throw std::runtime_error("job " + std::to_string(i) + " is bad");
          return std::to_string(i * i);
        },
        watch);
    ASSERT_TRUE(results);
    ASSERT_EQ(results->size(), 40U);
    EXPECT_EQ(ran, 40);
    EXPECT_FALSE(backwards);
    if (workers == 1) {
      EXPECT_EQ(last, 1.0);
    }
    for (std::size_t i = 0; i < 40; ++i)
      EXPECT_EQ(results->at(i), i % 7 == 3 ? "job " + std::to_string(i) + " is bad" : std::to_string(i * i));
  }
}

// Property: jobs completed before a stop keep their results; a job that returns an empty text after a stop,
// and all later jobs, have no result.
TEST(Campaign, StopKeepsCompletedJobs) {
  const Campaign campaign;
  std::stop_source source;
  const auto results = campaign.results(
      {.count = 6},
      [&source](std::size_t i) {
        if (i == 2) source.request_stop();
        return i == 2 ? std::string() : "done";
      },
      ProgressMonitor{.progress = {}, .stop = source.get_token()});
  EXPECT_EQ(results, (JobResults{{0, "done"}, {1, "done"}}));
}

/// Result of `talus plan --pairs`: exit status, result table, and text on stderr.
struct Campaigned {
  int status = 0;
  std::string table;
  std::string said;
};

Campaigned planned(const std::string& before) {
  const Folder folder;
  const std::string map = folder.write("flat.asc", asciiGrid(12, 12, [](int, int) { return 0.0; }));
  const std::string pairs = folder.write("pairs.csv", "start_x_m,start_y_m,goal_x_m,goal_y_m\n2,2,9,9\n");
  const std::string call = before + "'" TALUS_PROGRAM "' plan " + map + " --pairs " + pairs +
                           " --resolution 1 --soil sandy_loam --rover fido --quiet -o " +
                           (folder / "out.csv") + " 2> " + (folder / "said");
  Campaigned campaigned;
  campaigned.status = std::system(call.c_str());
  campaigned.table = fileContent(folder / "out.csv");
  campaigned.said = fileContent(folder / "said");
  return campaigned;
}

// Property: four processes that cannot communicate would write the same file. The variables of a launcher
// without a running MPI are refused in builds with and without MPI.
TEST(MpiLaunch, RanksWithoutMpiSupportAreRejected) {
  for (const std::string variable : {"OMPI_COMM_WORLD_SIZE", "MV2_COMM_WORLD_SIZE", "PMI_SIZE"}) {
    const Campaigned refused = planned("OMPI_ALLOW_RUN_AS_ROOT=1 " + variable + "=4 ");
    EXPECT_EQ(WEXITSTATUS(refused.status), 2) << variable;
    EXPECT_THAT(refused.said, HasSubstr("talus: started as one of 4 MPI ranks (" + variable + ")"));
    EXPECT_EQ(std::count(refused.said.begin(), refused.said.end(), '\n'), 1) << refused.said;
    EXPECT_THAT(refused.table, IsEmpty());
  }
}

TEST(MpiLaunch, SingleRankEqualsAPlainRun) {
  const Campaigned plain = planned(""), one = planned("OMPI_COMM_WORLD_SIZE=1 ");
  EXPECT_EQ(one.status, 0) << one.said;
  EXPECT_EQ(one.table, plain.table);
  EXPECT_THAT(one.table, HasSubstr("found"));
}

#if !TALUS_HAS_MPI
TEST(MpiLaunch, MpirunWithoutMpiSupportIsRejected) {
  TALUS_REQUIRE(test::installed("mpirun"), "mpirun is not installed");
  const Campaigned refused = planned(mpirun(2));
  EXPECT_EQ(WEXITSTATUS(refused.status), 2);
  EXPECT_THAT(refused.said, HasSubstr("built without MPI"));
}
#endif

}  // namespace campaign_test
}  // namespace talus::cli
