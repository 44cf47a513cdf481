#include <set>
#include <string>

#include <talus/costmap/cost/drive_state.hpp>

namespace talus::costmap {
namespace drive_state_test {

TEST(DriveState, EveryRefusalHasWordsOfItsOwn) {
  std::set<std::string> texts;
  for (int i = 0; i <= static_cast<int>(Refusal::Tips); ++i) texts.insert(toText(static_cast<Refusal>(i)));
  EXPECT_EQ(texts.size(), static_cast<std::size_t>(Refusal::Tips) + 1);
  EXPECT_FALSE(texts.contains(""));
}

}  // namespace drive_state_test
}  // namespace talus::costmap
