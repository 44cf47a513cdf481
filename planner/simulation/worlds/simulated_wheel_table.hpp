#pragma once

#include <cstddef>
#include <vector>

#include <talus/terramech/contact/rover.hpp>
#include <talus/terramech/contact/soil.hpp>
#include <talus/terramech/effects/effects.hpp>

namespace talus::planner {

/// Forces of a wheel on one soil, with the effects that act there, tabulated with the forward model over slip
/// (-1 to 1), load (0.25 to 1.9 times the load on level ground) and slip angle (0 to 45 degrees).
class SimulatedWheelTable {
 public:
  /// Normalised forces and sinkage.
  struct Row {
    double pull = 0.0;     ///< drawbar pull divided by load [-]
    double torque = 0.0;   ///< torque / (load * radius) [-]
    double sinkage = 0.0;  ///< sinkage divided by radius [-]
    double hold = 0.0;     ///< side force against the wheel's lateral motion, divided by load [-]
  };

  static constexpr std::size_t kRows = 81;   ///< number of slips
  static constexpr std::size_t kLoads = 12;  ///< number of loads
  static constexpr std::size_t kAngles = 9;  ///< number of slip angles

  /// Load of a layer relative to the load on level ground: 0.25 to 1.9.
  static constexpr double load(std::size_t layer) noexcept {
    return 0.25 + 0.15 * static_cast<double>(layer);
  }

  /// Slip angle of a sheet: 0 to 45 degrees.
  static constexpr double angle_rad(std::size_t sheet) noexcept {
    return 0.09817477042468103 * static_cast<double>(sheet);
  }

  /// On a soil that cannot carry the wheel, the pull is -1 and the side force 0.
  SimulatedWheelTable(const terramech::Soil& soil, const terramech::Rover& rover,
                      const std::vector<terramech::Effect>& effects = {});

  /// Slip of a row.
  static constexpr double slip(std::size_t row) noexcept {
    return 2.0 * static_cast<double>(row) / (kRows - 1) - 1.0;
  }
  /// Entry of a row and sheet, interpolated at a load relative to level ground; clamped to the table's range.
  Row row(std::size_t i, double load_over_flat, std::size_t sheet = 0) const noexcept;
  /// Entry interpolated at a slip, a relative load and the magnitude of a slip angle; clamped to the table's
  /// range.
  Row at(double slip, double load_over_flat, double slip_angle_rad = 0.0) const noexcept;

 private:
  Row onSheet(double slip, double load_over_flat, std::size_t sheet) const noexcept;

  std::vector<Row> rows_;  // [sheet][load][slip]
};

}  // namespace talus::planner
