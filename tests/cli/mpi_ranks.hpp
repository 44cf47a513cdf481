#pragma once

#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

namespace talus::cli {

/// Whether the program can be run by several ranks of MPI here.
inline bool hasMpi() {
  return TALUS_HAS_MPI && std::system("mpirun --version > /dev/null 2>&1") == 0;
}

/// Expects 2 and 4 ranks to give what one process gave: answer(words) runs a call with words before it.
template <class Answer, class One>
void expectRanksAgree(const Answer& answer, const One& one) {
  for (const char* ranks : {"2", "4"})
    EXPECT_EQ(answer("OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 mpirun --oversubscribe -np " +
                     std::string(ranks) + " "),
              one)
        << ranks << " ranks";
}

}  // namespace talus::cli
