#include "requirement.hpp"

#include <cstdlib>

#include <gtest/gtest-spi.h>

namespace talus::test {
namespace requirement_test {

/// Result of a test with a missing requirement if the environment variable CI has the given value.
testing::TestPartResult::Type outcome(const char* ci) {
  ::setenv("CI", ci, 1);
  testing::TestPartResultArray results;
  {
    const testing::ScopedFakeTestPartResultReporter listener(
        testing::ScopedFakeTestPartResultReporter::INTERCEPT_ONLY_CURRENT_THREAD, &results);
    [] { TALUS_REQUIRE(false, "nothing is installed"); }();
  }
  return results.GetTestPartResult(0).type();
}

TEST(Requirement, WhatIsMissingSkipsATestAndFailsInCi) {
  const char* before = std::getenv("CI");
  const std::string kept = before ? before : "";
  EXPECT_EQ(outcome("true"), testing::TestPartResult::kFatalFailure);
  EXPECT_EQ(outcome("false"), testing::TestPartResult::kSkip);
  ::setenv("CI", kept.c_str(), 1);
}

TEST(Requirement, FindsProgramsOnThePath) {
  EXPECT_TRUE(installed("sh"));
  EXPECT_FALSE(installed("no-such-program"));
}

}  // namespace requirement_test
}  // namespace talus::test
