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

/// Disc with a soil that differs from the soil of the class map.
struct SoilPatch {
  maps::Point centre;     ///< map coordinates [m]
  double radius_m = 0.0;  ///< radius of the disc, >= 0
  terramech::Soil soil;   ///< soil in the disc
};

/// Departures of the ground of a world from its soils, in drawbar pull over load at slip 0.5 [-]: one of each
/// class, and a Gaussian field over places with the correlation exp(-d / l), as a sum of random waves. Ground that
/// departs by D has 1 + D/H times the shear stresses of its soil, with the thrust H of its soil over load.
struct GroundDepartures {
  /// Wave numbers [1/m] and phase of a wave.
  struct Wave {
    double x, y, phase;
  };
  std::vector<double> of_class;   ///< departure of each class, in the order of the classes of the map
  std::vector<double> place_std;  ///< standard deviation of the field on each class
  std::vector<Wave> waves{};

  /// Returns the value of the field at a place, of variance 1.
  double field(const maps::Point& place) const noexcept;
};

/// True soils of a simulated world. The planner does not know them.
struct WorldSoils {
  /// True soil of each terrain class, in the order of the classes of the map.
  std::vector<terramech::Soil> classes;
  std::vector<SoilPatch> patches;  ///< patches with other soil; at an overlap the later patch counts
  /// Effects in addition to those of a rigid wheel; they act on all soils.
  std::vector<terramech::Effect> effects{};
  GroundDepartures departures{};  ///< empty: none
};

/// Position and motion of a rover.
struct Motion {
  maps::Point place;           ///< position of the centre of the rover, map coordinates [m]
  costmap::Direction heading;  ///< heading of the motion
  double gradient = 0.0;       ///< gradient of the ground along the motion, rise over run
  double across = 0.0;         ///< gradient of the ground to the left of the motion, rise over run
  double dug_m = 0.0;          ///< depth of the holes out of which the wheels must climb
  const Ruts* ruts = nullptr;  ///< record of the ruts; null: no ground has ruts
};

/// Statics of a rover with identical wheels on the true soils. Each wheel stands on the soil at its position,
/// in a rut if a wheel passed there before, and carries its share of the weight. All wheels turn at the same
/// rate and are steered uphill by the same angle; therefore slip and slip angle are the same for all wheels.
/// Together the wheels give the forces required along and across the direction of travel (ishigami_2009). The
/// yaw moment is assumed to be balanced by the steering.
///
/// The model is quasi-static. Immutable, safe to share between threads.
class TrueWorld {
 public:
  /// `class_index` contains for each cell the index of its terrain class in `soils.classes`.
  TrueWorld(const WorldSoils& soils, const terramech::Rover& rover, maps::Raster<std::uint8_t> class_index);

  /// State of one wheel during a step.
  struct SimulatedWheel {
    maps::Point place;                ///< position of the wheel [m]
    double load_N = 0.0;              ///< normal load of the wheel
    int passes = 0;                   ///< number of earlier wheel passes at this position
    SimulatedWheelTable::Row forces;  ///< normalised forces and sinkage
  };

  /// Steady state of the rover during one step.
  struct Step {
    bool stuck = false;           ///< true: no slip gives the required drawbar pull, or the rover slides
    bool slides = false;          ///< true: no slip angle up to 45 deg holds the rover on the slope
    double slip = 0.0;            ///< slip of all wheels, -1 to 0.98 [-]; 0.98 if `stuck`
    double slip_angle_rad = 0.0;  ///< angle from the wheel planes to the direction of travel, left positive
    /// Energy of drives and hotel load per metre of surface along the direction of travel.
    double energy_J_per_m = 0.0;
    double speed_mps = 0.0;              ///< speed of travel along the surface
    double torque_Nm = 0.0;              ///< sum of the torques of all wheels
    std::vector<SimulatedWheel> wheels;  ///< states of the wheels, front wheels first
  };

  /// Returns the steady state of the rover for a motion.
  Step drive(const Motion& motion) const;
  /// Returns the energy and the time of a turn from heading `from` to the heading of `to`, at the position of
  /// `to` (terramech::turnEfforts()). The soil is that under the centre of the rover. Both values are 0 if
  /// `from` is (0, 0).
  terramech::TurnEffort turn(const costmap::Direction& from, const Motion& to) const;

  /// Returns the index in soils() of the soil at `place`. The radius of every patch is enlarged by
  /// `margin_m`.
  std::size_t soilAt(const maps::Point& place, double margin_m = 0.0) const noexcept;
  /// Returns true if `place` lies in a patch.
  bool inPatch(const maps::Point& place) const noexcept { return soilAt(place) >= classes_; }
  /// Returns the soils of the classes in order, then the distinct soils of the patches.
  const std::vector<terramech::Soil>& soils() const noexcept { return soils_; }
  /// Returns the effects that act on all soils.
  const std::vector<terramech::Effect>& effects() const noexcept { return effects_; }
  /// Returns the patches of the world; at an overlap the later patch counts.
  const std::vector<SoilPatch>& patches() const noexcept { return patches_; }

 private:
  struct Tables {
    SimulatedWheelTable fresh, rut;
  };

  std::vector<SimulatedWheel> standing(const Motion& motion) const;
  double strengthAt(const maps::Point& place) const noexcept;

  terramech::Rover rover_;
  maps::Raster<std::uint8_t> class_index_;
  std::size_t classes_;
  std::vector<terramech::Soil> soils_;
  std::vector<terramech::Effect> effects_;
  std::vector<std::optional<Tables>> tables_;  // of each soil that occurs in a cell or patch
  GroundDepartures departures_;
  std::vector<SoilPatch> patches_;
  std::vector<std::size_t> patch_soil_;  // of each patch
};

}  // namespace talus::planner
