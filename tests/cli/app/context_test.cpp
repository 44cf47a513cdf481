#include <cmath>
#include <stop_token>

#include <nlohmann/json.hpp>

#include <talus/cli/app/context.hpp>

namespace talus::cli {
namespace context_test {

TEST(Context, OneLineRemovesControlCharacters) {
  EXPECT_EQ(oneLine("first\nsecond"), "first; second");
  EXPECT_EQ(oneLine("tab\there\x1b[31m"), "tab here [31m");
  EXPECT_EQ(oneLine("trailing \r\n\n"), "trailing");
  EXPECT_EQ(oneLine("\xc3\xa9t\xc3\xa9"), "\xc3\xa9t\xc3\xa9");  // valid UTF-8 is unchanged
  EXPECT_EQ(oneLine(""), "");
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

TEST(Context, ErrorLineIsValidUtf8) {
  EXPECT_EQ(oneLine("a\xEF"
                    "b\nc\xc3\xa9\x07\n"),
            "a\xEF\xBF\xBD"
            "b; c\xc3\xa9 ");
}

TEST(Context, WorkerCountIsTheRequestedOneAndAtLeastOne) {
  Context context;
  EXPECT_GE(context.workers(), 1);
  context.threads = 3;
  EXPECT_EQ(context.workers(), 3);
}

// Property: the monitor reports a requested stop, and has no progress bar in quiet mode.
TEST(Context, MonitorForwardsTheStopRequest) {
  std::stop_source source;
  Context context;
  context.quiet = true;
  context.stop = source.get_token();
  const ProgressMonitor watch = context.watch("plan");
  EXPECT_FALSE(watch.progress);
  EXPECT_FALSE(watch.stopped());
  source.request_stop();
  EXPECT_TRUE(watch.stopped());
}

}  // namespace context_test
}  // namespace talus::cli
