#include <atomic>
#include <stdexcept>
#include <stop_token>

#include <talus/cli/app/campaign.hpp>

namespace talus::cli {
namespace campaign_test {

TEST(Campaign, WithoutMpiThereIsOneLeadingRank) {
  const Campaign campaign;
  EXPECT_EQ(campaign.ranks(), 1);
  EXPECT_TRUE(campaign.leads());
}

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
    const auto outcomes = campaign.run(
        40,
        [&ran](std::size_t i) {
          ++ran;
          if (i % 7 == 3) throw std::runtime_error("job " + std::to_string(i) + " is bad");
          return std::to_string(i * i);
        },
        watch, workers);
    ASSERT_EQ(outcomes.size(), 40U);
    EXPECT_EQ(ran, 40);
    EXPECT_FALSE(backwards);
    if (workers == 1) {
      EXPECT_EQ(last, 1.0);
    }
    for (std::size_t i = 0; i < 40; ++i) {
      EXPECT_EQ(outcomes[i].failed, i % 7 == 3);
      EXPECT_FALSE(outcomes[i].stopped);
      EXPECT_EQ(outcomes[i].text,
                i % 7 == 3 ? "job " + std::to_string(i) + " is bad" : std::to_string(i * i));
    }
  }
}

// Property: jobs completed before a stop keep their results; a job that returns an empty text after a stop,
// and all later jobs, are marked as stopped.
TEST(Campaign, StopKeepsCompletedJobs) {
  const Campaign campaign;
  std::stop_source source;
  const auto outcomes = campaign.run(
      6,
      [&source](std::size_t i) {
        if (i == 2) source.request_stop();
        return i == 2 ? std::string() : "done";
      },
      ProgressMonitor{.progress = {}, .stop = source.get_token()});
  ASSERT_EQ(outcomes.size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(outcomes[i].stopped, i >= 2) << i;
    EXPECT_EQ(outcomes[i].failed, i >= 2) << i;
    EXPECT_EQ(outcomes[i].text, i >= 2 ? "cancelled" : "done");
  }
}

TEST(Campaign, EmptyCampaignHasNoOutcomes) {
  EXPECT_TRUE(Campaign().run(0, [](std::size_t) { return std::string("x"); }).empty());
}

}  // namespace campaign_test
}  // namespace talus::cli
