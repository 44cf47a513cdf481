#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <stop_token>
#include <thread>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include <talus/cli/app/context.hpp>

namespace talus::cli {

namespace context_test {

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

TEST(Context, WarningsAreOneLineOnStderrUnlessQuiet) {
  Context context;
  testing::internal::CaptureStderr();
  context.warn("no rover\ngiven");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "talus: warning: no rover; given\n");
  context.quiet = true;
  testing::internal::CaptureStderr();
  context.warn("no rover");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

// Closed form: a quarter of the work in 2 s leaves 6 s; without a fraction only the elapsed time is known.
TEST(Context, ProgressStatesTheTimeLeft) {
  EXPECT_EQ(progressText("plan", 0.0, 12.3), "plan, 12 s so far");
  EXPECT_EQ(progressText("site", 0.25, 2.0), "site [#######                       ]  25 %, 6 s left");
}

TEST(Context, StatusLineAppearsAfterHalfASecondAndIsErased) {
  StatusLine line;
  testing::internal::CaptureStderr();
  const auto phase = line.begin("plan");
  line.tick();
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  std::this_thread::sleep_for(std::chrono::milliseconds(600));
  testing::internal::CaptureStderr();
  line.tick();
  phase(1.0);
  line.tick();
  const std::string drawn = testing::internal::GetCapturedStderr();
  EXPECT_TRUE(drawn.starts_with("\rplan, ") && drawn.ends_with(" s so far\033[K\r\033[K")) << drawn;
}

// Property: printed JSON parses again; NaN and infinity become null, and invalid UTF-8 bytes are replaced.
TEST(Context, PrintedJsonIsValid) {
  testing::internal::CaptureStdout();
  printJson({{"cost", NAN}, {"bound", INFINITY}, {"name", "a\xff"}, {"length_m", 0.1}});
  const std::string printed = testing::internal::GetCapturedStdout();
  const auto json = nlohmann::json::parse(printed);
  EXPECT_TRUE(json["cost"].is_null() && json["bound"].is_null());
  EXPECT_EQ(json["length_m"].get<double>(), 0.1);
  EXPECT_EQ(printed.back(), '\n');
}

// Closed form: a byte that begins no UTF-8 character becomes U+FFFD.
TEST(Context, JsonTextIsValidUtf8) {
  EXPECT_EQ(jsonText({{"file", "d\xff.tif"}}), "{\"file\":\"d\xEF\xBF\xBD.tif\"}");
  EXPECT_EQ(jsonText({{"file", "\xc3\xa9"}}, 1), "{\n \"file\": \"\xc3\xa9\"\n}");
}

// Property: nothing that a terminal obeys is printed: of ESC, U+009B, OSC with BEL, DEL, CR, U+202E and U+2066 a
// blank is left, of a byte that is not UTF-8 U+FFFD. Letters, line breaks and tabulators stay.
TEST(Context, TerminalObeysNoPrintedText) {
  const std::string text =
      "\xc3\xa9\t\x1b[31m \xc2\x9b[2J \x1b]0;x\x07 \x7f\r \xe2\x80\xae \xe2\x81\xa6 \xef. \xf0\x9f\x9a\x99\n";
  const std::string shown = "\xc3\xa9\t [31m  [2J  ]0;x         \xef\xbf\xbd. \xf0\x9f\x9a\x99\n";
  testing::internal::CaptureStdout();
  print(text);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), shown);
  testing::internal::CaptureStderr();
  printError(text);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), shown);
  testing::internal::CaptureStdout();
  printJson({{"name", text}});
  const std::string json = testing::internal::GetCapturedStdout();
  EXPECT_TRUE(std::ranges::all_of(json, [](char c) { return c == '\n' || (c >= ' ' && c < '\x7f'); }))
      << json;
}

}  // namespace context_test

}  // namespace talus::cli
