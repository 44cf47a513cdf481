#pragma once

#include <array>
#include <vector>

#include <terramech/effects.hpp>
#include <terramech/rover.hpp>
#include <terramech/soil.hpp>

namespace talus::planner {

/// What a wheel does on one soil, with the effects that act there, under its load on the flat, tabulated over
/// slip -1 .. 1 by the forward model.
class WheelTable {
 public:
  /// Forces over the load.
  struct Row {
    double pull = 0.0;     ///< drawbar pull over load [-]
    double torque = 0.0;   ///< torque over load and radius [-]
    double sinkage = 0.0;  ///< sinkage over radius [-]
  };

  static constexpr std::size_t kRows = 81;

  /// A soil that cannot carry the wheel pulls nothing.
  WheelTable(const terramech::Soil& soil, const terramech::Rover& rover,
             const std::vector<terramech::Effect>& effects = {});

  /// Slip of a row.
  static constexpr double slip(std::size_t row) noexcept {
    return 2.0 * static_cast<double>(row) / (kRows - 1) - 1.0;
  }
  const Row& row(std::size_t i) const noexcept { return rows_[i]; }
  /// Interpolated at a slip, clamped to [-1, 1].
  Row at(double slip) const noexcept;

 private:
  std::array<Row, kRows> rows_;
};

}  // namespace talus::planner
