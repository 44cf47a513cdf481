#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include <talus/cli/draw/route_summary.hpp>
#include <talus/common/common.hpp>

namespace talus::cli {
namespace {

using planner::Route;
using planner::RouteVertex;
using Facts = std::vector<std::pair<std::string, std::string>>;

/// Extremes and length-weighted mean of a field over the motions; unknown if no motion has a value.
struct Profile {
  double highest = -INFINITY;
  double lowest = INFINITY;
  double mean = 0.0;
  std::size_t lowest_at = 0;

  bool known() const { return highest >= lowest; }
};

Profile profile(const Route& route, double RouteVertex::*field) {
  Profile p;
  const std::vector<double> s = distances_m(route);
  double length = 0.0;
  for (std::size_t i = 0; i + 1 < s.size(); ++i) {
    const double value = route.vertices[i].*field;
    if (std::isnan(value)) continue;
    p.highest = std::max(p.highest, value);
    if (value < p.lowest) p.lowest_at = i;
    p.lowest = std::min(p.lowest, value);
    p.mean += value * (s[i + 1] - s[i]);
    length += s[i + 1] - s[i];
  }
  if (length > 0.0) p.mean /= length;
  return p;
}

std::string straightText(const Route& route) {
  const RouteVertex& a = route.vertices.front();
  const RouteVertex& b = route.vertices.back();
  const double straight = std::hypot(b.x_m - a.x_m, b.y_m - a.y_m);
  if (!(straight > 0.0)) return "";
  return fmt::format(", detour factor {:.2f}", route.length_m / straight);
}

std::string climbText(const Route& route) {
  double up = 0.0;
  double down = 0.0;
  for (std::size_t i = 0; i + 1 < route.vertices.size(); ++i) {
    const double dz = route.vertices[i + 1].elevation_m - route.vertices[i].elevation_m;
    if (dz > 0.0) up += dz;
    if (dz < 0.0) down -= dz;
  }
  return fmt::format("ascent {:.4g} m, descent {:.4g} m", up, down);
}

std::string slopeText(const Route& route) {
  const Profile along = profile(route, &RouteVertex::slope_along_rad);
  const Profile across = profile(route, &RouteVertex::slope_across_rad);
  if (!along.known()) return "";
  return fmt::format("max uphill {:.1f} deg, downhill {:.1f} deg, cross-slope {:.1f} deg",
                     std::max(0.0, along.highest) / kDegree, std::max(0.0, -along.lowest) / kDegree,
                     std::max(std::abs(across.highest), std::abs(across.lowest)) / kDegree);
}

std::string marginText(const Route& route) {
  const Profile margin = profile(route, &RouteVertex::drawbar_pull_margin);
  if (!margin.known()) return "";
  const RouteVertex& at = route.vertices[margin.lowest_at];
  return fmt::format("min {:+.3f} (DP/W), {} from the start at {:.1f},{:.1f}", margin.lowest,
                     lengthText(distances_m(route)[margin.lowest_at]), at.x_m, at.y_m);
}

std::string groundText(const Route& route) {
  const std::array<double, 4> shares = categoryShares(route);
  std::string text;
  for (std::size_t c = 0; c < shares.size(); ++c)
    if (shares[c] > 0.0)
      text += fmt::format("{}{} {:.1f} %", text.empty() ? "" : ", ",
                          terramech::name(static_cast<terramech::Category>(c)), 100.0 * shares[c]);
  return shares[3] < 1.0 ? text : "";
}

std::string wheelText(const Route& route) {
  const Profile sinkage = profile(route, &RouteVertex::sinkage_m);
  const Profile torque = profile(route, &RouteVertex::torque_Nm);
  if (!sinkage.known() || !torque.known()) return "";
  return fmt::format("sinkage max {:.1f} mm, mean {:.1f} mm; torque max {:.3g} Nm", 1000.0 * sinkage.highest,
                     1000.0 * sinkage.mean, std::max(torque.highest, -torque.lowest));
}

std::string slipText(const Route& route) {
  const Profile slip = profile(route, &RouteVertex::slip);
  if (!slip.known()) return "";
  std::string text = fmt::format("min {:.2f}, max {:.2f}, mean {:.2f}", slip.lowest, slip.highest, slip.mean);
  const Profile angle = profile(route, &RouteVertex::slip_angle_rad);
  if (angle.known())
    text += fmt::format("; slip angle max {:.1f} deg",
                        std::max(std::abs(angle.highest), std::abs(angle.lowest)) / kDegree);
  return text;
}

/// The planner and the optimality gap.
std::string statusText(const Route& route) {
  const planner::RouteSummary& s = route;
  if (!std::isfinite(s.gap)) return fmt::format("found by {}; no lower bound", s.planner);
  return fmt::format("found by {}; proven optimality gap <= {:.1f} %", s.planner, 100.0 * s.gap);
}

std::string riskText(double probability) {
  if (probability > 0.99) return "immobilisation probability > 0.99";
  return std::isnan(probability) ? "" : fmt::format("immobilisation probability {:.2g}", probability);
}

std::string driveText(const Route& route) {
  if (!route.drive) return "";
  const planner::RouteShape& d = *route.drive;
  const std::string radius = d.max_curvature_1_m > 0.0
                                 ? fmt::format("min turning radius {:.3g} m", 1.0 / d.max_curvature_1_m)
                                 : "no arcs";
  return fmt::format("{}, {} reversals, {} turns in place, total heading change {:.0f} deg", radius, d.cusps,
                     d.turns_in_place, d.turned_rad / kDegree);
}

}  // namespace

std::optional<RouteWarning> warningOf(const Route& route) {
  constexpr double kLikely = 0.1;
  constexpr const char* kRemedy = ": lower --risk, measure the ground, or choose another goal";
  const auto at = [](const RouteVertex& v, const char* format) {
    return RouteWarning{{v.x_m, v.y_m}, fmt::format(fmt::runtime(format), v.x_m, v.y_m) + kRemedy};
  };
  const Profile margin = profile(route, &RouteVertex::drawbar_pull_margin);
  if (margin.known() && margin.lowest < 0.0)
    return at(route.vertices[margin.lowest_at],
              "the slope at {:.1f},{:.1f} requires more drawbar pull than is available at slip 0.5");
  if (route.vertices.empty() || !(route.vertices.back().immobilisation_risk > kLikely)) return std::nullopt;
  return at(*std::ranges::max_element(route.vertices, {}, &RouteVertex::hazard_per_m),
            "immobilisation is likely, most at {:.1f},{:.1f}");
}

std::vector<double> distances_m(const Route& route) {
  std::vector<double> s;
  for (std::size_t i = 0; i < route.vertices.size(); ++i) {
    const RouteVertex& b = route.vertices[i];
    const RouteVertex& a = route.vertices[i == 0 ? 0 : i - 1];
    s.push_back((i == 0 ? 0.0 : s.back()) + std::hypot(b.x_m - a.x_m, b.y_m - a.y_m));
  }
  return s;
}

std::array<double, 4> categoryShares(const Route& route) {
  std::array<double, 4> shares{};
  const std::vector<double> s = distances_m(route);
  if (s.empty() || !(s.back() > 0.0)) return shares;
  for (std::size_t i = 0; i + 1 < s.size(); ++i)
    shares[static_cast<std::size_t>(route.vertices[i].category)] += (s[i + 1] - s[i]) / s.back();
  return shares;
}

std::string lengthText(double metres) {
  return metres >= 2000.0 ? fmt::format("{:.2f} km", metres / 1000.0) : fmt::format("{:.4g} m", metres);
}

std::string energyText(double joules) {
  if (joules >= 1e6) return fmt::format("{:.4g} MJ", joules / 1e6);
  return joules >= 1e4 ? fmt::format("{:.4g} kJ", joules / 1e3) : fmt::format("{:.4g} J", joules);
}

std::string durationText(double seconds) {
  if (!std::isfinite(seconds)) return "unbounded";
  const auto minutes = static_cast<long long>(std::llround(seconds / 60.0));
  if (seconds < 100.0) return fmt::format("{:.0f} s", seconds);
  if (minutes < 60) return fmt::format("{} min", minutes);
  if (minutes < 48 * 60) return fmt::format("{} h {:02} min", minutes / 60, minutes % 60);
  return fmt::format("{} d {:02} h", minutes / 1440, minutes % 1440 / 60);
}

// What 9 of 10 drives do not exceed; empty if it is not known.
template <typename Text>
std::string atMost(double p90, Text text) {
  return p90 > 0.0 ? fmt::format(", 9 of 10 drives at most {}", text(p90)) : "";
}

std::string timeText(const planner::RouteSummary& s) {
  if (std::isnan(s.time_s)) return "";
  return fmt::format("{}{}, mean speed {:.3g} m/s", durationText(s.time_s),
                     atMost(s.time_p90_s, durationText), s.length_m / s.time_s);
}

std::string effortText(const planner::RouteSummary& s) {
  return fmt::format("{} ({:.4g} Wh), {:.4g} J/m{}; cost including time and risk {}", energyText(s.energy_J),
                     s.energy_J / 3600.0, s.energy_J / s.length_m, atMost(s.energy_p90_J, energyText),
                     energyText(s.cost));
}

Facts summaryOf(const Route& route) {
  if (route.status != planner::RouteStatus::Found || route.vertices.empty())
    return {{"route", fmt::format("{}: {}", planner::name(route.status), route.reason)}};
  const planner::RouteSummary& s = route;
  if (!(s.length_m > 0.0) && s.drive && s.drive->turns_in_place > 0)
    return {{"route", fmt::format("turn in place by {:.0f} deg, {}", s.drive->turned_rad / kDegree,
                                  energyText(s.energy_J))}};
  if (!(s.length_m > 0.0)) return {{"route", "empty: the start is at the goal, or within its tolerance"}};
  const double risk = route.vertices.back().immobilisation_risk;
  Facts facts{
      {"route", statusText(route)},
      {"length", lengthText(s.length_m) + straightText(route)},
      {"driving time", timeText(s)},
      {"energy", std::isnan(s.time_s) ? "" : effortText(s)},
      {"cost",
       std::isnan(s.time_s) ? fmt::format("{:.6g}, {:.4g} a metre", s.cost, s.cost / s.length_m) : ""},
      {"manoeuvres", driveText(route)},
      {"elevation", climbText(route)},
      {"slope", slopeText(route)},
      {"slip", slipText(route)},
      {"wheel", wheelText(route)},
      {"drawbar-pull margin", marginText(route)},
      {"traversability", groundText(route)},
      {"risk", riskText(risk)},
      {"warning", warningOf(route).value_or(RouteWarning{}).text}};
  std::erase_if(facts, [](const auto& fact) { return fact.second.empty(); });
  return facts;
}

std::string summaryLine(std::string_view what, std::string_view value) {
  return fmt::format("{:<21}{}\n", what, value);
}

std::string summaryText(const Route& route) {
  std::string text;
  for (const auto& [what, value] : summaryOf(route)) text += summaryLine(what, value);
  return text;
}

}  // namespace talus::cli
