#include <talus/common/nearest_name.hpp>
#include <talus/terramech/io/column_units.hpp>
#include <talus/terramech/io/file_keys.hpp>

namespace talus::terramech {

std::span<const FileKey> soilKeys() {
  static constexpr FileKey kKeys[] = {
      {"name", "of the soil; default unnamed"},
      {"cohesion_Pa", "0 to 1e9, required"},
      {"friction_angle_rad", "angle of internal friction, 0 to below a right angle, required"},
      {"sinkage_exponent", "n of Bekker's pressure-sinkage law, 0.001 to 100, required"},
      {"cohesive_modulus", "k_c in N/m^(n+1), default 0; one of the two moduli is required"},
      {"frictional_modulus", "k_phi in N/m^(n+2), default 0"},
      {"shear_modulus_m", "shear deformation modulus K, 1e-9 to 1000, required"},
      {"c1", "angle of the peak stress over the entry angle without slip, 0 to 1, default 0.43"},
      {"c2", "growth of c1 with slip, -1 to 1, default 0.32"},
      {"density_kg_m3", "bulk density, 0.1 to 1e6, default 1600"},
      {"slip_sinkage_exponent", "growth of the sinkage exponent with slip, 0 to 2, default 0"},
      {"digging_exponent", "growth of the sinkage exponent with sideways slip, 0 to 2, default 0.4"},
      {"side_bulldozing", "share of Hegedus' pressure on the side of a wheel, >= 0, default 1"},
      {"rut_stiffness", "stiffness in the rut of a wheel over that before, 1 to 1000, default 4"},
      {"test_gravity_m_s2",
       "gravity of the soil's test; in less, cohesion and moduli are less by as much; default 0: that of the "
       "rover"},
  };
  return kKeys;
}

std::span<const FileKey> roverKeys() {
  static constexpr FileKey kKeys[] = {
      {"name", "of the rover; default unnamed"},
      {"mass_kg", "0.1 to 1e6, required"},
      {"gravity_m_s2", "above 0, of the body that it drives on; default 9.80665"},
      {"wheels", "a mapping, see below, required"},
      {"wheelbase_m", "first to last axle, above 0, required"},
      {"track_m", "left to right wheel centres, above 0, required"},
      {"clearance_m", "ground to belly, above 0, required"},
      {"centre_of_mass_height_m", "above ground; default 0: unknown, no load moves on a slope"},
      {"centre_of_mass_ahead_m", "of the middle of the wheelbase, default 0"},
      {"centre_of_mass_left_m", "of the middle of the track, default 0"},
      {"max_pitch_rad", "greatest tilt along the heading, default 0.35"},
      {"max_roll_rad", "greatest tilt across the heading, default 0.35"},
      {"max_torque_Nm", "of each wheel, above 0, required"},
      {"max_speed_mps", "rim speed on level ground, 0.0001 to 100, default 0.05"},
      {"turning_radius_m", "0.001 to 1000; default 0: turns in place"},
      {"hotel_power_W", "consumed whether the rover drives or not, default 0"},
      {"steering", "skid (default), ackermann or all_wheel"},
  };
  return kKeys;
}

std::span<const FileKey> wheelKeys() {
  static constexpr FileKey kKeys[] = {
      {"count", "2 or more, required"},
      {"radius_m", "0.001 to 10, required"},
      {"width_m", "0.001 to 10, required"},
      {"grouser_height_m", "default 0: a smooth rim"},
      {"grouser_count", "default 0"},
      {"lug_thrust", "0 to 5, default 1 with lugs: share of Bekker's shear on their sides"},
  };
  return kKeys;
}

std::span<const FileKey> telemetryKeys() {
  static constexpr FileKey kKeys[] = {
      {"run", "word that joins the rows of one run"},
      {"wheel", "word or number of the wheel that a row is of"},
      {"pass_index", "1, 2, ...: number of the passage over the same ground"},
      {"time_s", "of the row; rows of one time are of one moment"},
      {"x_m", "place of the wheel or rover, in map metres"},
      {"y_m", "place of the wheel or rover, in map metres"},
      {"z_m", "elevation of the place"},
      {"heading_rad", "counter-clockwise from east"},
      {"pitch_rad", "of the body, positive uphill"},
      {"roll_rad", "of the body, -1.5 to 1.5"},
      {"slope_rad", "of the ground along the heading, positive uphill, -1.5 to 1.5"},
      {"slip", "1 - v/(r omega) driven, -1 to 1"},
      {"slip_angle_rad", "from the wheel's plane to the direction of travel, left positive, -1.6 to 1.6"},
      {"speed_mps", "of the wheel's centre"},
      {"rim_speed_mps", "radius times rotation rate"},
      {"load_N", "normal to the ground, above 0"},
      {"torque_Nm", "at the axle"},
      {"sinkage_m", "0 to below the wheel's diameter"},
      {"drawbar_pull_N", "net force along the wheel's plane"},
      {"side_force_N", "across the wheel's plane"},
      {"wheel_radius_m", "0.001 to 10; else that of the rover"},
      {"wheel_width_m", "0.001 to 10; else that of the rover"},
      {"grouser_height_m", "0 to 1"},
      {"grouser_count", "0 to 1000"},
      {"shear_modulus_m", "of the soil, where it is known"},
  };
  return kKeys;
}

std::vector<std::string> namesOf(std::span<const FileKey> keys) {
  std::vector<std::string> names;
  for (const FileKey& key : keys) names.emplace_back(key.name);
  return names;
}

std::string meantKey(const std::string& key, const std::vector<std::string>& known) {
  for (const std::string& name : known)
    if (stemOf(name) == key || stemOf(name) == stemOf(key)) return name;
  return nearestName(key, known);
}

}  // namespace talus::terramech
