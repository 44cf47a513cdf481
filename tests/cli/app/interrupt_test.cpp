#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>

#include <unistd.h>

#include <talus/cli/app/context.hpp>
#include <talus/cli/app/interrupt.hpp>

namespace talus::cli {
namespace {

void waitFor(const Interrupt& interrupt) {
  while (!interrupt.requested()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

// Runs in a process of its own: first `signal` is a request, which the work sees through its token.
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

TEST(InterruptDeathTest, TheFirstSignalIsARequest) {
  EXPECT_EXIT(interruptedOnce(SIGINT), testing::ExitedWithCode(7), "");
  EXPECT_EXIT(interruptedOnce(SIGTERM), testing::ExitedWithCode(7), "");
}

TEST(InterruptDeathTest, TheSecondEndsTheProcessWithThePromisedCode) {
  EXPECT_EXIT(interruptedTwice(), testing::ExitedWithCode(Exit::kCancelled), "");
}

// Property: its destructor wakes the listener by a signal that is not taken for the user's.
TEST(InterruptDeathTest, ItsOwnEndIsNoInterrupt) {
  EXPECT_EXIT(
      {
        { const Interrupt interrupt; }
        std::exit(9);
      },
      testing::ExitedWithCode(9), "");
}

}  // namespace
}  // namespace talus::cli
