#include <set>
#include <string>

#include <talus/costmap/cost/travel_state.hpp>

namespace talus::costmap {
namespace travel_state_test {

TEST(TravelState, RefusalTextsAreUnique) {
  std::set<std::string> texts;
  for (int i = 0; i <= static_cast<int>(Refusal::Tips); ++i) texts.insert(toText(static_cast<Refusal>(i)));
  EXPECT_EQ(texts.size(), static_cast<std::size_t>(Refusal::Tips) + 1);
  EXPECT_FALSE(texts.contains(""));
}

}  // namespace travel_state_test
}  // namespace talus::costmap
