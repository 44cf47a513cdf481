#include "judge.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "step.hpp"

namespace safety {
namespace {

constexpr double kMargin_rad = 5.0 * std::numbers::pi / 180.0;  // margin of the categories (thesis 3.5)
constexpr double kSlipStep = 0.02;

Place shifted(const Station& at, double ahead_m, double left_m) {
  const double c = std::cos(at.heading_rad), s = std::sin(at.heading_rad);
  return {at.place.x_m + ahead_m * c - left_m * s, at.place.y_m + ahead_m * s + left_m * c};
}

}  // namespace

// Keeps the worst violation of each cause.
class Judge::Findings {
 public:
  void add(const char* cause, const Station& at, double amount) {
    if (!(amount > 0.0)) return;
    const auto [known, fresh] = worst_.try_emplace(cause, Violation{cause, at.place, at.heading_rad, amount});
    if (!fresh && amount > known->second.amount) known->second = {cause, at.place, at.heading_rad, amount};
  }
  std::vector<Violation> list() const {
    std::vector<Violation> out;
    for (const auto& [cause, violation] : worst_) out.push_back(violation);
    return out;
  }

 private:
  std::map<std::string, Violation> worst_;
};

std::vector<Violation> Judge::judge(const Route& route) const {
  Findings findings;
  const double step_m = std::max(0.25 * site_.elevation_m.cell_m, 0.1);
  for (const Station& at : route.stations(step_m)) {
    ground(at, findings);
    width(at, findings);
  }
  heights(route, findings);
  return findings.list();
}

void Judge::ground(const Station& at, Findings& findings) const {
  const auto cell = site_.elevation_m.cellAt(at.place);
  if (!cell) return findings.add("outside the map", at, 1.0);
  const Plane plane = planeUnder(site_.elevation_m, *cell, site_.footprint_m());
  if (!plane.known) return findings.add("unknown ground", at, 1.0);
  const double c = std::cos(at.heading_rad), s = std::sin(at.heading_rad);
  const double along = plane.east * c + plane.north * s, across = plane.north * c - plane.east * s;
  findings.add(
      "pitch", at,
      std::abs(along) - std::tan(site_.rover.max_pitch_rad) - allowance_.gradient - allowance_.curve);
  findings.add("roll", at, std::abs(across) - std::tan(site_.rover.max_roll_rad) - allowance_.gradient);
  // The limit of relief grows in proportion for cells larger than the rover (docs/limits.md).
  const double footprint_m = 2.0 * std::max(site_.footprint_m(), site_.elevation_m.cell_m);
  const double larger = std::max(footprint_m / site_.rover.wheelbase_m, 1.0);
  findings.add("relief", at, plane.relief_m - (1.0 + 1e-3) * larger * site_.rover.clearance_m);
  // The limit of a step grows in proportion for cells further apart than the wheels.
  const double step_m =
      stepUnder(site_.elevation_m, *cell,
                {.radius_m = site_.footprint_m(), .wheel_m = 2.0 * site_.rover.wheel_radius_m});
  const double apart = std::max(site_.elevation_m.cell_m / site_.rover.wheelbase_m, 1.0);
  findings.add("step", at, step_m - (1.0 + 1e-3) * apart * site_.rover.clearance_m);
  findings.add("roughness", at, plane.roughness_m - (1.0 + 1e-3) * larger * site_.rover.clearance_m / 3.0);
  if (!at.turning) equilibrium(at, {along, across}, findings);
}

// Checks the whole width of the rover at its centre and at both axles.
void Judge::width(const Station& at, Findings& findings) const {
  if (refused(at.place)) return findings.add("centre on refused ground", at, 1.0);
  const double half_m = 0.5 * (site_.rover.track_m + site_.rover.wheel_width_m) - allowance_.clear_m;
  for (const double share : {-1.0, -0.5, 0.5, 1.0})
    if (refused(shifted(at, 0.0, share * half_m))) findings.add("width over refused ground", at, 1.0);
  for (const double end : {-0.5, 0.5})
    for (const double side : {-0.5, 0.5})
      if (refused(shifted(at, end * site_.rover.wheelbase_m, side * site_.rover.track_m)))
        findings.add("wheel on refused ground", at, 1.0);
}

std::optional<std::vector<Judge::Wheel>> Judge::wheels(const Station& at, const Planar& gradient) const {
  const Rover& rover = site_.rover;
  const int axles = std::max(rover.wheels / 2, 2);
  const Planar needed = demand(gradient);
  const double height_m = rover.centre_of_mass_height_m;
  std::vector<Wheel> found;
  double ahead2 = 0.0;
  for (int k = 0; k < axles; ++k) ahead2 += 2.0 * std::pow(rover.wheelbase_m * (0.5 - k / (axles - 1.0)), 2);
  const double left2 = 0.5 * axles * rover.track_m * rover.track_m;
  for (int k = 0; k < axles; ++k)
    for (const double side : {0.5, -0.5}) {
      const double ahead_m = rover.wheelbase_m * (0.5 - k / (axles - 1.0)), left_m = side * rover.track_m;
      const double even = 0.5 / axles;
      Wheel w{.place = shifted(at, ahead_m, left_m)};
      const auto number = site_.classAt(w.place);
      if (!number) return std::nullopt;
      // Load transfer: the load moves downhill in proportion to the height of the centre of mass.
      const double across = std::copysign(needed.across, gradient.across);
      w.share = even - height_m * (needed.along * ahead_m / ahead2 + across * left_m / left2);
      w.share = std::max(w.share, 0.1 * even);
      w.curve = &site_.kinds.at(*number)->fresh;
      w.thrust = std::max(w.curve->torque(PullCurve::kReferenceSlip), 0.05);
      w.departure = belief_.at(*number, w.place);
      w.deeper = belief_.deeper(*number, w.place);
      found.push_back(w);
    }
  return found;
}

Judge::Planar Judge::demand(const Planar& g) {
  const double run2 = 1.0 + g.along * g.along;
  return {g.along * std::sqrt((run2 + g.across * g.across) / run2), std::abs(g.across) / std::sqrt(run2)};
}

double Judge::pull(const std::vector<Wheel>& wheels, double slip) {
  double sum = 0.0, load = 0.0;
  for (const Wheel& w : wheels) {
    const double relative = w.share * static_cast<double>(wheels.size());
    sum += w.share * (w.curve->pull(slip, std::clamp(relative, 0.3, 1.6)) + w.departure.mean);
    load += w.share;
  }
  return sum / load;
}

double Judge::mostPull(const std::vector<Wheel>& wheels, double most_slip) {
  double most = -1.0;
  for (double slip = 0.0; slip <= most_slip + 1e-9; slip += kSlipStep)
    most = std::max(most, pull(wheels, slip));
  return most;
}

namespace {

// Sum of the forces of all wheels, turned uphill by one angle. A wheel with pull P and side force F
// contributes P cos - F sin along the heading and P sin + F cos across. Ground weaker by d reduces the force
// along the heading by d and F by the share d / thrust.
Judge::Planar forces(const std::vector<Judge::Wheel>& wheels, double slip, std::size_t angle, double weaker) {
  const double c = std::cos(PullCurve::angle_rad(angle)), s = std::sin(PullCurve::angle_rad(angle));
  Judge::Planar sum;
  double load = 0.0;
  for (const Judge::Wheel& w : wheels) {
    const double relative = std::clamp(w.share * static_cast<double>(wheels.size()), 0.3, 1.6);
    const double stronger = w.departure.mean - weaker;
    const double pull = w.curve->pull(slip, relative, angle);
    const double side = w.curve->side(slip, relative, angle) * std::max(1.0 + stronger / w.thrust, 0.0);
    sum.along += w.share * (pull * c - side * s + stronger);
    sum.across += w.share * (pull * s + side * c);
    load += w.share;
  }
  return {sum.along / load, sum.across / load};
}

// The least slip at which an angle meets the demand along the heading, and the force across at that slip.
struct AtAngle {
  double slip = 0.0, across = 0.0;
};
std::optional<AtAngle> atAngle(const std::vector<Judge::Wheel>& wheels, std::size_t angle, double along,
                               const std::pair<double, double>& most_slip_and_weaker) {
  constexpr double kStep = 0.05;  // the curves are linear between these slips
  const auto [most_slip, weaker] = most_slip_and_weaker;
  Judge::Planar last = forces(wheels, -1.0, angle, weaker);
  if (last.along >= along) return AtAngle{-1.0, last.across};
  for (double slip = -1.0 + kStep; slip <= most_slip + 1e-9; slip += kStep) {
    const Judge::Planar now = forces(wheels, slip, angle, weaker);
    if (now.along >= along) {
      const double t = (along - last.along) / (now.along - last.along);
      return AtAngle{slip - (1.0 - t) * kStep, last.across + t * (now.across - last.across)};
    }
    last = now;
  }
  return std::nullopt;
}

}  // namespace

Judge::Hold Judge::hold(const std::vector<Wheel>& wheels, const Planar& demand, double most_slip,
                        double weaker) {
  Hold found;
  std::optional<AtAngle> before;
  for (std::size_t angle = 0; angle < PullCurve::kAngles_deg.size(); ++angle) {
    const auto now = atAngle(wheels, angle, demand.along, {most_slip, weaker});
    if (now) found.most_across = std::max(found.most_across, now->across);
    if (now && !found.holds && now->across >= demand.across) {
      const double t = before ? (demand.across - before->across) / (now->across - before->across) : 1.0;
      found.holds = true;
      found.slip = before ? before->slip + t * (now->slip - before->slip) : now->slip;
      found.angle = static_cast<double>(angle) - (1.0 - t);
    }
    before = now;
  }
  return found;
}

double Judge::reserve(const std::vector<Wheel>& wheels, const Planar& demand, double most_slip) {
  double low = -1.0, high = 1.0;
  while (high - low > 2e-4) {
    const double middle = 0.5 * (low + high);
    (hold(wheels, demand, most_slip, middle).most_across >= demand.across ? low : high) = middle;
  }
  return low;
}

void Judge::equilibrium(const Station& at, const Planar& gradient, Findings& findings) const {
  const auto stand = wheels(at, gradient);
  if (!stand) return;
  const Planar needed = demand(gradient);
  double learned = 0.0;
  for (const Wheel& w : *stand) learned += w.departure.learned / static_cast<double>(stand->size());
  const double read = allowance_.gradient + allowance_.belief * learned;
  const double allowed = read + allowance_.curve + allowance_.pull;
  findings.add("pull", at, needed.along - mostPull(*stand) - allowed);
  const double edge = std::tan(std::atan(gradient.along) - kMargin_rad);
  findings.add("category", at, edge - pull(*stand, PullCurve::kReferenceSlip) - allowed);
  if (needed.along < 0.0) findings.add("braking", at, pull(*stand, -1.0) - needed.along - allowed);
  const Planar least{needed.along - allowed, std::max(needed.across - read - allowance_.side, 0.0)};
  const Hold held = hold(*stand, least, PullCurve::kMostSlip);
  if (held.most_across >= 0.0) findings.add("side force", at, least.across - held.most_across);
  if (held.holds) motors(at, *stand, held, findings);
}

// Checks torque and sinkage of each wheel in the state of equilibrium.
void Judge::motors(const Station& at, const std::vector<Wheel>& stand, const Hold& held,
                   Findings& findings) const {
  const double load_N = site_.rover.wheelLoad_N(), radius_m = site_.rover.wheel_radius_m;
  const auto above = static_cast<std::size_t>(std::ceil(held.angle)), below = above > 0 ? above - 1 : 0;
  const double t = held.angle - static_cast<double>(below);
  const auto between = [&](double low, double high) { return low + t * (high - low); };
  for (const Wheel& w : stand) {
    const double share = std::clamp(w.share * static_cast<double>(stand.size()), 0.3, 1.6);
    const double torque =
        between(w.curve->torque(held.slip, share, below), w.curve->torque(held.slip, share, above));
    const double torque_Nm = std::abs(torque) * share * load_N * radius_m;
    findings.add("torque", at, torque_Nm - site_.rover.max_torque_Nm * (1.0 + allowance_.torque));
    const double depth =
        between(w.curve->sinkage(held.slip, share, below), w.curve->sinkage(held.slip, share, above));
    findings.add("sinkage", at, depth * w.deeper * radius_m - site_.rover.clearance_m);
  }
}

// Checks that the route and the DEM agree: the height of a vertex lies within the heights of the
// neighbouring cells.
void Judge::heights(const Route& route, Findings& findings) const {
  for (std::size_t i = 0; i < route.vertices.size(); ++i) {
    const auto cell = site_.elevation_m.cellAt(route.vertices[i]);
    if (!cell || std::isnan(route.elevation_m[i])) continue;
    double low = 1e300, high = -1e300;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const Cell there{cell->column + dx, cell->row + dy};
        if (!site_.elevation_m.holds(there) || std::isnan(site_.elevation_m.at(there))) continue;
        low = std::min(low, site_.elevation_m.at(there));
        high = std::max(high, site_.elevation_m.at(there));
      }
    const double z_m = route.elevation_m[i];
    findings.add("height", {route.vertices[i], 0.0, 0.0, false}, std::max(low - z_m, z_m - high) - 0.01);
  }
}

}  // namespace safety
