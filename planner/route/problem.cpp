#include <algorithm>
#include <array>
#include <cctype>
#include <numbers>
#include <stdexcept>

#include <talus/common/nearest_name.hpp>
#include <talus/planner/route/problem.hpp>

namespace talus::planner {

namespace {

constexpr double kChord_cells = 0.5;
constexpr double kBend_rad = 0.1;  // the distance of a chord from its arc is at most 0.1^2/8 of the radius

int chordsOf(const Arc& arc, double step_m) noexcept {
  const double bend = std::abs(arc.length_m * arc.curvature_1_m) / kBend_rad;
  return std::max(1, static_cast<int>(std::ceil(std::max(std::abs(arc.length_m) / step_m, bend) - 1e-9)));
}

std::vector<PosePath::Leg> turnDriveTurn(const Pose& from, const Pose& to, bool may_reverse) {
  const double dx = to.place.x_m - from.place.x_m, dy = to.place.y_m - from.place.y_m;
  const double length = std::hypot(dx, dy);
  const double ahead = length > 0.0 ? std::atan2(dy, dx) : to.heading_rad;
  const auto turns = [&](double drive) {
    return std::pair{std::remainder(drive - from.heading_rad, 2.0 * std::numbers::pi),
                     std::remainder(to.heading_rad - drive, 2.0 * std::numbers::pi)};
  };
  auto [first, last] = turns(ahead);
  double signed_length = length;
  if (const auto [f, l] = turns(ahead + std::numbers::pi);
      may_reverse && std::abs(f) + std::abs(l) < std::abs(first) + std::abs(last)) {
    first = f, last = l;
    signed_length = -length;
  }
  std::vector<PosePath::Leg> legs;
  if (std::abs(first) > 1e-9) legs.push_back({{}, first});
  if (length > 0.0) legs.push_back({{signed_length, 0.0}, 0.0});
  if (std::abs(last) > 1e-9) legs.push_back({{}, last});
  return legs;
}

}  // namespace

Pose after(const Pose& from, const PosePath::Leg& leg) noexcept {
  Pose pose = after(from, leg.arc);
  pose.heading_rad += leg.turn_rad;
  return pose;
}

int direction(const PosePath::Leg& leg) noexcept {
  return (leg.arc.length_m > 0.0) - (leg.arc.length_m < 0.0);
}

PoseCost::PoseCost(const MotionCost& cost, const Kinematics& kinematics)
    : cost_(cost), kinematics_(kinematics), step_m_(kChord_cells * cost.map().grid().resolution_m) {
  if (kinematics.turning_radius_m > 0.0) curves_.emplace(kinematics);
}

std::vector<PosePath::Leg> PoseCost::direct(const Pose& from, const Pose& to, bool forward) const {
  if (!curves_) return turnDriveTurn(from, to, kinematics_.may_reverse && !forward);
  std::vector<PosePath::Leg> legs;
  for (const Arc& arc : forward ? curves_->forward(from, to) : (*curves_)(from, to))
    legs.push_back({arc, 0.0});
  return legs;
}

const TurnEfforts& PoseCost::turnsAt(maps::Point place) const noexcept {
  const auto cell = cost_.map().grid().cellAt(place);
  return cell ? kinematics_.turnsOn(cost_.map().at(*cell).curve()) : kinematics_.turns;
}

double PoseCost::operator()(const Pose& from, const PosePath::Leg& leg) const noexcept {
  return leg.turn_rad != 0.0 ? turnInPlace(from, leg.turn_rad) : arc(from, leg.arc);
}

double PoseCost::arc(const Pose& from, const Arc& arc) const noexcept {
  const int count = arc.curvature_1_m == 0.0 ? 1 : chordsOf(arc, step_m_);
  const Arc part{arc.length_m / count, arc.curvature_1_m};
  const double turn_rad = std::abs(part.length_m * part.curvature_1_m);
  double sum = 0.0;
  Pose pose = from;
  for (int k = 0; k < count; ++k) {
    const Pose next = after(pose, part);
    sum += cost_({pose.place, next.place});
    if (sum == kInfinity) return kInfinity;
    if (turn_rad > 0.0) sum += cost_.map().cost().cost_J(turnsAt(pose.place).on_arc) * turn_rad;
    pose = next;
  }
  return sum;
}

// Accumulated rounding may move a place to either side of an edge, so that a turn there needs both cells.
double PoseCost::turnInPlace(const Pose& from, double turn_rad) const noexcept {
  if (!cost_.map().grid().cellAt(from.place)) return kInfinity;
  const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(turn_rad) / kBend_rad)));
  for (int k = 0; k <= steps; ++k) {
    const double heading = from.heading_rad + turn_rad * k / steps;
    if (!cost_.headingAllowed(from.place, {std::cos(heading), std::sin(heading)})) return kInfinity;
  }
  const costmap::TravelCost& cost = cost_.map().cost();
  return cost.cost_J(kinematics_.stop) + cost.cost_J(turnsAt(from.place).in_place) * std::abs(turn_rad);
}

double PoseCost::operator()(const PosePath& path) const noexcept {
  double sum = 0.0;
  Pose pose = path.start;
  int last = 0;
  for (const auto& leg : path.legs) {
    const int now = direction(leg);
    if (now * last < 0) sum += cusp_J();
    if (now != 0) last = now;
    sum += (*this)(pose, leg);
    pose = after(pose, leg);
  }
  return sum;
}

std::vector<Pose> sampled(const PosePath& path, double step_m) {
  std::vector<Pose> poses{path.start};
  for (const auto& leg : path.legs) {
    const int count = leg.turn_rad != 0.0 ? 1 : chordsOf(leg.arc, step_m);
    const PosePath::Leg part{{leg.arc.length_m / count, leg.arc.curvature_1_m}, leg.turn_rad};
    for (int k = 0; k < count; ++k) poses.push_back(after(poses.back(), part));
  }
  return poses;
}

std::vector<Pose> chords(const PosePath& path, const costmap::CostGrid& map) {
  std::vector<Pose> poses{path.start};
  for (const auto& leg : path.legs) {
    const bool whole = leg.turn_rad != 0.0 || leg.arc.curvature_1_m == 0.0;
    const int count = whole ? 1 : chordsOf(leg.arc, kChord_cells * map.grid().resolution_m);
    const PosePath::Leg part{{leg.arc.length_m / count, leg.arc.curvature_1_m}, leg.turn_rad};
    for (int k = 0; k < count; ++k) poses.push_back(after(poses.back(), part));
  }
  return poses;
}

RouteShape shape(const PosePath& path) noexcept {
  RouteShape shape;
  int last = 0;
  for (const auto& leg : path.legs) {
    const int now = direction(leg);
    if (now * last < 0) ++shape.cusps;
    if (now != 0) last = now;
    shape.turned_rad += std::abs(leg.arc.length_m * leg.arc.curvature_1_m) + std::abs(leg.turn_rad);
    shape.max_curvature_1_m = std::max(shape.max_curvature_1_m, std::abs(leg.arc.curvature_1_m));
    if (leg.turn_rad != 0.0) ++shape.turns_in_place;
  }
  return shape;
}

double length_m(const PosePath& path) noexcept {
  double sum = 0.0;
  for (const auto& leg : path.legs) sum += std::abs(leg.arc.length_m);
  return sum;
}

namespace {

struct Refused {
  std::string_view name;
  std::string_view reason;
};

constexpr std::string_view kShared =
    "it assumes that every edge is traversable in both directions; its route is invalid where only "
    "descending is allowed";
constexpr std::string_view kUntried = "it is not proven correct for direction-dependent cost";
constexpr std::string_view kBlind = "it ignores the cost of a motion";

constexpr std::array kRefused{
    Refused{"PRM", kShared},
    Refused{"PRMstar", kShared},
    Refused{"LazyPRM", kShared},
    Refused{"LazyPRMstar", kShared},
    Refused{"SPARS", kShared},
    Refused{"SPARStwo", kShared},
    Refused{"BFMT", kShared},
    Refused{"LBTRRT", kBlind},
    Refused{"LazyLBTRRT", kBlind},
    Refused{"AITstar",
            "in OMPL 1.5.2 it does not terminate or finds no route under a direction-dependent cost"},
    Refused{"RRTXstatic", kUntried},
    Refused{"RRTsharp", kUntried},
    Refused{"CForest", "its result depends on thread timing"},
    Refused{"AnytimePathShortening", "its shortcuts ignore the cost of a motion"},
    Refused{"SORRTstar", kUntried},
    Refused{"RRT", kBlind},
    Refused{"RRTConnect", kBlind},
    Refused{"LazyRRT", kBlind},
    Refused{"TRRT", "it considers the cost of states, not of motions"},
    Refused{"BiTRRT", "it considers the cost of states, not of motions"},
    Refused{"EST", kBlind},
    Refused{"BiEST", kBlind},
    Refused{"ProjEST", kBlind},
    Refused{"KPIECE1", kBlind},
    Refused{"BKPIECE1", kBlind},
    Refused{"LBKPIECE1", kBlind},
    Refused{"SBL", kBlind},
    Refused{"PDST", kBlind},
    Refused{"STRIDE", kBlind},
};

// Normalised name: "Informed-RRT*" and "informedrrtstar" are equal.
std::string plain(std::string_view name) {
  std::string result;
  for (const char c : name) {
    if (c == '*') result += "star";
    if (std::isalnum(static_cast<unsigned char>(c)))
      result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return result;
}

// "; the nearest is 'field'", or an empty text without a similar name.
std::string suggestion(const std::string& word) {
  std::vector<std::string> plain_names;
  for (const std::string& name : plannerNames()) plain_names.push_back(plain(name));
  const auto near = std::ranges::find(plain_names, nearestName(word, plain_names));
  if (near == plain_names.end()) return "";
  return "; the nearest is '" + plannerNames()[static_cast<std::size_t>(near - plain_names.begin())] + "'";
}

std::string offered() {
  std::string list;
  for (const std::string& name : plannerNames()) list += (list.empty() ? "" : ", ") + name;
  return list;
}

}  // namespace

const std::vector<std::string>& plannerNames() {
  static const std::vector<std::string> names{"field",   "hybrid",   "RRTstar", "InformedRRTstar",
                                              "BITstar", "ABITstar", "SST",     "FMT"};
  return names;
}

std::string plannerName(std::string_view asked) {
  if (asked.empty()) return plannerNames().front();
  const std::string word = plain(asked);
  for (const std::string& name : plannerNames())
    if (plain(name) == word) return name;
  for (const Refused& refused : kRefused)
    if (plain(refused.name) == word)
      throw std::invalid_argument("planner '" + std::string(refused.name) + "' is refused: " +
                                  std::string(refused.reason) + "; use one of " + offered());
  throw std::invalid_argument("planner '" + std::string(asked) + "' is unknown" + suggestion(word) +
                              ", there are " + offered());
}

namespace {

// Replaces "start" and "goal" in the reason of a failed leg by the number of the via point.
std::string ofTheWhole(std::string reason, std::size_t leg, std::size_t legs) {
  const auto rename = [&reason](const std::string& end, std::size_t via) {
    if (reason.starts_with(end + ' ')) reason.replace(0, end.size(), "via point " + std::to_string(via));
  };
  if (leg > 0) rename("start", leg);
  if (leg + 1 < legs) rename("goal", leg + 1);
  return reason;
}

// Returns the cost [J] of the turn from the last leg of `a` to the first leg of `b`, at a via point.
double turnBetween(const Problem& problem, const Polyline& a, const Polyline& b) {
  if (!problem.map || a.size() < 2 || b.size() < 2) return 0.0;
  return MotionCost(problem.map)
      .turn(b.front(), directionOf({a[a.size() - 2], a.back()}), directionOf({b[0], b[1]}));
}

}  // namespace

Plan planByLegs(const Problem& problem, const std::function<Plan(const Problem& leg)>& plan_leg) {
  std::vector<maps::Point> stops = problem.via;
  stops.push_back(problem.goal);
  Plan whole{RouteStatus::Found, {}, {problem.start}, 0.0, 0.0};
  Problem leg = problem;
  leg.via.clear();
  for (std::size_t i = 0; i < stops.size(); ++i) {
    leg.start = whole.points.back();
    leg.goal = stops[i];
    leg.goal_tolerance_m = i + 1 == stops.size() ? problem.goal_tolerance_m : 0.0;
    Plan part = plan_leg(leg);
    if (part.status != RouteStatus::Found) {
      part.reason = ofTheWhole(std::move(part.reason), i, stops.size());
      return part;
    }
    whole.cost_J += part.cost_J + turnBetween(problem, whole.points, part.points);
    append(whole.points, part.points);
    whole.lower_bound_J += part.lower_bound_J;
    whole.proof_s += part.proof_s;
    problem.watch.report(static_cast<double>(i + 1) / static_cast<double>(stops.size()));
  }
  return whole;
}

}  // namespace talus::planner
