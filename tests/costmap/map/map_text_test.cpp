#include <string>

#include <site_fixture.hpp>

#include <talus/common/common.hpp>
#include <talus/costmap/map/map_text.hpp>

namespace talus::costmap {
namespace map_text_test {

using testing::HasSubstr;

MapText example() {
  MapText text;
  text.grid = {.width = 7, .height = 9, .resolution_m = 0.1, .south_west = {-1.0 / 3.0, 1e-300}};
  text.source = "a \\n map\nof two lines\\";
  text.footprint_radius_m = 0.45;
  text.ground = testGround()->parts();
  text.ground.rover.steering = terramech::Steering::Ackermann;
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

std::string replaced(std::string lines, const std::string& old, const std::string& by) {
  const std::size_t at = lines.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return lines.replace(at, old.size(), by);
}

TEST(MapText, RoundTripIsExact) {
  const MapText back = parsed(written(example()), "m");
  EXPECT_EQ(back.grid, example().grid);
  EXPECT_EQ(back.source, example().source);
  EXPECT_FALSE(back.coordinate_system);
  EXPECT_EQ(back.ground.rover.name, "test rover");
  EXPECT_EQ(back.ground.rover.steering, terramech::Steering::Ackermann);
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

// Property: the centre of mass is stored; a centred mass would underestimate tipping.
TEST(MapText, CentreOfMassRoundTrips) {
  MapText text = example();
  text.ground.rover.centre_of_mass_ahead_m = 0.07;
  text.ground.rover.centre_of_mass_left_m = -0.03;
  const std::string lines = written(text);
  const terramech::Rover back = parsed(lines, "m").ground.rover;
  EXPECT_EQ(back.centre_of_mass_ahead_m, 0.07);
  EXPECT_EQ(back.centre_of_mass_left_m, -0.03);
  // A map without the two lines has a rover with a centred mass.
  const std::string older = replaced(lines, "rover.centre_of_mass_left_m -0.03\n", "");
  EXPECT_EQ(parsed(older, "m").ground.rover.centre_of_mass_left_m, 0.0);
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

TEST(MapText, MissingUnknownAndNonNumericLinesAreRejected) {
  const std::string lines = written(example());
  const auto refusal = [&](const std::string& text) {
    try {
      parsed(text, "map.ot");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(refusal(lines), "accepted");
  EXPECT_THAT(refusal(replaced(lines, "grid.width 7\n", "")), HasSubstr("map.ot: damaged"));
  EXPECT_THAT(refusal(replaced(lines, "grid.width 7\n", "")), HasSubstr("'grid.width' is missing"));
  EXPECT_THAT(refusal(lines + "grid.depth 3\n"), HasSubstr("'grid.depth' is unknown"));
  EXPECT_THAT(refusal(lines + "grid\n"), HasSubstr("line 'grid' has no value"));
  for (const char* bad : {"seven", "7 cells", "7.5", "", "99999999999"})
    EXPECT_THAT(refusal(replaced(lines, "grid.width 7\n", "grid.width " + std::string(bad) + "\n")),
                HasSubstr("'grid.width' is not a number"))
        << bad;
  EXPECT_THAT(refusal(replaced(lines, "footprint_radius_m 0.45\n", "footprint_radius_m 1e999\n")),
              HasSubstr("'footprint_radius_m' is not a number"));
  EXPECT_THAT(refusal(replaced(lines, "classes 2\n", "classes 255\n")), HasSubstr("255 classes"));
  EXPECT_THAT(refusal(replaced(lines, "effects 1\n", "effects 100000\n")), HasSubstr("is 100000"));
}

}  // namespace map_text_test
}  // namespace talus::costmap
