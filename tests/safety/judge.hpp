#pragma once

#include <optional>
#include <string>
#include <vector>

#include "belief.hpp"
#include "ground.hpp"
#include "plane.hpp"
#include "route.hpp"

namespace safety {

/// By how much Talus may be off through what it states to round (DESIGN: "where bits run out"). Less is
/// charged to nobody; more is a defect.
struct Allowance {
  double gradient = 0.001;  ///< of a plane: half a step of 1/1024 in each direction, and float
  double curve = 0.002;     ///< of a gradient along the heading: half a bin of 1/256
  double pull = 0.013;      ///< of DP/W: half a step of 0.02 of a learned belief, and PullCurve's own 0.003
  double side = 0.015;      ///< of F/N: what the table of a wheel is off by (docs/slopes.md)
  double belief = 0.5;      ///< of what the evidence explains: two fair readings of it differ
  double torque = 0.03;     ///< of a torque
  double clear_m = 0.005;   ///< of a distance to what must not be touched
};

/// A place on a route that must not be driven so.
struct Violation {
  std::string cause;  ///< a word or two, for the table
  Place place;
  double heading_rad = 0.0;
  double amount = 0.0;  ///< beyond the allowance, in the unit of the cause
};

/// Judges every station of a route: outside, unknown, obstacle, keep-out under centre, wheels and the whole
/// width; pitch and roll of the plane; relief; the equilibrium of all wheels (pull, category, torque, sinkage,
/// braking), along the slope and across it; height. One violation a cause, the worst.
class Judge {
 public:
  Judge(const Site& site, const Belief& belief, const Allowance& allowance = {})
      : site_(site), belief_(belief), allowance_(allowance) {}

  std::vector<Violation> judge(const Route& route) const;

  /// Along a heading and to its left: of the ground rise over run, of forces those over the load normal to it.
  struct Planar {
    double along = 0.0;
    double across = 0.0;
  };

  /// A wheel of a rover that stands somewhere.
  struct Wheel {
    Place place;
    double share = 0.0;   ///< of the weight normal to the slope
    double thrust = 1.0;  ///< T/(N r) at the reference slip: what ground that is weaker has less of
    const PullCurve* curve = nullptr;
    Departure departure{};
    double deeper = 1.0;
  };
  /// All wheels at a pose on a gradient; nothing where one has no ground with a soil under it.
  std::optional<std::vector<Wheel>> wheels(const Station& at, const Planar& gradient) const;

  /// What wheels must give on a gradient, over the load normal to it: the weight along the way, t = (1, 0, a)/sqrt(1 + a^2),
  /// and across it, n x t with n = (-a, -c, 1)/sqrt(1 + a^2 + c^2), over its part along n. Across: its size.
  static Planar demand(const Planar& gradient);

  /// How wheels hold a demand, all turned uphill by one slip angle and slipping alike; the yaw moment is left out.
  struct Hold {
    double most_across =
        -1.0;  ///< that any angle holds at the least slip that gives the demand along; -1: none gives it
    bool holds = false;
    double slip = 0.0;   ///< at the least angle that holds
    double angle = 0.0;  ///< that angle's place among PullCurve's nodes
  };
  /// On ground that is weaker by some DP/W than believed.
  static Hold hold(const std::vector<Wheel>& wheels, const Planar& demand, double most_slip,
                   double weaker = 0.0);
  /// By how much weaker the ground may be until nothing holds; within [-1, 1].
  static double reserve(const std::vector<Wheel>& wheels, const Planar& demand, double most_slip);

  /// Drawbar pull over load of all wheels at a slip.
  static double pull(const std::vector<Wheel>& wheels, double slip);
  /// The most of it at slips up to the greatest that counts as driving.
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
