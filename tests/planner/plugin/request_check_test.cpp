#include <talus/planner/plugin/global_planner.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace request_check_test {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(RequestCheck, EachUnsupportedFieldIsRejectedByName) {
  // Property: a request with one field set is accepted exactly if the planner declares the capability of
  // that field.
  struct Case {
    const char* field;
    void (*set)(PlanRequest&);
    void (*honour)(PlannerCapabilities&);
  };
  const Case cases[] = {
      {"via",
       [](PlanRequest& r) {
         r.via = {{1, 1}};
       },
       [](auto& c) { c.via_points = true; }},
      {"other_goals",
       [](PlanRequest& r) {
         r.other_goals = {{1, 1}};
       },
       [](auto& c) { c.several_goals = true; }},
      {"start_heading_rad", [](PlanRequest& r) { r.start_heading_rad = 0.0; },
       [](auto& c) { c.headings = true; }},
      {"goal_heading_rad", [](PlanRequest& r) { r.goal_heading_rad = 0.0; },
       [](auto& c) { c.headings = true; }},
      {"kinematics", [](PlanRequest& r) { r.kinematics = Kinematics{}; },
       [](auto& c) { c.turning_radius = true; }},
      {"may_reverse", [](PlanRequest& r) { r.kinematics = Kinematics{.may_reverse = false}; },
       [](auto& c) { c.turning_radius = c.reversing = true; }},
      {"risk_limit", [](PlanRequest& r) { r.risk_limit = RiskLimit{}; },
       [](auto& c) { c.risk_limit = true; }},
  };
  EXPECT_NO_THROW(requireHonoured({}, {}));
  for (const Case& c : cases) {
    PlanRequest request;
    c.set(request);
    PlannerCapabilities offers{.name = "made", .planner = "plain"};
    if (std::string(c.field) == "may_reverse") offers.turning_radius = true;
    EXPECT_THAT([&] { requireHonoured(request, offers); },
                ThrowsMessage<std::invalid_argument>(
                    AllOf(HasSubstr(c.field), HasSubstr("not honoured by planner 'plain' of made"))));
    c.honour(offers);
    EXPECT_NO_THROW(requireHonoured(request, offers)) << c.field;
  }
}

TEST(RequestCheck, ChassisIsRejectedIfUnsupported) {
  const maps::Raster<float> flat({.width = 4, .height = 4, .resolution_m = 1.0, .south_west = {}}, 0.0F);
  terramech::Rover rover;
  rover.wheelbase_m = rover.track_m = 0.5;
  PlanRequest request;
  request.chassis = std::make_shared<const Chassis>(flat, rover, Suspension::Rigid);
  EXPECT_THROW(requireHonoured(request, {}), std::invalid_argument);
  EXPECT_NO_THROW(requireHonoured(request, {.chassis = true}));
}

TEST(RequestCheck, ValuesOutOfRangeAreRejectedWithTheirBound) {
  const PlannerCapabilities all{.headings = true, .turning_radius = true, .risk_limit = true};
  const auto refused = [&all](const PlanRequest& request) { return [&] { requireHonoured(request, all); }; };
  PlanRequest request;
  request.start_heading_rad = NAN;
  EXPECT_THAT(refused(request),
              ThrowsMessage<std::invalid_argument>(HasSubstr("start_heading_rad = nan, must be finite")));
  request = {};
  request.goal.x_m = INFINITY;
  EXPECT_THAT(refused(request),
              ThrowsMessage<std::invalid_argument>(HasSubstr("goal.x_m = inf, must be finite")));
  request = {};
  request.via = {{1.0, NAN}};
  EXPECT_THROW(requireHonoured(request, {.via_points = true}), std::invalid_argument);
  request = {};
  request.tolerance_m = -1.0;
  EXPECT_THAT(refused(request),
              ThrowsMessage<std::invalid_argument>(HasSubstr("tolerance_m = -1, must be >= 0")));
  request = {};
  request.kinematics = Kinematics{.turning_radius_m = -2.0};
  EXPECT_THAT(refused(request), ThrowsMessage<std::invalid_argument>(HasSubstr("turning_radius_m = -2")));
  request.kinematics = Kinematics{.turning_radius_m = 1e-9};
  EXPECT_THAT(refused(request),
              ThrowsMessage<std::invalid_argument>(HasSubstr("must be 0 or 0.001 to 1000")));
  request = {};
  request.risk_limit = RiskLimit{.immobilisation = 1.0};
  EXPECT_THAT(refused(request), ThrowsMessage<std::invalid_argument>(HasSubstr("above 0 and below 1")));
}

}  // namespace request_check_test
}  // namespace talus::planner
