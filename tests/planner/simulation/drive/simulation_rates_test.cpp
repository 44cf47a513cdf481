#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include <talus/planner/simulation/drive/simulation_rates.hpp>

namespace talus::planner {
namespace simulation_rates_test {

TEST(Share, IntervalIsWilsons) {
  // Closed form: Wilson (1927) for 0 and 10 of 10, 5 of 10, computed by hand
  EXPECT_NEAR(share(0, 10).interval_95[1], 0.27753, 1e-5);
  EXPECT_NEAR(share(10, 10).interval_95[0], 0.72247, 1e-5);
  EXPECT_NEAR(share(5, 10).interval_95[0], 0.23659, 1e-5);
  EXPECT_DOUBLE_EQ(share(5, 10).value, 0.5);
  EXPECT_TRUE(std::isnan(share(0, 0).value));
}

// Closed form: for 1, 2, 3, 6 the mean is 3, the standard deviation sqrt(14 / 3), the standard error half of
// it.
TEST(Mean, IntervalFollowsFromTheStandardError) {
  const Sampled of = mean({1.0, 2.0, 3.0, 6.0});
  EXPECT_DOUBLE_EQ(of.value, 3.0);
  EXPECT_NEAR(of.interval_95[1] - 3.0, 1.959964 * std::sqrt(14.0 / 3.0) / 2.0, 1e-5);
  EXPECT_NEAR(of.interval_95[0] + of.interval_95[1], 6.0, 1e-12);
  EXPECT_TRUE(std::isnan(mean({}).value));
}

TEST(Compared, RatesCountWorldsSolvedWithPerfectKnowledge) {
  const auto drive = [](Outcome outcome, double energy_J) {
    WorldResult r;
    r.drive.outcome = outcome;
    r.drive.energy_J = energy_J;
    return r;
  };
  const std::vector<WorldResult> mine{drive(Outcome::Reached, 110.0), drive(Outcome::Immobilised, 5.0),
                                      drive(Outcome::GaveUp, 1.0), drive(Outcome::Reached, 130.0)};
  const std::vector<WorldResult> best{drive(Outcome::Reached, 100.0), drive(Outcome::Reached, 100.0),
                                      drive(Outcome::GaveUp, 0.0), drive(Outcome::Reached, 100.0)};
  const Comparison out = compared(mine, best);
  EXPECT_EQ(out.rates.worlds, 3U);
  EXPECT_NEAR(out.rates.outcome[static_cast<std::size_t>(Outcome::Immobilised)].value, 1.0 / 3.0, 1e-12);
  EXPECT_DOUBLE_EQ(out.rates.outcome[static_cast<std::size_t>(Outcome::GaveUp)].value, 0.0);
  EXPECT_NEAR(out.energy_over_perfect_knowledge.value, 1.2, 1e-12);
  EXPECT_NEAR(out.energy_over_perfect_knowledge.interval_95[1] - 1.2, 1.959964 * 0.1,
              1e-6);  // std 0.1414 / sqrt(2)
  EXPECT_THROW(compared(mine, {}), std::invalid_argument);
}

}  // namespace simulation_rates_test
}  // namespace talus::planner
