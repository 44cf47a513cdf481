#pragma once

#include <optional>
#include <string>
#include <vector>

#include <talus/costmap/cost/drive_cost.hpp>
#include <talus/maps/grid/grid.hpp>
#include <talus/planner/simulation/worlds/ruts.hpp>
#include <talus/planner/simulation/worlds/wheel_table.hpp>
#include <talus/terramech/contact/rover.hpp>
#include <talus/terramech/contact/soil.hpp>
#include <talus/terramech/effects/effects.hpp>

namespace talus::terramech {
struct TurnEffort;
}

namespace talus::planner {

/// A disc of ground whose soil no class map shows.
struct SoilPatch {
  maps::Point centre;
  double radius_m = 0.0;
  terramech::Soil soil;
};

/// The soils of a simulated world, which the planner does not know.
struct WorldSoils {
  std::vector<terramech::Soil> classes;      ///< true soil of each class of the map, in its order
  std::vector<SoilPatch> patches;            ///< later ones lie on top
  std::vector<terramech::Effect> effects{};  ///< that act on all of them, beyond a rigid wheel on that soil
};

/// Where a rover stands and where it is driven to.
struct Motion {
  maps::Point place;           ///< of the rover's middle
  costmap::Direction heading;  ///< of the motion
  double gradient = 0.0;       ///< rise over run along the motion
  double across = 0.0;         ///< rise over run to the left of it
  double dug_m = 0.0;          ///< depth of the holes that the wheels stand in and must climb out of
  const Ruts* ruts = nullptr;  ///< none: all ground is fresh
};

/// How a rover of alike wheels stands and drives on the true ground: each wheel on the soil under it, in the
/// rut of the one ahead where there is one, under its share of the weight; all turn at one rate and are turned
/// uphill alike, so slip and slip angle are common, and together they pull what the slope asks along the way and
/// hold what it asks across (ishigami_2009). The balance of yaw is left to the steering.
///
/// Quasi-static. Immutable, safe to share between threads.
class TrueWorld {
 public:
  /// `class_index`: position of each cell's class in soils.classes.
  TrueWorld(const WorldSoils& soils, const terramech::Rover& rover, maps::Raster<std::uint8_t> class_index);

  /// A wheel during a step.
  struct WheelState {
    maps::Point place;
    double load_N = 0.0;
    int passes = 0;  ///< wheels that were here before
    WheelTable::Row forces;
  };

  /// One steady step of the rover.
  struct Step {
    bool stuck = false;   ///< no slip gives the pull, or it slides
    bool slides = false;  ///< the wheels hold it across or down the slope at no slip angle up to 45 deg
    double slip = 0.0;
    double slip_angle_rad = 0.0;  ///< from the wheels' planes to the way made good, left positive
    double energy_J_per_m = 0.0;  ///< of driving and hotel, along the way made good on the surface
    double speed_mps = 0.0;
    double torque_Nm = 0.0;          ///< of all wheels together
    std::vector<WheelState> wheels;  ///< the foremost first
  };

  Step drive(const Motion& motion) const;
  /// What it takes to turn from a heading to that of a step, where that is taken (terramech::turnEfforts), on the soil under the rover's
  /// middle; nothing from a heading (0, 0).
  terramech::TurnEffort turn(const costmap::Direction& from, const Motion& to) const;

  /// Which of soils() lies at a place; patches reach `margin_m` further than they do.
  std::size_t soilAt(const maps::Point& place, double margin_m = 0.0) const noexcept;
  /// Whether ground that no class shows lies there.
  bool inPatch(const maps::Point& place) const noexcept { return soilAt(place) >= classes_; }
  /// The classes' soils in their order, then those of the patches, each once.
  const std::vector<terramech::Soil>& soils() const noexcept { return soils_; }
  /// Effects that act on all of them.
  const std::vector<terramech::Effect>& effects() const noexcept { return effects_; }
  const std::vector<SoilPatch>& patches() const noexcept { return patches_; }

 private:
  struct Tables {
    WheelTable fresh, rut;
  };

  std::vector<WheelState> standing(const Motion& motion) const;

  terramech::Rover rover_;
  maps::Raster<std::uint8_t> class_index_;
  std::size_t classes_;
  std::vector<terramech::Soil> soils_;
  std::vector<terramech::Effect> effects_;
  std::vector<std::optional<Tables>> tables_;  // of each soil that some cell or patch has
  std::vector<SoilPatch> patches_;
  std::vector<std::size_t> patch_soil_;  // of each patch
};

}  // namespace talus::planner
