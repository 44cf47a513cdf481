#include <cmath>

#include <nlohmann/json.hpp>

#include <talus/cli/soil/trace_report.hpp>

namespace talus::cli {
namespace channel_errors_test {

TEST(ChannelErrors, UnmeasuredChannelsAreOmitted) {
  EXPECT_EQ(errorsJson({0.5, NAN, 0.25, NAN}).dump(),
            R"({"drawbar_pull_over_load":0.5,"torque_over_load_radius":0.25})");
  EXPECT_EQ(changeText({0.1, NAN, 0.03, NAN}, {0.05, NAN, 0.02, NAN}),
            " drawbar_pull_over_load 0.1000 -> 0.0500 torque_over_load_radius 0.0300 -> 0.0200");
}

}  // namespace channel_errors_test
}  // namespace talus::cli
