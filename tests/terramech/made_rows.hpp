#pragma once

#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/estimate/telemetry.hpp>

namespace talus::terramech {

/// A synthetic sand.
inline Soil madeSand() {
  return {.name = "sand",
          .cohesion_Pa = 800.0,
          .friction_angle_rad = 0.55,
          .sinkage_exponent = 1.1,
          .cohesive_modulus = 900.0,
          .frictional_modulus = 1.5e6,
          .shear_modulus_m = 0.016};
}

/// Rows of synthetic telemetry, one number for each column.
class MadeRows {
 public:
  explicit MadeRows(std::vector<std::string> columns) {
    for (std::string& name : columns) telemetry_.numbers.push_back({std::move(name), {}});
  }

  void add(const std::vector<double>& row, const std::string& label = "") {
    for (std::size_t k = 0; k < row.size(); ++k) telemetry_.numbers[k].values.push_back(row[k]);
    labels_.push_back(label);
    telemetry_.lines.push_back(labels_.size() + 1);
  }

  /// Converts to telemetry; the labels become a text column of the given name, unless the name is empty.
  Telemetry telemetry(const std::string& column = "") const {
    Telemetry t = telemetry_;
    t.source = "made";
    if (!column.empty()) t.words.push_back({column, labels_});
    return t;
  }

 private:
  Telemetry telemetry_;
  std::vector<std::string> labels_;
};

inline const std::vector<std::string>& wheelColumns() {
  static const std::vector<std::string> all{"load_N",         "slip",           "torque_Nm",    "sinkage_m",
                                            "drawbar_pull_N", "wheel_radius_m", "wheel_width_m"};
  return all;
}

/// Readings of a wheel of 0.1 x 0.1 m on a soil, with a normal relative error on each reading.
inline std::vector<double> wheelRow(const Soil& soil, double load_N, double slip, double noise,
                                    std::mt19937_64& random) {
  std::normal_distribution<double> error(1.0, noise > 0.0 ? noise : 1e-12);
  const WheelForces f =
      equilibrium(soil, Wheel{.radius_m = 0.1, .width_m = 0.1}, {.load_N = load_N, .slip = slip});
  return {load_N,
          slip,
          f.torque_Nm * error(random),
          f.sinkage_m * error(random),
          f.drawbar_pull_N * error(random),
          0.1,
          0.1};
}

/// Readings with a torque offset of 0.8 Nm and a pull offset of 0.05 W.
inline Telemetry twoFaults(const Soil& soil) {
  MadeRows rows(wheelColumns());
  std::mt19937_64 random(8);
  for (int k = 0; k < 80; ++k) {
    std::vector<double> row =
        wheelRow(soil, 40.0 + (k * 7) % 80, 0.05 + 0.05 * ((k * 11) % 16), 0.02, random);
    row[2] += 0.8;
    row[4] += 0.05 * row[0];
    rows.add(row);
  }
  return rows.telemetry();
}

}  // namespace talus::terramech
