#pragma once

#include <cstdlib>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

namespace talus::test {

/// Whether a program of this name is on the path.
inline bool installed(const std::string& program) {
  return std::system(("command -v " + program + " > /dev/null 2>&1").c_str()) == 0;
}

/// Whether skipping is forbidden: the environment contains CI=true.
inline bool runsEveryTest() {
  const char* ci = std::getenv("CI");
  return ci != nullptr && std::string_view(ci) == "true";
}

}  // namespace talus::test

/// Requires something that not every machine has. If it is missing, the test is skipped, or fails in CI; the
/// message states what is missing.
#define TALUS_REQUIRE(available, missing)                                                             \
  if (!(available)) {                                                                                 \
    if (::talus::test::runsEveryTest()) GTEST_FAIL() << (missing) << "; CI=true asks for every test"; \
    GTEST_SKIP() << (missing);                                                                        \
  }                                                                                                   \
  static_assert(true)
