#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <costmap/wheel_observation.hpp>
#include <maps/grid.hpp>
#include <terramech/rover.hpp>
#include <terramech/soil.hpp>

namespace talus::planner {

/// A disc of ground whose soil no class map shows.
struct SoilPatch {
  maps::Point centre;
  double radius_m = 0.0;
  terramech::Soil soil;
};

/// The soils of a rehearsed world, which the planner does not know.
struct WorldSoils {
  std::vector<terramech::Soil> classes;  ///< true soil of each class of the map, in its order
  std::vector<SoilPatch> patches;        ///< later ones lie on top
};

/// What a wheel does on one soil under its load on the flat, tabulated over slip -1 .. 1 by the forward
/// model.
class WheelTable {
 public:
  /// Forces over the load.
  struct Row {
    double pull = 0.0;     ///< drawbar pull over load [-]
    double torque = 0.0;   ///< torque over load and radius [-]
    double sinkage = 0.0;  ///< sinkage over radius [-]
  };

  WheelTable(const terramech::Soil& soil, const terramech::Rover& rover);

  /// Interpolated at a slip, clamped to [-1, 1]. A soil that cannot carry the wheel pulls nothing.
  Row at(double slip) const noexcept;

 private:
  std::vector<Row> rows_;
};

/// How a rover of four or more alike wheels stands and drives on the true ground.
class TrueWorld {
 public:
  TrueWorld(const WorldSoils& soils, const terramech::Rover& rover,
            const maps::Raster<std::uint8_t>& class_index);

  /// One steady step of the rover: its common slip, and each corner's forces.
  struct Step {
    bool stuck = false;  ///< no slip gives the pull
    double slip = 0.0;
    double energy_J_per_m = 0.0;  ///< of driving and hotel, along the surface
    double speed_mps = 0.0;
    std::vector<maps::Point> wheels;
    std::vector<WheelTable::Row> rows;
  };

  /// Steady driving at a place along a heading on a gradient (rise over run along the heading).
  Step drive(const maps::Point& place, const costmap::Direction& heading, double gradient) const;

  /// Which soil lies at a place: 0 .. classes - 1, then the patches.
  std::size_t soilAt(const maps::Point& place) const noexcept;

 private:
  double meanPull(const std::vector<std::size_t>& soils, double slip) const noexcept;

  WorldSoils soils_;
  terramech::Rover rover_;
  const maps::Raster<std::uint8_t>& class_index_;
  std::vector<WheelTable> tables_;
};

}  // namespace talus::planner
