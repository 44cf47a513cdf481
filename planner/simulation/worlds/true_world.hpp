#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include <talus/costmap/cost/travel_cost.hpp>
#include <talus/maps/grid/grid.hpp>
#include <talus/terramech/contact/rover.hpp>
#include <talus/terramech/contact/soil.hpp>
#include <talus/terramech/effects/effects.hpp>

namespace talus::terramech {
struct TurnEffort;
}

namespace talus::planner {

/// Record of the ruts that the wheels of a rover made, on a grid of squares as wide as a wheel. A pressed
/// square counts as a rut only after the rover has driven a further distance of two squares or has reversed
/// its direction. Therefore a wheel does not drive in the rut that it is just making.
class Ruts {
 public:
  /// `wheel_width_m` > 0 is the side length of the squares.
  explicit Ruts(double wheel_width_m) : square_m_(wheel_width_m) {}

  /// Marks the square under a wheel at `place` (map coordinates).
  void press(const maps::Point& place);
  /// Adds a distance driven by the rover, >= 0.
  void moved(double distance_m) noexcept { odometer_m_ += distance_m; }
  /// Records that the rover reversed its direction: all squares pressed before count as ruts at once.
  void turnBack() noexcept { odometer_m_ += 3.0 * square_m_; }
  /// Returns the number of earlier wheel passes at `place`.
  int passes(const maps::Point& place) const;

 private:
  struct Mark {
    double pressed_at_m = 0.0;
    int passes = 1;
    int before = 0;  // passes before the present wheel
  };

  std::uint64_t square(const maps::Point& place) const noexcept;
  bool movedOn(const Mark& mark) const noexcept { return odometer_m_ - mark.pressed_at_m > 2.0 * square_m_; }

  double square_m_;
  double odometer_m_ = 0.0;
  std::unordered_map<std::uint64_t, Mark> marks_;
};

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
