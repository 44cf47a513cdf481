#pragma once

#include <string>

#include <gtest/gtest.h>

#include "requirement.hpp"

namespace talus::cli {

/// Shell words that start the following call on `ranks` ranks, also as root; `before` precedes mpirun.
inline std::string mpirun(int ranks, const std::string& before = "") {
  return "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 " + before +
         "mpirun --oversubscribe -np " + std::to_string(ranks) + " ";
}

/// Returns true if the program was built with MPI and mpirun is installed.
inline bool hasMpi() {
  return TALUS_HAS_MPI && test::installed("mpirun");
}

/// Skips the test without MPI; in CI (continuous integration) the test fails instead.
#define TALUS_REQUIRE_MPI() \
  TALUS_REQUIRE(::talus::cli::hasMpi(), "built without Boost.MPI, or mpirun is not installed")

/// Expects 2 and 4 ranks to give the result of one process; answer(words) runs the call after the shell
/// words.
template <class Answer, class One>
void expectRanksAgree(const Answer& answer, const One& one) {
  for (const int ranks : {2, 4}) EXPECT_EQ(answer(mpirun(ranks)), one) << ranks << " ranks";
}

}  // namespace talus::cli
