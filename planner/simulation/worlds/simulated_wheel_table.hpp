#pragma once

#include <cstddef>
#include <vector>

#include <talus/terramech/contact/rover.hpp>
#include <talus/terramech/contact/soil.hpp>
#include <talus/terramech/effects/effects.hpp>

namespace talus::planner {

/// Table of the forces and the sinkage of a wheel on one soil with its effects (terramech::Effect), computed
/// with the forward model. The table has three dimensions: slip from -1 to 1 (index: row), load from 0.25 to
/// 1.9 times the load on level ground (index: layer), and slip angle from 0 to 45 degrees (index: sheet).
class SimulatedWheelTable {
 public:
  /// Entry of the table: normalised forces and sinkage.
  struct Row {
    double pull = 0.0;     ///< drawbar pull divided by load [-]
    double torque = 0.0;   ///< torque / (load * radius) [-]
    double sinkage = 0.0;  ///< sinkage divided by radius [-]
    double hold = 0.0;     ///< side force against the lateral motion of the wheel, divided by load [-]
  };

  static constexpr std::size_t kRows = 81;   ///< number of slip values
  static constexpr std::size_t kLoads = 12;  ///< number of load values
  static constexpr std::size_t kAngles = 9;  ///< number of slip-angle values

  /// Returns the load of a layer divided by the load on level ground, 0.25 to 1.9.
  static constexpr double load(std::size_t layer) noexcept {
    return 0.25 + 0.15 * static_cast<double>(layer);
  }

  /// Returns the slip angle of a sheet [rad], 0 to 45 degrees.
  static constexpr double angle_rad(std::size_t sheet) noexcept {
    return 0.09817477042468103 * static_cast<double>(sheet);
  }

  /// Computes the table. On a soil that cannot carry the wheel, the pull is -1 and the side force is 0.
  SimulatedWheelTable(const terramech::Soil& soil, const terramech::Rover& rover,
                      const std::vector<terramech::Effect>& effects = {});

  /// Returns the slip of a row, -1 to 1.
  static constexpr double slip(std::size_t row) noexcept {
    return 2.0 * static_cast<double>(row) / (kRows - 1) - 1.0;
  }
  /// Returns the entry of row `i` and `sheet`, interpolated at the load `load_over_flat` (load divided by the
  /// load on level ground), which is clamped to the range of the table.
  Row row(std::size_t i, double load_over_flat, std::size_t sheet = 0) const noexcept;
  /// Returns the entry interpolated at a slip, a load and a slip angle, of which the sign is ignored. The
  /// arguments are clamped to the range of the table.
  Row at(double slip, double load_over_flat, double slip_angle_rad = 0.0) const noexcept;

 private:
  Row onSheet(double slip, double load_over_flat, std::size_t sheet) const noexcept;

  std::vector<Row> rows_;  // [sheet][load][slip]
};

}  // namespace talus::planner
