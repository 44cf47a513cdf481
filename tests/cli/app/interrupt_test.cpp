#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <thread>

#include <unistd.h>

#include <talus/cli/app/context.hpp>
#include <talus/cli/app/interrupt.hpp>

namespace talus::cli {
namespace interrupt_test {

void waitFor(const Interrupt& interrupt) {
  while (!interrupt.requested()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

// Runs in its own process: the first `signal` becomes a stop request, visible through the token.
[[noreturn]] void interruptedOnce(int signal) {
  const Interrupt interrupt;
  if (interrupt.token().stop_requested()) std::exit(1);
  kill(getpid(), signal);
  waitFor(interrupt);
  std::exit(interrupt.token().stop_requested() ? 7 : 2);
}

[[noreturn]] void interruptedTwice() {
  const Interrupt interrupt;
  kill(getpid(), SIGINT);
  waitFor(interrupt);
  kill(getpid(), SIGINT);
  std::this_thread::sleep_for(std::chrono::seconds(60));
  std::exit(3);
}

TEST(InterruptDeathTest, FirstSignalRequestsAStop) {
  EXPECT_EXIT(interruptedOnce(SIGINT), testing::ExitedWithCode(7), "");
  EXPECT_EXIT(interruptedOnce(SIGTERM), testing::ExitedWithCode(7), "");
}

TEST(InterruptDeathTest, SecondSignalEndsTheProcessWithTheDocumentedCode) {
  EXPECT_EXIT(interruptedTwice(), testing::ExitedWithCode(Exit::kCancelled), "");
}

// Work that never reads its stop token; terminated by the limit of CPU time, not of wall time.
[[noreturn]] void deaf(int signal) {
  const Interrupt interrupt;
  kill(getpid(), signal);
  std::atomic<unsigned> turn = 0;
  for (;;) ++turn;
}

TEST(InterruptDeathTest, UnresponsiveWorkIsEnded) {
  EXPECT_EXIT(deaf(SIGINT), testing::ExitedWithCode(130), "cancelled");
  EXPECT_EXIT(deaf(SIGTERM), testing::ExitedWithCode(143), "cancelled");
}

// Work blocked on another process, such as the writer of a FIFO, uses no CPU time and is terminated early.
TEST(InterruptDeathTest, BlockedWorkIsEnded) {
  EXPECT_EXIT(
      {
        const Interrupt interrupt;
        kill(getpid(), SIGINT);
        waitFor(interrupt);
        std::this_thread::sleep_for(std::chrono::hours(1));
        std::exit(3);
      },
      testing::ExitedWithCode(130), "cancelled");
}

// Work that sets answered() is not terminated, here within twice the limit of CPU time.
TEST(InterruptDeathTest, ResponsiveWorkIsNotEnded) {
  EXPECT_EXIT(
      {
        Interrupt interrupt;
        interrupt.answered() = true;
        kill(getpid(), SIGTERM);
        waitFor(interrupt);
        for (const std::clock_t from = std::clock(); std::clock() - from < CLOCKS_PER_SEC;) {
        }
        std::exit(interrupt.code() == 143 ? 7 : 2);
      },
      testing::ExitedWithCode(7), "");
}

// Property: the signal by which the destructor wakes the listener is not treated as an interrupt by the user.
TEST(InterruptDeathTest, DestructionIsNotTreatedAsAnInterrupt) {
  EXPECT_EXIT(
      {
        { const Interrupt interrupt; }
        std::exit(9);
      },
      testing::ExitedWithCode(9), "");
}

}  // namespace interrupt_test
}  // namespace talus::cli
