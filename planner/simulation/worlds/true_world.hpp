#pragma once

#include <optional>
#include <string>
#include <vector>

#include <talus/costmap/cost/travel_cost.hpp>
#include <talus/maps/grid/grid.hpp>
#include <talus/planner/simulation/worlds/ruts.hpp>
#include <talus/planner/simulation/worlds/simulated_wheel_table.hpp>
#include <talus/terramech/contact/rover.hpp>
#include <talus/terramech/contact/soil.hpp>
#include <talus/terramech/effects/effects.hpp>

namespace talus::terramech {
struct TurnEffort;
}

namespace talus::planner {

/// Disc of soil that the class map does not show.
struct SoilPatch {
  maps::Point centre;     ///< map coordinates [m]
  double radius_m = 0.0;  ///< >= 0
  terramech::Soil soil;   ///< soil within the disc
};

/// True soils of a simulated world, not known to the planner.
struct WorldSoils {
  std::vector<terramech::Soil> classes;      ///< true soil of each class of the map, in the map's order
  std::vector<SoilPatch> patches;            ///< later patches lie on top
  std::vector<terramech::Effect> effects{};  ///< effects beyond a rigid wheel that act on all soils
};

/// Position and motion of a rover.
struct Motion {
  maps::Point place;           ///< position of the rover's centre
  costmap::Direction heading;  ///< heading of the motion
  double gradient = 0.0;       ///< rise over run along the motion
  double across = 0.0;         ///< rise over run to the left of the motion
  double dug_m = 0.0;          ///< depth of the holes from which the wheels must climb
  const Ruts* ruts = nullptr;  ///< null: all ground is fresh
};

/// Statics of a rover with identical wheels on the true ground. Each wheel stands on its own soil, in a rut
/// if a wheel passed before, under its share of the weight. All wheels turn at one rate and are turned uphill
/// by the same angle, so slip and slip angle are common; together the wheels give the forces required along
/// and across the direction of travel (ishigami_2009). The yaw moment is left to the steering.
///
/// Quasi-static. Immutable, safe to share between threads.
class TrueWorld {
 public:
  /// `class_index`: position of each cell's class in soils.classes.
  TrueWorld(const WorldSoils& soils, const terramech::Rover& rover, maps::Raster<std::uint8_t> class_index);

  /// State of a wheel during a step.
  struct SimulatedWheel {
    maps::Point place;                ///< position of the wheel [m]
    double load_N = 0.0;              ///< normal load
    int passes = 0;                   ///< earlier wheel passes at the place
    SimulatedWheelTable::Row forces;  ///< normalised forces and sinkage
  };

  /// Steady state of the rover during one step.
  struct Step {
    bool stuck = false;           ///< no slip gives the required pull, or the rover slides
    bool slides = false;          ///< no slip angle up to 45 deg holds the rover on the slope
    double slip = 0.0;            ///< -1 to 0.98 [-]; 0.98 if stuck
    double slip_angle_rad = 0.0;  ///< from the wheels' planes to the direction of travel, left positive
    double energy_J_per_m = 0.0;  ///< drive and hotel energy per metre of surface along the direction of
                                  ///< travel
    double speed_mps = 0.0;       ///< speed of travel along the surface
    double torque_Nm = 0.0;       ///< sum over all wheels
    std::vector<SimulatedWheel> wheels;  ///< foremost wheels first
  };

  /// Steady state of the rover for a motion.
  Step drive(const Motion& motion) const;
  /// Returns the energy and time to turn from heading `from` to the heading of `to` at its place
  /// (terramech::turnEfforts()), on the soil under the rover's centre; zero if `from` is (0, 0).
  terramech::TurnEffort turn(const costmap::Direction& from, const Motion& to) const;

  /// Returns the index in soils() of the soil at a place; patches are extended by `margin_m`.
  std::size_t soilAt(const maps::Point& place, double margin_m = 0.0) const noexcept;
  /// Returns true if the place lies in a patch.
  bool inPatch(const maps::Point& place) const noexcept { return soilAt(place) >= classes_; }
  /// Soils of the classes in order, then the distinct soils of the patches.
  const std::vector<terramech::Soil>& soils() const noexcept { return soils_; }
  /// Effects that act on all soils.
  const std::vector<terramech::Effect>& effects() const noexcept { return effects_; }
  /// Patches of the world; later patches lie on top.
  const std::vector<SoilPatch>& patches() const noexcept { return patches_; }

 private:
  struct Tables {
    SimulatedWheelTable fresh, rut;
  };

  std::vector<SimulatedWheel> standing(const Motion& motion) const;

  terramech::Rover rover_;
  maps::Raster<std::uint8_t> class_index_;
  std::size_t classes_;
  std::vector<terramech::Soil> soils_;
  std::vector<terramech::Effect> effects_;
  std::vector<std::optional<Tables>> tables_;  // of each soil that occurs in a cell or patch
  std::vector<SoilPatch> patches_;
  std::vector<std::size_t> patch_soil_;  // of each patch
};

}  // namespace talus::planner
