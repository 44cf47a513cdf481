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
/// braking); height. One violation a cause, the worst.
class Judge {
 public:
  Judge(const Site& site, const Belief& belief, const Allowance& allowance = {})
      : site_(site), belief_(belief), allowance_(allowance) {}

  std::vector<Violation> judge(const Route& route) const;

  /// A wheel of a rover that stands somewhere.
  struct Wheel {
    Place place;
    double share = 0.0;  ///< of the rover's weight across the slope
    const PullCurve* curve = nullptr;
    Departure departure{};
    double deeper = 1.0;
  };
  /// All wheels at a pose on a gradient along it; nothing where one has no ground with a soil under it.
  std::optional<std::vector<Wheel>> wheels(const Station& at, double gradient) const;

  /// Drawbar pull over load of all wheels at a slip.
  static double pull(const std::vector<Wheel>& wheels, double slip);
  /// The most of it at slips up to the greatest that counts as driving.
  static double mostPull(const std::vector<Wheel>& wheels, double most_slip = PullCurve::kMostSlip);

 private:
  class Findings;
  void ground(const Station& at, Findings& findings) const;
  void width(const Station& at, Findings& findings) const;
  void equilibrium(const Station& at, double gradient, Findings& findings) const;
  void heights(const Route& route, Findings& findings) const;
  bool refused(Place p) const { return !site_.classAt(p) || site_.keptOut(p); }

  const Site& site_;
  const Belief& belief_;
  Allowance allowance_;
};

}  // namespace safety
