#include <stdexcept>

#include <talus/planner/route/planner_names.hpp>

namespace talus::planner {
namespace planner_names_test {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(PlannerNames, SpellingVariantsAreAccepted) {
  EXPECT_EQ(plannerName(""), "field");
  EXPECT_EQ(plannerName("RRT*"), "RRTstar");
  EXPECT_EQ(plannerName("informed-rrt*"), "InformedRRTstar");
  EXPECT_EQ(plannerName("bit_star"), "BITstar");
  EXPECT_EQ(plannerName("ABIT*"), "ABITstar");
  for (const std::string& name : plannerNames()) EXPECT_EQ(plannerName(name), name);
}

TEST(PlannerNames, UnsupportedPlannerIsRejectedWithItsReason) {
  EXPECT_THAT([] { plannerName("PRM*"); }, ThrowsMessage<std::invalid_argument>(
                                               AllOf(HasSubstr("PRMstar"), HasSubstr("both directions"))));
  for (const char* name : {"PRM*", "LazyPRM*", "SPARS", "BFMT", "LBTRRT", "AIT*", "RRTConnect"})
    EXPECT_THAT([&] { plannerName(name); }, ThrowsMessage<std::invalid_argument>(HasSubstr("is refused: ")))
        << name;
}

TEST(PlannerNames, UnknownPlannerSuggestsTheNearestName) {
  EXPECT_THAT([] { plannerName("feild"); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("nearest is 'field'")));
  EXPECT_THAT([] { plannerName("BITsta"); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("nearest is 'BITstar'")));
}

}  // namespace planner_names_test
}  // namespace talus::planner
