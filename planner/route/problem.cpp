#include <algorithm>
#include <array>
#include <cctype>
#include <stdexcept>

#include <talus/common/nearest_name.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/problem.hpp>

namespace talus::planner {

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
