#pragma once

#include <string>

#include <gtest/gtest.h>

#include "requirement.hpp"

namespace talus::cli {

/// The words that start so many ranks of the call behind them, root or not; `before` stands before mpirun.
inline std::string mpirun(int ranks, const std::string& before = "") {
  return "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 " + before +
         "mpirun --oversubscribe -np " + std::to_string(ranks) + " ";
}

/// Whether the program can be run by several ranks of MPI here.
inline bool hasMpi() {
  return TALUS_HAS_MPI && test::installed("mpirun");
}

/// Skips the test, or fails it in CI, where the program cannot be run by several ranks.
#define TALUS_REQUIRE_MPI() \
  TALUS_REQUIRE(::talus::cli::hasMpi(), "built without Boost.MPI, or mpirun is not installed")

/// Expects 2 and 4 ranks to give what one process gave: answer(words) runs a call with words before it.
template <class Answer, class One>
void expectRanksAgree(const Answer& answer, const One& one) {
  for (const int ranks : {2, 4}) EXPECT_EQ(answer(mpirun(ranks)), one) << ranks << " ranks";
}

}  // namespace talus::cli
