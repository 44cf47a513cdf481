#include <algorithm>
#include <array>
#include <cmath>

#include <talus/planner/reach/cell_crossing.hpp>

namespace talus::planner {
namespace {

constexpr double kInside = 3e-6;  // sides: MotionCost treats places within 1e-6 of a side as on the side
constexpr int kMostLegs = 4096;   // legs of a zigzag within one cell
constexpr double kLeast = 1e-9;   // sides: shorter distances are rounding

InCell unit(double heading_rad) noexcept {
  return {std::cos(heading_rad), std::sin(heading_rad)};
}

bool inside(InCell p) noexcept {
  return p.x >= kInside && p.x <= 1.0 - kInside && p.y >= kInside && p.y <= 1.0 - kInside;
}

// Returns the share of a unit step that stays inside a cell with a margin.
double stepInside(InCell from, InCell step) noexcept {
  const auto room = [](double at, double by) {
    return by > 0.0 ? (1.0 - at) / by : by < 0.0 ? -at / by : 1.0;
  };
  return 0.4 * std::min(room(from.x, step.x), room(from.y, step.y));
}

// Permitted headings nearest to a heading on both sides, at least `within` [rad] inside their arcs or at a
// quarter of narrow arcs, as turns to the left; right < 0.
struct Sides {
  double right, left;
};
Sides around(const HeadingSet& set, double heading, double within) noexcept {
  Sides sides{-HeadingSet::kTurn, HeadingSet::kTurn};
  for (const HeadingArc& arc : set.arcs()) {
    const double in = std::min(within, 0.25 * arc.width_rad);
    for (const double at : {arc.from_rad + in, arc.from_rad + arc.width_rad - in}) {
      double off = std::fmod(at - heading, HeadingSet::kTurn);
      if (off < 0.0) off += HeadingSet::kTurn;
      sides.left = std::min(sides.left, off);
      sides.right = std::max(sides.right, off - HeadingSet::kTurn);
    }
  }
  return sides;
}

// Appends a zigzag from p to q, both inside the cell, and q. Returns false if no zigzag of at most kMostLegs
// pairs of legs stays inside the cell.
bool inTurns(const Sides& sides, InCell p, InCell q, std::vector<InCell>& way) {
  const InCell d = q - p;
  const double heading = std::atan2(d.y, d.x), length = std::hypot(d.x, d.y);
  const double between = std::sin(sides.left - sides.right);
  if (!(sides.left - sides.right < 0.5 * HeadingSet::kTurn) || !(between > 0.0)) return false;
  // u + v = d with non-negative multiples of the two headings.
  const InCell u = length * std::sin(sides.left) / between * unit(heading + sides.right);
  const InCell v = length * std::sin(-sides.right) / between * unit(heading + sides.left);
  for (int legs = 1; legs <= kMostLegs; legs *= 2) {
    const double part = 1.0 / legs;
    for (const InCell& first : {u, v}) {
      if (!inside(p + part * first) || !inside(p + (1.0 - part) * d + part * first)) continue;
      for (int k = 0; k < legs; ++k) {
        way.push_back(p + k * part * d + part * first);
        way.push_back(p + (k + 1) * part * d);
      }
      return true;
    }
  }
  return false;
}

bool connected(const HeadingSet& set, InCell p, InCell q, std::vector<InCell>& way) {
  const InCell d = q - p;
  const double heading = std::atan2(d.y, d.x), length = std::hypot(d.x, d.y);
  if (length < kLeast) return true;
  double least = 1e-6;
  for (const HeadingArc& arc : set.arcs()) least = std::min(least, 0.25 * arc.width_rad);
  const double off = std::remainder(set.nearest(heading, least) - heading, HeadingSet::kTurn);
  if (std::abs(off) * length < kLeast) {
    way.push_back(q);
    return true;
  }
  return inTurns(around(set, heading, 1e-3), p, q, way) || inTurns(around(set, heading, 1e-5), p, q, way);
}

}  // namespace

std::vector<InCell> drivenThrough(const HeadingSet& headings, const CellGate& in, const CellGate& out) {
  // Lengths of the straight legs at both gates; shorter legs use less of a narrow cone.
  constexpr std::array kSteps{0.2, 0.05, 0.01, 1e-3, 1e-4, 1e-5};
  constexpr int kMany = static_cast<int>(kSteps.size());
  const auto away = [](const CellGate& gate, double step, double sign) {
    if (!gate.heading_rad) return gate.place;
    const InCell h = sign * unit(*gate.heading_rad);
    return gate.place + std::min(step, stepInside(gate.place, h)) * h;
  };
  for (int both = 0; both < 2 * kMany - 1; ++both)
    for (int first = std::max(0, both - kMany + 1); first <= std::min(both, kMany - 1); ++first) {
      if (!in.heading_rad && first > 0) break;
      if (!out.heading_rad && both > first) continue;
      const InCell from = away(in, kSteps[static_cast<std::size_t>(first)], 1.0);
      const InCell to = away(out, kSteps[static_cast<std::size_t>(both - first)], -1.0);
      std::vector<InCell> way{from};
      if (connected(headings, from, to, way)) return way;
    }
  return {};
}

}  // namespace talus::planner
