#include <algorithm>
#include <cmath>
#include <string>

#include <site_fixture.hpp>
#include <site_map.hpp>

#include <talus/common/common.hpp>
#include <talus/costmap/costmap.hpp>
#include <talus/costmap/ground/cost_curve_table.hpp>
#include <talus/costmap/map/map_file.hpp>
#include <talus/costmap/telemetry/telemetry_processor.hpp>

namespace talus::costmap {
namespace explanation_test {

using terramech::Category;

const Cause& cause(const Explanation& explanation, const std::string& name) {
  const auto found = std::find_if(explanation.causes.begin(), explanation.causes.end(),
                                  [&](const Cause& c) { return c.name == name; });
  if (found == explanation.causes.end()) throw std::out_of_range(name);
  return *found;
}

const std::vector<std::string> kPlain(12, "111111111111");

TEST(Explain, SafeCellListsItsCauses) {
  const Explanation e = explain(mapOf(kPlain, 0.05), {6, 6});
  EXPECT_EQ(e.category, Category::Safe);
  // Closed form: the given plane. Tolerance: heights of 1000 m are stored as floats, 6e-5 m apart.
  EXPECT_NEAR(cause(e, "slope_rad").value, std::atan(0.05), 1e-4);
  EXPECT_NEAR(cause(e, "slope_along_rad").value, std::atan(0.05),
              1e-3);  // the slope is stored in steps of 1/1024
  EXPECT_EQ(cause(e, "evidence_samples").value, 0.0);
  EXPECT_GT(cause(e, "drawbar_pull_over_load").std, 0.0);
}

TEST(Explain, CategoryDependsOnHeading) {
  const TraversabilityMap map = mapOf(kPlain, 0.2);
  const Explanation up = explain(map, {6, 6}, Direction{1, 0});
  const Explanation down = explain(map, {6, 6}, Direction{-1, 0});
  EXPECT_LT(cause(down, "energy_J_per_m").value, cause(up, "energy_J_per_m").value);
  EXPECT_NE(up.category, Category::Safe);
  EXPECT_EQ(down.category, Category::Safe);
}

// Property: without a heading the category is that of the map, also for refused cells, and no better than in
// the worst heading.
TEST(Explain, CategoryWithoutHeadingIsThatOfTheMapAndWorstHeading) {
  for (int k = 0; k < 30; ++k) {
    const TraversabilityMap map = mapOf(kPlain, 0.0133 * k);
    const Explanation cell = explain(map, {6, 6});
    const Direction worst = worstHeading(map.published()->cost(), map.published()->at({6, 6}));
    EXPECT_EQ(static_cast<std::uint8_t>(cell.category), map.costs().category({6, 6})) << k;
    EXPECT_GE(cell.category, explain(map, {6, 6}, worst).category) << k;
    EXPECT_EQ(cell.verdict.find(terramech::name(cell.category)), 0U) << cell.verdict;
    const bool refused = cell.verdict.find("; refused") != std::string::npos;
    EXPECT_TRUE(!refused || cell.category == Category::Dangerous) << cell.verdict;
  }
}

TEST(Explain, VerdictNamesTheHazard) {
  std::vector<std::string> site = kPlain;
  site[5][6] = '#';
  const Explanation e = explain(mapOf(site), {6, 6});
  EXPECT_EQ(e.category, Category::Dangerous);
  EXPECT_NE(e.verdict.find("keep-out"), std::string::npos);
}

TEST(Explain, UnseenCellIsUnknown) {
  std::vector<std::string> site = kPlain;
  site[5][6] = '?';
  const Explanation unseen = explain(mapOf(site), {6, 6});
  EXPECT_EQ(unseen.category, Category::Unknown);
  EXPECT_TRUE(std::isnan(unseen.probability)) << "Unknown has none";
}

// Property: for an unseen cell that the policy opens, the explanation states the policy and the assumed
// ground.
TEST(Explain, UnseenCellOpenedByPolicyIsReported) {
  std::vector<std::string> site = kPlain;
  site[5][6] = '?';
  const Explanation open = explain(mapOf(site, 0.0, {.allow_unknown = true}), {6, 6});
  EXPECT_NE(open.category, Category::Unknown);
  EXPECT_NE(open.verdict.find("unknown; allowed on request, at the slope between the heights beside it, as"),
            std::string::npos)
      << open.verdict;
  EXPECT_EQ(cause(open, "hazard").remark, "not excluded");
}

// Property: immobilisation evidence on an unseen cell refuses the cell, and the explanation states the
// evidence, whether or not the policy opens the cell.
TEST(Explain, UnseenCellWithImmobilisationEvidenceIsRefused) {
  std::vector<std::string> site = kPlain;
  site[5][6] = '?';
  TraversabilityMap map = mapOf(site, 0.0, {.allow_unknown = true});
  WheelObservation spun{.time_s = 1.0, .place = map.grid().centre({6, 6}), .pull = {}, .sinkage = {}};
  spun.here.most_pull = -0.4;
  ASSERT_TRUE(map.learn(boundAlone(spun)));
  map.publish();
  const Explanation held = explain(map, {6, 6});
  EXPECT_EQ(held.category, Category::Dangerous);
  EXPECT_NE(held.verdict.find("refused"), std::string::npos) << held.verdict;
  EXPECT_NE(held.verdict.find("allowed on request"), std::string::npos) << held.verdict;
  EXPECT_EQ(cause(held, "evidence_samples").remark.find("prior only"), std::string::npos);
}

// Property: a place to drive to next is allowed, and a reading there reduces the expected deviation of ground that
// is not safe; on ground that is safe in every heading there is none.
TEST(Explain, NextDriveReducesTheDeviationOfUnsafeGround) {
  EXPECT_FALSE(nextDrive(mapOf(kPlain), {6, 6}).has_value());
  const TraversabilityMap steep = mapOf(kPlain, 0.2);
  const auto next = nextDrive(steep, {6, 6});
  ASSERT_TRUE(next.has_value());
  EXPECT_TRUE(std::isfinite(
      steep.published()->cost().costPerMetre(steep.published()->at(next->cell), next->heading)));
  EXPECT_LT(next->after, next->std);
}

using testing::HasSubstr;

MapText example() {
  MapText text;
  text.grid = {.width = 7, .height = 9, .resolution_m = 0.1, .south_west = {-1.0 / 3.0, 1e-300}};
  text.source = "a \\n map\nof two lines\\";
  text.footprint_radius_m = 0.45;
  text.ground = testGround()->parts();
  text.ground.rover.steering = terramech::Steering::Ackermann;
  text.ground.rover.centre_of_mass_left_m = -0.03;
  text.ground.rover.max_torque_Nm = std::numeric_limits<double>::infinity();
  text.ground.policy.allow_unknown = true;
  text.ground.classes[0].soil.digging_exponent = 0.1;
  text.ground.classes[0].soil.slip_sinkage_exponent = 0.3;
  text.ground.classes[0].soil.side_bulldozing = 0.0;
  text.ground.classes[1].effects = {{.name = "empirical",
                                     .covariate = "slip",
                                     .channel = terramech::Channel::Torque,
                                     .parameters = {0.1, -0.2},
                                     .knots = {0.0, 0.7},
                                     .only_column = "wheel",
                                     .only_value = "front\nleft"}};
  return text;
}

TEST(MapText, RoundTripIsExact) {
  const MapText back = parsed(written(example()), "m");
  EXPECT_EQ(back.grid, example().grid);
  EXPECT_EQ(back.source, example().source);
  EXPECT_FALSE(back.coordinate_system);
  EXPECT_EQ(back.ground.rover, example().ground.rover);
  EXPECT_TRUE(back.ground.policy.allow_unknown);
  ASSERT_EQ(back.ground.classes.size(), 2U);
  EXPECT_EQ(back.ground.classes[0].soil.digging_exponent, 0.1);
  EXPECT_EQ(back.ground.classes[0].soil.slip_sinkage_exponent, 0.3);
  EXPECT_EQ(back.ground.classes[0].soil.side_bulldozing, 0.0);
  EXPECT_EQ(back.ground.classes[1].effects[0].knots, (std::vector<double>{0.0, 0.7}));
  EXPECT_EQ(back.ground.classes[1].effects[0].parameters, (std::vector<double>{0.1, -0.2}));
  EXPECT_EQ(back.ground.classes[1].effects[0].channel, terramech::Channel::Torque);
  EXPECT_EQ(back.ground.classes[1].effects[0].only_value, "front\nleft");
  EXPECT_EQ(written(back), written(example()));
}

// Property: every field of the coordinate system is stored; on Mars, a planetocentric latitude read as
// planetographic has an error of up to 20 km.
TEST(MapText, CoordinateSystemRoundTripsCompletely) {
  for (const bool planetocentric : {false, true}) {
    MapText text = example();
    text.coordinate_system = {.name = "Mars / Ocentric",
                              .ellipsoid = maps::kMars,
                              .projection = {.method = maps::ProjectionMethod::LambertConformalConic,
                                             .latitude_of_origin_rad = 0.1,
                                             .central_meridian_rad = 0.2,
                                             .standard_parallel_1_rad = 0.3,
                                             .standard_parallel_2_rad = 0.4,
                                             .scale = 0.9996,
                                             .false_easting_m = 5e5,
                                             .false_northing_m = -1e7},
                              .planetocentric = planetocentric,
                              .wkt = "PROJCRS[\"a\",\n  b]"};
    const auto back = parsed(written(text), "m").coordinate_system;
    ASSERT_TRUE(back);
    EXPECT_EQ(back->name, "Mars / Ocentric");
    EXPECT_EQ(back->ellipsoid, maps::kMars);
    EXPECT_EQ(back->planetocentric, planetocentric);
    EXPECT_EQ(back->wkt, text.coordinate_system->wkt);
    const maps::Point a = maps::Georeference(*back).forward({0.35, 0.25});
    EXPECT_EQ(a, maps::Georeference(*text.coordinate_system).forward({0.35, 0.25}));
  }
}

// Property: of shortened and changed content, each byte of each, all that is not content is one refusal.
TEST(MapText, DamageIsRefusedOrReadAsOtherValues) {
  const std::string bytes = written(example());
  std::size_t refused = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i)
    for (const std::string& damaged : {bytes.substr(0, i), bytes.substr(0, i) + '\xff' + bytes.substr(i + 1)})
      try {
        parsed(damaged, "map.ot");
      } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("map.ot: damaged"));
        ++refused;
      }
  EXPECT_GT(refused, bytes.size());
  EXPECT_THROW(parsed("", "map.ot"), InputError);
}

}  // namespace explanation_test
}  // namespace talus::costmap
