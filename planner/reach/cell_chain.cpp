#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <talus/planner/reach/cell_chain.hpp>

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

using maps::Cell;
using maps::Point;

// Shares by which a cone is narrowed at both ends; tried in order until a route is found.
constexpr std::array kCuts{0.3, 0.1, 0.03, 0.01, 1e-3, 0.0};
constexpr double kTouch = 1e-6;  // sides: distance within which MotionCost treats two places as equal

using Ends = std::pair<InCell, InCell>;

InCell nearestOnSegment(InCell a, InCell b, InCell to) noexcept {
  const InCell d = b - a, e = to - a;
  const double square = d.x * d.x + d.y * d.y;
  return a + (square > 0.0 ? std::clamp((d.x * e.x + d.y * e.y) / square, 0.0, 1.0) : 0.0) * d;
}

class Layer {
 public:
  Layer(const MotionCost& cost, const std::vector<ChainLink>& chain, const Segment& places,
        double tolerance_m, const ChainMargins& margins)
      : cost_(cost),
        grid_(cost.map().grid()),
        chain_(chain),
        places_(places),
        tolerance_m_(tolerance_m),
        margins_(margins) {}

  LaidChain laid() {
    std::size_t failed = 0;
    for (const double cut : kCuts) {
      cut_ = cut;
      Polyline way;
      if (funnel() && gates()) way = driven();
      if (!way.empty()) return {std::move(way), 0};
      failed = std::max(failed, failed_);
    }
    return {{}, failed};
  }

 private:
  HeadingCone cone(std::size_t k) const {
    return HeadingCone(chain_[k].headings, chain_[k].everywhere ? 0.0 : cut_);
  }
  int exit(std::size_t k) const noexcept { return otherSide(chain_[k + 1].side); }

  Ends entry(std::size_t k) const {
    if (k == 0)
      return {inCell(grid_, chain_[0].cell, places_.from), inCell(grid_, chain_[0].cell, places_.from)};
    return {onSide(chain_[k].side, ranges_[k].from), onSide(chain_[k].side, ranges_[k].to)};
  }

  // Computes the reachable range of each side from the start forwards, and the end point in the last cell.
  bool funnel() {
    const std::size_t last = chain_.size() - 1;
    ranges_.assign(chain_.size(), {});
    for (std::size_t k = 0; k < last; ++k) {
      const auto [a, b] = entry(k);
      SideRange range{0.0, 1.0};
      if (!chain_[k].everywhere) range = cone(k).reached(a, b, exit(k), margins_.slack);
      ranges_[k + 1] = {std::max(range.from, margins_.apart), std::min(range.to, 1.0 - margins_.apart)};
      if (ranges_[k + 1].empty()) return failedAt(k);
    }
    const auto end = nearestReached(grid_, chain_[last].cell, cone(last), entry(last), places_, tolerance_m_,
                                    margins_.slack);
    if (!end) return failedAt(last);
    end_ = *end;
    return true;
  }

  // Chooses the crossing point on each side from the end backwards: the middle of the range from which the
  // next point is reachable. In cells in which every direction is drivable: the point straight across from
  // the next point, limited to the middle half of the range.
  bool gates() {
    at_.assign(chain_.size(), 0.0);
    InCell target = end_;
    for (std::size_t k = chain_.size() - 1; k > 0; --k) {
      const ChainLink& link = chain_[k];
      SideRange range = ranges_[k];
      if (!link.everywhere) {
        const SideRange to = cone(k).reaching(target, link.side, 1e-9);
        range = {std::max(range.from, to.from), std::min(range.to, to.to)};
        if (range.empty()) return failedAt(k);
      }
      const double wanted = link.side == Side::West || link.side == Side::East ? target.y : target.x;
      const double inner = 0.25 * (range.to - range.from);
      at_[k] = link.everywhere ? std::clamp(wanted, range.from + inner, range.to - inner)
                               : 0.5 * (range.from + range.to);
      target = onSide(otherSide(link.side), at_[k]);
    }
    return true;
  }

  // Candidate headings for crossing the side before a link: near the straight headings before and after the
  // side, near the normal of the side, and the middle of each arc.
  std::vector<double> crossings(std::size_t k) const {
    const HeadingSet both = chain_[k - 1].headings.shared(chain_[k].headings);
    std::vector<double> headings;
    if (both.empty()) return headings;
    const double across = outwards_rad(exit(k - 1));
    const auto add = [&](double heading) {
      if (std::cos(heading - across) > 1e-3 && std::ranges::find(headings, heading) == headings.end())
        headings.push_back(heading);
    };
    const InCell before = placeIn(k - 1), here = placeOut(k - 1), from = placeIn(k),
                 to = k + 1 < chain_.size() ? placeOut(k) : end_;
    add(both.nearest(std::atan2(here.y - before.y, here.x - before.x), 1e-3));
    add(both.nearest(std::atan2(to.y - from.y, to.x - from.x), 1e-3));
    add(both.nearest(across, 1e-3));
    for (const HeadingArc& arc : both.arcs()) add(arc.from_rad + 0.5 * arc.width_rad);
    return headings;
  }

  InCell placeIn(std::size_t k) const {
    return k == 0 ? inCell(grid_, chain_[0].cell, places_.from) : onSide(chain_[k].side, at_[k]);
  }
  InCell placeOut(std::size_t k) const { return onSide(exit(k), at_[k + 1]); }

  // State of the drive at a crossing: heading, index of the previous crossing, and intermediate places.
  struct Passed {
    std::optional<double> heading_rad{};
    std::size_t before = 0;
    std::vector<InCell> way{};
  };

  Polyline driven() {
    std::vector<std::vector<Passed>> passed{{Passed{}}};
    for (std::size_t k = 0; k < chain_.size(); ++k) {
      const bool last = k + 1 == chain_.size();
      std::vector<std::optional<double>> wanted{std::nullopt};
      if (!last) {
        const std::vector<double> headings = crossings(k + 1);
        wanted.assign(headings.begin(), headings.end());
      }
      std::vector<Passed> here;
      for (const std::optional<double>& heading : wanted) {
        const CellGate out{last ? end_ : placeOut(k), heading};
        for (std::size_t i = 0; i < passed.back().size(); ++i) {
          auto way = drivenThrough(chain_[k].headings, {placeIn(k), passed.back()[i].heading_rad}, out);
          if (way.empty()) continue;
          here.push_back({heading, i, std::move(way)});
          break;
        }
      }
      if (here.empty()) return failedAt(k), Polyline{};
      passed.push_back(std::move(here));
    }
    return checked(passed);
  }

  Polyline checked(const std::vector<std::vector<Passed>>& passed) {
    std::vector<std::size_t> links;
    Polyline way;
    for (std::size_t k = chain_.size(), i = 0; k > 0; --k) {
      const Passed& gate = passed[k][i];
      for (auto p = gate.way.rbegin(); p != gate.way.rend(); ++p) {
        way.push_back(onMap(grid_, chain_[k - 1].cell, *p));
        links.push_back(k - 1);
      }
      i = gate.before;
    }
    std::ranges::reverse(way);
    std::ranges::reverse(links);
    way.front() = places_.from;
    if (tolerance_m_ == 0.0) way.back() = places_.to;
    if (std::isfinite(cost_.along(way))) return way;
    for (std::size_t k = 1; k < way.size(); ++k)
      if (!std::isfinite(cost_({way[k - 1], way[k]}))) return failedAt(links[k - 1]), Polyline{};
    return failedAt(0), Polyline{};
  }

  bool failedAt(std::size_t k) {
    failed_ = k;
    return false;
  }

  const MotionCost& cost_;
  const maps::Grid& grid_;
  const std::vector<ChainLink>& chain_;
  Segment places_;
  double tolerance_m_;
  ChainMargins margins_;
  double cut_ = 0.0;
  std::size_t failed_ = 0;
  std::vector<SideRange> ranges_;  // ranges on the entry sides of the links
  std::vector<double> at_;         // positions on these sides
  InCell end_;
};

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

std::optional<InCell> nearestReached(const maps::Grid& grid, Cell cell, const HeadingCone& cone,
                                     const Ends& from, const Segment& places, double tolerance_m,
                                     double slack) {
  const InCell goal = inCell(grid, cell, places.to);
  if (!(tolerance_m > 0.0)) {
    const bool within = std::max(std::abs(goal.x - 0.5), std::abs(goal.y - 0.5)) <= 0.5 + kTouch;
    return within && cone.joins(from.first, from.second, goal, slack) ? std::optional(goal) : std::nullopt;
  }
  const double inside = slack < 0.0 ? 1e-3 : 0.0,
               reach = tolerance_m / grid.resolution_m + (slack < 0.0 ? 0.0 : kTouch);
  const std::vector<InCell> part = cone.reachedPart(from.first, from.second, slack, inside);
  std::optional<InCell> nearest;
  double least = std::numeric_limits<double>::infinity();
  bool left = true, right = true;  // over all sides: true if the goal lies inside
  const auto look = [&](InCell p) {
    const double off = std::hypot(p.x - goal.x, p.y - goal.y);
    if (off >= least || off > reach) return;
    least = off;
    nearest = p;
  };
  for (std::size_t k = 0; k < part.size(); ++k) {
    const InCell a = part[k], b = part[(k + 1) % part.size()];
    look(nearestOnSegment(a, b, goal));
    const double turn = (b.x - a.x) * (goal.y - a.y) - (b.y - a.y) * (goal.x - a.x);
    left = left && turn >= 0.0;
    right = right && turn <= 0.0;
  }
  return !part.empty() && left != right ? std::optional(goal) : nearest;
}

LaidChain laidChain(const MotionCost& cost, const std::vector<ChainLink>& chain, const Segment& places,
                    double tolerance_m, const ChainMargins& margins) {
  return Layer(cost, chain, places, tolerance_m, margins).laid();
}

}  // namespace talus::planner
