#pragma once

#include <optional>
#include <string>
#include <vector>

#include "belief.hpp"
#include "ground.hpp"
#include "plane.hpp"
#include "route.hpp"

namespace safety {

/// Largest deviation that follows from the rounding of stored values in Talus. A deviation within the
/// allowance is not reported; a larger deviation is a defect.
struct Allowance {
  double gradient =
      0.001;               ///< of the gradient of a plane: half a step of 1/1024 in each direction, and float
  double curve = 0.002;    ///< of the gradient along the heading: half a bin of 1/256
  double pull = 0.013;     ///< of DP/W: half a step of 0.02 of a stored estimate, and 0.003 of PullCurve
  double side = 0.015;     ///< of F/N: error of the wheel table (docs/slopes.md)
  double belief = 0.5;     ///< share of the explained deviation by which sound estimates may differ
  double torque = 0.03;    ///< relative error of a torque
  double clear_m = 0.005;  ///< of a distance to an obstacle or keep-out area
};

/// A place on a route that violates a limit, in the heading of the route.
struct Violation {
  std::string cause;  ///< short name of the cause, for the table
  Place place;
  double heading_rad = 0.0;
  double amount = 0.0;  ///< excess over the allowance, in the unit of the cause
};

/// Judges every station of a route: outside the map, unknown, obstacle, keep-out area under the centre, the
/// wheels and the whole width; pitch and roll of the plane; relief; equilibrium of all wheels along and
/// across the slope (pull, category, torque, sinkage, braking); height. Reports the worst violation of each
/// cause.
class Judge {
 public:
  Judge(const Site& site, const Belief& belief, const Allowance& allowance = {})
      : site_(site), belief_(belief), allowance_(allowance) {}

  std::vector<Violation> judge(const Route& route) const;

  /// Components along a heading and to its left. Gradients are rise over run; forces are divided by the
  /// normal load.
  struct Planar {
    double along = 0.0;
    double across = 0.0;
  };

  /// A wheel of a rover at a pose.
  struct Wheel {
    Place place;
    double share = 0.0;   ///< share of the weight normal to the slope
    double thrust = 1.0;  ///< T/(N r) at the reference slip, reduced on weaker ground
    const PullCurve* curve = nullptr;
    Departure departure{};
    double deeper = 1.0;
  };
  /// All wheels at a pose on a gradient; nullopt if a wheel has no ground with a soil under it.
  std::optional<std::vector<Wheel>> wheels(const Station& at, const Planar& gradient) const;

  /// Forces that the wheels must provide on a gradient, over the normal load. With the heading t = (1, 0,
  /// a)/sqrt(1 + a^2) and the normal n = (-a, -c, 1)/sqrt(1 + a^2 + c^2), the weight component along t and
  /// the size of the component along n x t are each divided by the component along n.
  static Planar demand(const Planar& gradient);

  /// Equilibrium of all wheels at one common slip and one common slip angle uphill; the yaw moment is
  /// neglected.
  struct Hold {
    double most_across =
        -1.0;  ///< largest force across of all angles at their least slip; -1: no angle meets the demand
    bool holds = false;
    double slip = 0.0;   ///< least slip in equilibrium
    double angle = 0.0;  ///< slip angle in equilibrium, as a fractional index of PullCurve::kAngles_deg
  };
  /// Equilibrium on ground whose DP/W is lower than the estimate by `weaker`.
  static Hold hold(const std::vector<Wheel>& wheels, const Planar& demand, double most_slip,
                   double weaker = 0.0);
  /// Largest reduction of DP/W for which an equilibrium exists; within [-1, 1].
  static double reserve(const std::vector<Wheel>& wheels, const Planar& demand, double most_slip);

  /// Drawbar pull over load of all wheels at a slip [-].
  static double pull(const std::vector<Wheel>& wheels, double slip);
  /// Largest drawbar pull over load at slips up to most_slip [-].
  static double mostPull(const std::vector<Wheel>& wheels, double most_slip = PullCurve::kMostSlip);

 private:
  class Findings;
  void ground(const Station& at, Findings& findings) const;
  void width(const Station& at, Findings& findings) const;
  void equilibrium(const Station& at, const Planar& gradient, Findings& findings) const;
  void motors(const Station& at, const std::vector<Wheel>& stand, const Hold& held, Findings& findings) const;
  void heights(const Route& route, Findings& findings) const;
  bool refused(Place p) const { return !site_.classAt(p) || site_.keptOut(p); }

  const Site& site_;
  const Belief& belief_;
  Allowance allowance_;
};

}  // namespace safety
