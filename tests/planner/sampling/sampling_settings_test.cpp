#include <stdexcept>
#include <string>

#include <gmock/gmock.h>

#include <talus/planner/plan/named_planner.hpp>
#include <talus/planner/route/planner_names.hpp>
#include <talus/planner/sampling/sampling_settings.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace sampling_settings_test {

using ::testing::HasSubstr;

TEST(SamplingSettings, TextRoundTrips) {
  const SamplingSettings settings = samplingSettings("rrt*:range=20:cold:goal_bias=0.1");
  EXPECT_EQ(settings.planner, "RRTstar");
  EXPECT_TRUE(settings.cold);
  EXPECT_EQ(settings.parameters.at("range"), "20");
  EXPECT_EQ(wordsOf(settings), "RRTstar:cold:goal_bias=0.1:range=20");
  EXPECT_EQ(wordsOf(samplingSettings(wordsOf(settings))), wordsOf(settings));
  for (const std::string& name : plannerNames()) EXPECT_EQ(wordsOf(samplingSettings(name)), name);
  EXPECT_EQ(warmAndCold().size(), plannerNames().size() + 6);
  for (const std::string& words : warmAndCold()) EXPECT_EQ(wordsOf(samplingSettings(words)), words);
}

TEST(SamplingSettings, UnsupportedParametersAreRejectedByName) {
  const auto said = [](const std::string& words) -> std::string {
    try {
      samplingSettings(words);
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_THAT(said("RRTstar:speed=3"), HasSubstr("no parameter 'speed'; it has "));
  EXPECT_THAT(said("RRTstar:range=far"), HasSubstr("range does not take 'far'"));
  EXPECT_THAT(said("RRTstar:warm"), HasSubstr("'warm' is neither cold nor NAME=VALUE"));
  EXPECT_THAT(said("field:cold"), HasSubstr("not an OMPL planner"));
  EXPECT_THAT(said("hybrid:range=2"), HasSubstr("not an OMPL planner"));
}

// Property: the first solution is the field's route, unless the option `cold` is set; parameters are passed
// to the planner.
TEST(SamplingSettings, ColdStartOmitsTheFieldRoute) {
  Problem problem{
      .map = testing::randomMap({.width = 40, .height = 40, .seed = 3, .blocked = 0.05, .roughness = 0.2}),
      .start = {3.5, 3.5},
      .goal = {36.5, 35.5},
      .prove = false};
  const double field_J = NamedPlanner().plan(problem).cost_J;
  const auto first_J = [&](const std::string& words) {
    NamedPlanner planner(words);
    double first = -1.0;
    planner.onBetter([&](double cost_J) { first = first < 0.0 ? cost_J : first; });
    EXPECT_EQ(planner.plan(problem).status, RouteStatus::Found) << words;
    return first;
  };
  EXPECT_EQ(first_J("RRTstar"), field_J);
  EXPECT_GT(first_J("RRTstar:cold"), field_J);
  EXPECT_NE(first_J("RRTstar:cold:range=2"), first_J("RRTstar:cold:range=30"));
}

}  // namespace sampling_settings_test
}  // namespace talus::planner
