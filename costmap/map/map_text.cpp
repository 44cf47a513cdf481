#include <cstdint>
#include <stdexcept>
#include <tuple>
#include <utility>

#include <nlohmann/json.hpp>

#include <talus/costmap/map/map_file.hpp>

// The macros define the conversions of each type in its namespace. A field that a file lacks has its default.
namespace talus {
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(InputFile, path, role, size, sha256, used)
}

namespace talus::maps {
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(Point, x_m, y_m)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(Grid, width, height, resolution_m, south_west)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(Ellipsoid, equatorial_radius_m, flattening)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(Projection, method, latitude_of_origin_rad,
                                                central_meridian_rad, standard_parallel_1_rad,
                                                standard_parallel_2_rad, scale, false_easting_m,
                                                false_northing_m)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(CoordinateSystem, name, ellipsoid, projection, planetocentric,
                                                wkt)
}  // namespace talus::maps

namespace talus::terramech {
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(Wheel, radius_m, width_m, grouser_height_m, grouser_count,
                                                lug_thrust)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(Rover, name, mass_kg, gravity_m_s2, wheel_count, wheel,
                                                wheelbase_m, track_m, clearance_m, centre_of_mass_height_m,
                                                centre_of_mass_ahead_m, centre_of_mass_left_m, max_pitch_rad,
                                                max_roll_rad, max_torque_Nm, max_speed_mps, turning_radius_m,
                                                hotel_power_W, steering)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(Soil, name, cohesion_Pa, friction_angle_rad, sinkage_exponent,
                                                cohesive_modulus, frictional_modulus, shear_modulus_m, c1, c2,
                                                density_kg_m3, slip_sinkage_exponent, digging_exponent,
                                                side_bulldozing, rut_stiffness, test_gravity_m_s2,
                                                correlation_time_s)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(Effect, name, covariate, channel, parameters, knots,
                                                only_column, only_value)
}  // namespace talus::terramech

namespace talus::costmap {
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(GroundClass, number, soil, effects, pull_std, mean_std,
                                                resistance_std, modulus_std, rut_std, sinkage_std,
                                                rut_stiffness_std)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(TravelPolicy, allow_marginal, allow_dangerous, allow_unknown,
                                                slope_margin_rad, sinkage_threshold, sinkage_critical,
                                                max_immobilisation, pose_error_m, time_weight_W, entrapment,
                                                unmonitored_entrapment, unmonitored, risk_weight_J,
                                                correlation_length_m)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(RefusedPlace, place, radius_m, drive)

using nlohmann::json;

// NOLINTBEGIN(readability-identifier-naming): the names that nlohmann-json looks for
// Arrays, because there are many.
void to_json(json& to, const SavedBlock& saved) {
  const auto& [block, evidence] = saved;
  json sources = json::array();
  for (const auto& [source, of] : evidence.sources)
    sources.push_back({source.drive, source.trust, of.weight, of.pull, of.shared, of.sinkages, of.sinkage,
                       of.updated_s, of.bound.most_pull, of.bound.least_sinkage});
  to = {block.column, block.row, block.terrain_class, evidence.reach, std::move(sources)};
}

void from_json(const json& from, SavedBlock& saved) {
  constexpr std::int64_t kMost = std::int64_t{1} << 56;
  auto& [block, evidence] = saved;
  json sources;
  std::tie(block.column, block.row, block.terrain_class, evidence.reach, sources) =
      from.get<std::tuple<int, int, std::uint8_t, std::uint8_t, json>>();
  for (const json& one : sources) {
    if (one.at(1) > Trust::Twice) throw std::invalid_argument("its evidence is impossible");
    SourceReadings& of = evidence.sources[{one.at(0), one.at(1)}];
    std::size_t at = 2;
    for (std::int64_t* sum : {&of.weight, &of.pull, &of.shared, &of.sinkages, &of.sinkage}) {
      one.at(at++).get_to(*sum);
      if (*sum < -kMost || *sum > kMost) throw std::invalid_argument("its evidence is impossible");
    }
    one.at(7).get_to(of.updated_s);
    one.at(8).get_to(of.bound.most_pull);
    one.at(9).get_to(of.bound.least_sinkage);
  }
}

void to_json(json& to, const TraversabilityMap::Drive& drive) {
  to = {drive.number, drive.sensors};
}
void from_json(const json& from, TraversabilityMap::Drive& drive) {
  from.at(0).get_to(drive.number);
  from.at(1).get_to(drive.sensors);
}
// NOLINTEND(readability-identifier-naming)

std::string written(const MapText& text) {
  std::string bytes;
  json::to_cbor({{"grid", text.grid},
                 {"crs", text.coordinate_system ? json(*text.coordinate_system) : json()},
                 {"source", text.source},
                 {"reading", text.reading},
                 {"files", text.files},
                 {"footprint_radius_m", text.footprint_radius_m},
                 {"rover", text.ground.rover},
                 {"policy", text.ground.policy},
                 {"classes", text.ground.classes},
                 {"refused", text.refused},
                 {"evidence", text.evidence},
                 {"drives", text.drives}},
                bytes);
  return bytes;
}

MapText parsed(const std::string& bytes, const std::string& name) {
  try {
    const json all = json::from_cbor(bytes);
    MapText text;  // field by field: GCC 12 destroys twice what an initialiser that throws has made
    all.at("grid").get_to(text.grid);
    all.at("source").get_to(text.source);
    all.at("reading").get_to(text.reading);
    all.at("files").get_to(text.files);
    all.at("footprint_radius_m").get_to(text.footprint_radius_m);
    all.at("rover").get_to(text.ground.rover);
    all.at("policy").get_to(text.ground.policy);
    all.at("classes").get_to(text.ground.classes);
    all.at("refused").get_to(text.refused);
    all.at("evidence").get_to(text.evidence);
    all.at("drives").get_to(text.drives);
    if (!all.at("crs").is_null()) text.coordinate_system = all["crs"];
    return text;
  } catch (const std::exception& error) {
    throw InputError({name, std::string("damaged or from another version: ") + error.what(),
                      "write the map again with talus costmap"});
  }
}

}  // namespace talus::costmap
