// The program and the C++ and C interfaces plan the same route for the same request; tests/planner/python compares
// Python with the program.
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <talus.h>

#include <talus/planner/planner.hpp>
#include <talus/planner/site/site.hpp>

#include "bad_input.hpp"
#include "run_program.hpp"

namespace talus::cli {
namespace same_route_test {

constexpr int kWidth = 48, kHeight = 36;
const PlanRequest kThere{.start = {4.0, 5.0}, .goal = {43.0, 30.0}};

constexpr const char* kRover =
    "rover: {name: small, mass_kg: 90, gravity_m_s2: 1.625, wheels: {count: 4, radius_m: 0.2, width_m: 0.2}, "
    "wheelbase_m: 0.9, track_m: 0.8, clearance_m: 0.25, centre_of_mass_height_m: 0.4, max_pitch_rad: 0.4, "
    "max_roll_rad: 0.4, max_torque_Nm: 40, max_speed_mps: 0.2, hotel_power_W: 50, steering: skid}\n";
constexpr const char* kSoil =
    "soil: {name: sand, cohesion_Pa: 170, friction_angle_rad: 0.61, sinkage_exponent: 1, cohesive_modulus: "
    "1400, "
    "frictional_modulus: 820000, shear_modulus_m: 0.018}\n";

// Elevations in multiples of 1/8 m, which three decimals and a float represent exactly.
double bumpy(int column, int row) {
  return std::round(8.0 * (1.5 * std::sin(column / 6.0) * std::cos(row / 5.0) + 0.04 * column)) / 8.0;
}

struct Vertex {
  double x_m, y_m, elevation_m;
  friend bool operator==(const Vertex&, const Vertex&) = default;
  friend void PrintTo(const Vertex& v, std::ostream* out) {
    *out << fmt::format("{},{},{}", v.x_m, v.y_m, v.elevation_m);
  }
};

struct Answer {
  double cost = 0.0;
  std::vector<Vertex> vertices;
};

Answer answerOf(const planner::Route& route) {
  Answer answer{.cost = route.cost, .vertices = {}};
  for (const planner::RouteVertex& v : route.vertices)
    answer.vertices.push_back({v.x_m, v.y_m, v.elevation_m});
  return answer;
}

class SameRoute : public ::testing::Test {
 protected:
  SameRoute() {
    folder_.write("bumpy.asc", asciiGrid(kWidth, kHeight, bumpy));
    folder_.write("rover.yaml", kRover);
    folder_.write("soil.yaml", kSoil);
  }

  Answer byProgram() const {
    const Ran ran =
        runTalus({"plan", "bumpy.asc", "--no-proof", "--resolution", "1", "--rover", "rover.yaml", "--soil",
                  "soil.yaml", "--start", "4,5", "--goal", "43,30", "--json", "-o", "r.geojson"},
                 folder_.path());
    EXPECT_EQ(ran.code, 0) << ran.err;
    const auto route = nlohmann::json::parse(fileContent(folder_ / "r.geojson"))["features"][0]["properties"];
    Answer answer{.cost = nlohmann::json::parse(ran.out)["cost"], .vertices = {}};
    for (std::size_t i = 0; i < route["x_m"].size(); ++i)
      answer.vertices.push_back({route["x_m"][i], route["y_m"][i], route["elevation_m"][i]});
    return answer;
  }

  Answer byCpp() const {
    SiteFiles files{
        .elevation = folder_ / "bumpy.asc", .soil = folder_ / "soil.yaml", .rover = folder_ / "rover.yaml"};
    files.elevation.read.resolution_m = 1.0;
    return answerOf(Planner().plan(Map(readSite(files)), kThere));
  }

  static std::vector<float> heights() {
    std::vector<float> heights;
    for (int row = 0; row < kHeight; ++row)
      for (int column = 0; column < kWidth; ++column)
        heights.push_back(static_cast<float>(bumpy(column, row)));
    return heights;
  }

  static Answer byC();

  Folder folder_;
};

Answer SameRoute::byC() {
  talus_error error{};
  talus_rover rover;
  talus_default_rover(&rover);
  rover.mass_kg = 90.0;
  rover.gravity_m_s2 = 1.625;
  rover.wheel_radius_m = rover.wheel_width_m = 0.2;
  rover.wheelbase_m = 0.9;
  rover.track_m = 0.8;
  rover.clearance_m = 0.25;
  rover.centre_of_mass_height_m = rover.max_pitch_rad = rover.max_roll_rad = 0.4;
  rover.max_torque_Nm = 40.0;
  rover.max_speed_mps = 0.2;
  rover.hotel_power_W = 50.0;
  talus_soil soil;
  talus_default_soil(&soil);
  soil.cohesion_Pa = 170.0;
  soil.friction_angle_rad = 0.61;
  soil.cohesive_modulus = 1400.0;
  soil.frictional_modulus = 820000.0;
  soil.shear_modulus_m = 0.018;
  talus_options options;
  talus_default_options(&options);
  const std::vector<float> elevation = heights();
  const talus_grid grid{sizeof grid, kWidth, kHeight, 1.0, 0.0, 0.0};
  const talus_layers layers{sizeof layers, elevation.size(), elevation.data(), nullptr, nullptr, nullptr};
  talus_session session = 0;
  EXPECT_EQ(talus_create(&rover, &soil, 1, &grid, &layers, &options, &session, &error), TALUS_OK)
      << error.text;
  const talus_request request{sizeof request,  kThere.start.x_m, kThere.start.y_m,
                              kThere.goal.x_m, kThere.goal.y_m,  0.0};
  talus_summary summary{};
  summary.size = sizeof summary;
  EXPECT_EQ(talus_plan(session, &request, &summary, &error), TALUS_OK) << error.text;
  std::vector<talus_vertex> vertices(summary.vertices);
  std::size_t written = 0;
  EXPECT_EQ(talus_read_route(session, 0, vertices.data(), vertices.size(), &written, &error), TALUS_OK);
  talus_destroy(session, &error);
  Answer answer{.cost = summary.cost_J, .vertices = {}};
  for (const talus_vertex& v : vertices) answer.vertices.push_back({v.x_m, v.y_m, v.elevation_m});
  return answer;
}

TEST_F(SameRoute, EveryInterfaceYieldsTheSameRoute) {
  const Answer route = byCpp();
  ASSERT_GT(route.vertices.size(), 20U);
  EXPECT_TRUE(std::isfinite(route.vertices.front().elevation_m));
  const std::vector<std::pair<std::string, Answer>> others{{"the program", byProgram()}, {"C", byC()}};
  for (const auto& [who, other] : others) {
    EXPECT_EQ(other.cost, route.cost) << who;
    EXPECT_EQ(other.vertices, route.vertices) << who;
  }
}

}  // namespace same_route_test
}  // namespace talus::cli
