#include <array>
#include <set>
#include <string>

#include <talus/terramech/effects/channel_reading.hpp>

namespace talus::terramech {
namespace channel_reading_test {

constexpr std::array kAll{Channel::DrawbarPull, Channel::Sinkage, Channel::Torque, Channel::SideForce};

// Closed form: pull DP/W, sinkage z/r, torque T/(r W), side force F/W.
TEST(ChannelReading, ChannelsAreScaledByLoadAndRadius) {
  const Reading reading{.load_N = 50.0,
                        .radius_m = 0.2,
                        .sinkage_m = 0.03,
                        .torque_Nm = 4.0,
                        .drawbar_pull_N = 10.0,
                        .side_force_N = -5.0};
  EXPECT_DOUBLE_EQ(reading.scaled(Channel::DrawbarPull), 0.2);
  EXPECT_DOUBLE_EQ(reading.scaled(Channel::Sinkage), 0.15);
  EXPECT_DOUBLE_EQ(reading.scaled(Channel::Torque), 0.4);
  EXPECT_DOUBLE_EQ(reading.scaled(Channel::SideForce), -0.1);
}

// Property: a value added to one ratio changes that ratio and no other.
TEST(ChannelReading, AddScaledChangesOneChannelOnly) {
  for (const Channel channel : kAll) {
    const Reading before{.load_N = 50.0,
                         .radius_m = 0.2,
                         .sinkage_m = 0.03,
                         .torque_Nm = 4.0,
                         .drawbar_pull_N = 10.0,
                         .side_force_N = -5.0};
    Reading after = before;
    after.addScaled(channel, 0.07);
    for (const Channel other : kAll)
      EXPECT_NEAR(after.scaled(other) - before.scaled(other), other == channel ? 0.07 : 0.0, 1e-12);
  }
}

TEST(ChannelReading, ChannelNamesAreUnique) {
  std::set<std::string> names;
  for (const Channel channel : kAll) names.insert(name(channel));
  EXPECT_EQ(names.size(), kAll.size());
}

}  // namespace channel_reading_test
}  // namespace talus::terramech
