#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <numbers>
#include <random>

#include <fmt/format.h>

#include <talus/common/common.hpp>
#include <talus/costmap/cost/cost_model.hpp>
#include <talus/costmap/costmap.hpp>
#include <talus/maps/maps_io.hpp>
#include <talus/planner/plan/named_planner.hpp>

#include "published.hpp"

namespace talus::reproduce {
namespace {

using maps::Point;
using terramech::Gradient;
using CostOf = std::function<double(const Gradient&)>;

maps::ElevationMap made(int width, int height, const std::function<double(double, double)>& height_m) {
  maps::ElevationMap map;
  map.elevation_m = maps::Raster<float>({.width = width, .height = height, .resolution_m = 1.0});
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column)
      map.elevation_m[{column, row}] = static_cast<float>(height_m(column + 0.5, row + 0.5));
  return map;
}

planner::Plan planned(const maps::ElevationMap& map, const costmap::StatedCosts& costs, Point start,
                      Point goal, const ProgressMonitor& watch) {
  costmap::GroundModel::Parts parts{.classes = {{}}, .stated = costs};
  costmap::MapLayers layers{.elevation = map};
  const costmap::TraversabilityMap ground(
      std::move(layers), std::make_shared<costmap::GroundModel>(std::move(parts)),
      {.footprint_radius_m = std::numbers::sqrt2 * map.grid().resolution_m});
  planner::Problem problem{.map = ground.published(), .start = start, .goal = goal};
  problem.prove = true;
  problem.watch = watch;
  return planner::NamedPlanner().plan(problem);
}

// Cost of a polyline by a function of the gradients of the surface, in pieces of at most `piece_m`.
double along(const std::vector<Point>& points, double piece_m, const CostOf& cost,
             const std::function<Gradient(Point, Point)>& gradient) {
  double sum = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Point a = points[i - 1], b = points[i];
    const double length_m = std::hypot(b.x_m - a.x_m, b.y_m - a.y_m);
    const int pieces = std::max(1, static_cast<int>(std::ceil(length_m / piece_m)));
    const auto at = [&](double k) {
      return Point{a.x_m + k / pieces * (b.x_m - a.x_m), a.y_m + k / pieces * (b.y_m - a.y_m)};
    };
    for (int k = 0; k < pieces && length_m > 0.0; ++k)
      sum += cost(gradient(at(k), at(k + 1))) * length_m / pieces;
  }
  return sum;
}

cli::Series drawn(const std::string& name, const std::vector<Point>& points) {
  cli::Series series{.name = name};
  for (const Point p : points) series.x.push_back(p.x_m), series.y.push_back(p.y_m);
  return series;
}

// Friction and height on a plane that rises northward by 0.2, with a limit of the gradient along the route.
PublishedCase roweRoss(const ProgressMonitor& watch) {
  PublishedCase made_case{
      .name = "rowe-ross",
      .source = "rowe_ross_1990",
      .remark =
          "closed forms on a plane with friction 0.3: a straight climb, a heading at the limit of 0.1, and a "
          "switchback, whose length is the height over the limit"};
  const maps::ElevationMap plane = made(80, 80, [](double, double y) { return 0.2 * y; });
  cli::Plot plot{.title = "Routes on a plane", .x = {"x [m]"}, .y = {"y, uphill [m]"}, .series = {}};
  const auto add = [&](const std::string& what, double limit, Point start, Point goal, double theirs) {
    const costmap::StatedCosts costs{
        .states = {costmap::statedStates(
            [&](const Gradient& g) {
              return std::abs(g.along) < limit + 1.0 / 256 ? std::max(0.3 + g.along, 1e-6) : kInfinity;
            },
            0.0)},
        .max_along = limit};
    const planner::Plan plan = planned(plane, costs, start, goal, watch);
    made_case.lines.push_back({what + ", cost [-]", theirs, plan.cost_J, true});
    plot.series.push_back(drawn(what, plan.points));
  };
  add("straight", 0.5, {10.5, 10.5}, {60.5, 40.5}, 0.3 * std::hypot(50.0, 30.0) + 6.0);
  add("limit heading", 0.1, {10.5, 20.5}, {50.5, 60.5}, 0.3 * 80.0 + 8.0);
  add("switchback", 0.1, {40.5, 20.5}, {40.5, 60.5}, 0.3 * 80.0 + 8.0);
  made_case.plots = {plot};
  return made_case;
}

// Energy of a walking robot, of which theirs is the least of 847 weights of the objectives, on routes over pixels.
// `theirs` and the ends are of the segments that lunar_planner publishes.
PublishedCase lunarPlanner(const ProgressMonitor& watch) {
  PublishedCase made_case{.name = "lunar-planner",
                          .source = "richter_2024",
                          .remark =
                              "E = (803.3 + 10.54 s + 70.25 r + 0.7386 s^2 - 1.42 s r + 1773 r^2) d / 8 with "
                              "the slope s [deg] of "
                              "the heights along the route and r = 0.004, the greatest of the map; theirs is "
                              "the least of 847 weights"};
  const std::string file =
      sharedFile("TALUS_REAL_MAPS", "moon_aristarchus_imp_4m8_dem_slope_rockabundance.tif", made_case);
  if (file.empty()) return made_case;
  const maps::ElevationMap map = maps::readElevation(file, {.band = 1});
  const double cell_m = map.grid().resolution_m;
  const CostOf energy = [](const Gradient& g) {
    constexpr double r = 0.004;
    const double s = std::atan(g.along) / kDegree;
    return std::abs(s) < 31.0
               ? (803.3 + 10.54 * s + 70.25 * r + 0.7386 * s * s - 1.42 * s * r + 1773.0 * r * r) / 8.0
               : kInfinity;
  };
  const costmap::StatedCosts costs{.states = {costmap::statedStates(energy, 0.0)},
                                   .max_along = std::tan(30.0 * kDegree)};
  const auto rise = [&](Point a, Point b) {
    const double run_m = std::hypot(b.x_m - a.x_m, b.y_m - a.y_m);
    const auto low = maps::elevationAt(map.elevation_m, a), high = maps::elevationAt(map.elevation_m, b);
    return Gradient{low && high ? (*high - *low) / run_m : kInfinity, 0.0};
  };
  constexpr std::array<Point, 7> kEnds{{{426.443, -242.420},
                                        {416.913, 86.346},
                                        {-226.324, 362.700},
                                        {-288.266, 124.464},
                                        {264.442, -142.361},
                                        {169.148, -461.597},
                                        {-435.972, -185.243}}};
  constexpr std::array kTheirs{33554.1, 79922.4, 26231.1, 65994.1, 37329.4, 75489.8};
  cli::Plot plot{.title = "Aristarchus, six segments", .x = {"x [m]"}, .y = {"y [m]"}, .series = {}};
  for (std::size_t k = 0; k < kTheirs.size(); ++k) {
    const planner::Plan plan = planned(map, costs, kEnds[k], kEnds[k + 1], watch);
    const std::string what = fmt::format("segment {}", k + 1);
    made_case.lines.push_back({what + ", energy of the heights [N^2 m^2 s]", kTheirs[k],
                               along(plan.points, cell_m, energy, rise), true});
    made_case.lines.push_back(
        {what + ", lower bound of ours over the fitted slopes", kTheirs[k], plan.lower_bound_J, true});
    plot.series.push_back(drawn(what, plan.points));
  }
  made_case.plots = {plot};
  return made_case;
}

// Model of camis_2021: sqrt(((Ca + Cd)/2)^2 cos^2 + Cl^2 sin^2) + cos (Ca - Cd)/2 over the angle to the ascent, from the
// costs of ascent, descent and traverse at the steepness.
class Camis {
 public:
  Camis(double friction, double ratio_a, double ratio_b, double angle_a, double angle_b)
      : friction_(friction), ratio_a_(ratio_a), ratio_b_(ratio_b), angle_a_(angle_a), angle_b_(angle_b) {}

  double operator()(const Gradient& g) const {
    const double tangent = std::hypot(g.along, g.across), steep_deg = std::atan(tangent) / kDegree;
    const double slipping = 1.0 / std::max(0.01, 1.0 - ratio_a_ * std::exp(ratio_b_ * steep_deg));
    const double up = kWeight * (friction_ + tangent) * slipping,
                 down = descent(std::atan(tangent)) * slipping,
                 level = kWeight * friction_ * std::cos(std::atan(tangent)) /
                         std::cos(std::min(1.56, angle_a_ * std::exp(angle_b_ * steep_deg) * kDegree));
    const double c = tangent > 0.0 ? g.along / tangent : 1.0, s = tangent > 0.0 ? g.across / tangent : 0.0;
    return std::hypot(0.5 * (up + down) * c, level * s) + 0.5 * c * (up - down);
  }

 private:
  static constexpr double kWeight = 9.81, kBrake_rad = 15.0 * kDegree;

  // Driving below the braking steepness less a margin, braking above it plus the margin, a parabola between.
  double descent(double steep_rad) const {
    const double brake = std::atan(friction_), low = std::max(0.0, brake - kBrake_rad),
                 high = brake + kBrake_rad;
    const auto straight = [&](double s) { return kWeight * std::abs(friction_ - std::tan(s)); };
    if (steep_rad < low || steep_rad > high) return straight(steep_rad);
    const double a = low - brake, b = high - brake;
    const double t = std::abs(a + b) < 1e-3 ? (steep_rad - low) / (high - low)
                                            : (a + std::sqrt(a * a + (steep_rad - low) * (a + b))) / (a + b);
    return (1.0 - t) * (1.0 - t) * straight(low) + t * t * straight(high);
  }

  double friction_, ratio_a_, ratio_b_, angle_a_, angle_b_;
};

// The surface peaks(x, y) / 9 over 50 x 50 m.
double peaks(double x_m, double y_m) {
  const double x = -3.0 + x_m * 6.0 / 49.0, y = -4.5 + y_m * 9.0 / 49.0;
  return (3.0 * (1.0 - x) * (1.0 - x) * std::exp(-x * x - (y + 1.0) * (y + 1.0)) -
          10.0 * (x / 5.0 - x * x * x - std::pow(y, 5)) * std::exp(-x * x - y * y) -
          std::exp(-(x + 1.0) * (x + 1.0) - y * y) / 3.0) /
         9.0;
}

PublishedCase camis(const ProgressMonitor& watch) {
  PublishedCase made_case{.name = "camis",
                          .source = "camis_2021",
                          .remark =
                              "theirs: paths of their program at commit ffc2f96, run by us and continued "
                              "straight to A and B; both are "
                              "integrated over the exact surface. Our field raises costs that fall across "
                              "the slope, by up to 1 %"};
  const maps::ElevationMap map = made(50, 50, [](double x, double y) { return peaks(x - 0.5, y - 0.5); });
  struct Model {
    double friction, ratio_a, ratio_b, angle_a, angle_b, to_goal, back;
  };
  constexpr std::array<Model, 6> kModels{{{0.3, 0.07, 0.10, 1.32, 0.16, 139.18, 142.24},
                                          {0.6, 0.07, 0.10, 1.32, 0.16, 273.35, 270.12},
                                          {0.9, 0.07, 0.10, 1.32, 0.16, 409.20, 406.47},
                                          {0.3, 0.04, 0.07, 1.20, 0.08, 129.48, 133.65},
                                          {0.6, 0.04, 0.07, 1.20, 0.08, 253.07, 253.09},
                                          {0.9, 0.04, 0.07, 1.20, 0.08, 378.45, 379.01}}};
  constexpr Point kA{27.5, 5.5}, kB{20.5, 45.5};  // pixel centres
  const auto slope = [](Point a, Point b) {
    constexpr double kStep_m = 1e-4;
    const double x = 0.5 * (a.x_m + b.x_m) - 0.5, y = 0.5 * (a.y_m + b.y_m) - 0.5,
                 length_m = std::hypot(b.x_m - a.x_m, b.y_m - a.y_m);
    const double dx = (peaks(x + kStep_m, y) - peaks(x - kStep_m, y)) / (2.0 * kStep_m),
                 dy = (peaks(x, y + kStep_m) - peaks(x, y - kStep_m)) / (2.0 * kStep_m);
    const double hx = (b.x_m - a.x_m) / length_m, hy = (b.y_m - a.y_m) / length_m;
    return Gradient{dx * hx + dy * hy, std::abs(dy * hx - dx * hy)};
  };
  cli::Plot plot{.title = "CAMIS, A to B and back", .x = {"x [m]"}, .y = {"y [m]"}, .series = {}};
  for (std::size_t k = 0; k < kModels.size(); ++k) {
    const Model& m = kModels[k];
    const Camis cost(m.friction, m.ratio_a, m.ratio_b, m.angle_a, m.angle_b);
    const costmap::StatedCosts costs{
        .states = {costmap::statedStates(cost, 1.0)}, .max_along = 0.99, .max_across = 0.99};
    for (const bool back : {false, true}) {
      const planner::Plan plan = planned(map, costs, back ? kB : kA, back ? kA : kB, watch);
      made_case.lines.push_back({fmt::format("model {}, {}, cost [N]", k + 1, back ? "B to A" : "A to B"),
                                 back ? m.back : m.to_goal, along(plan.points, 0.05, cost, slope), true});
      plot.series.push_back(drawn(fmt::format("{} {}", k + 1, back ? "back" : "there"), plan.points));
    }
  }
  made_case.plots = {plot};
  return made_case;
}

// The rule of chancan_2025: cells are free up to a slope, a planner has 60 s; with the bound that they lack.
PublishedCase planBench(const ProgressMonitor& watch) {
  PublishedCase made_case{.name = "moonplanbench",
                          .source = "chancan_2025",
                          .remark =
                              "their rule (slope cut, 60 s, shortest path) on our maps, 20 pairs each; they "
                              "report success of up to "
                              "100 % and no optimum. Theirs of the excess is the proven bound; a proof of "
                              "\"no route\" is a success"};
  for (const char* name :
       {"moon_lola_npc_2km_5m.tif", "mars_gale_hirise_1m.tif", "mars_ctx_gale_square_20m.tif"}) {
    const std::string file = sharedFile("TALUS_REAL_MAPS", name, made_case);
    if (file.empty()) return made_case;
    const maps::ElevationMap map = maps::readElevation(file, {});
    const maps::Grid& grid = map.grid();
    for (const double cut_deg : {10.0, 15.0, 20.0}) {
      const double cut = std::tan(cut_deg * kDegree);
      const costmap::StatedCosts costs{
          .states = {costmap::statedStates(
              [cut](const Gradient& g) { return std::hypot(g.along, g.across) <= cut ? 1.0 : kInfinity; },
              1.0)},
          .max_along = cut,
          .max_across = cut};
      std::mt19937_64 random(7);
      int answered = 0;
      double gap = 0.0;
      constexpr int kPairs = 20;
      for (int pair = 0; pair < kPairs && !watch.stopped(); ++pair) {
        const auto any = [&] {
          const auto of = [&](int cells) {
            return static_cast<double>(random() % static_cast<unsigned>(cells)) + 0.5;
          };
          return Point{grid.south_west.x_m + of(grid.width) * grid.resolution_m,
                       grid.south_west.y_m + of(grid.height) * grid.resolution_m};
        };
        const Point start = any(), goal = any();
        const planner::Plan plan = planned(map, costs, start, goal, watch);
        const bool found = plan.status == planner::RouteStatus::Found;
        answered += found || plan.status != planner::RouteStatus::NoneFound ? 1 : 0;
        if (found) gap = std::max(gap, 1.0 - plan.lower_bound_J / plan.cost_J);
      }
      const std::string what =
          fmt::format("{}, {:.0f} deg", std::filesystem::path(name).stem().string(), cut_deg);
      made_case.lines.push_back(
          {what + ", pairs answered [-]", 1.0, static_cast<double>(answered) / kPairs, false});
      made_case.lines.push_back({what + ", greatest excess over the bound [-]", 0.0, gap, false});
    }
  }
  return made_case;
}

}  // namespace

std::string sharedFile(const char* variable, const std::string& file, PublishedCase& made) {
  const char* folder = std::getenv(variable);
  const std::string path = folder != nullptr ? (std::filesystem::path(folder) / file).string() : "";
  if (std::filesystem::exists(path)) return path;
  made.remark = fmt::format("not rebuilt: set {} to the folder of {}", variable, file);
  return "";
}

std::vector<PublishedCase> publishedRoutes(const std::string& name, const ProgressMonitor& watch) {
  std::vector<PublishedCase> cases;
  const auto add = [&](const char* of, auto make) {
    if ((name.empty() || name == of) && !watch.stopped()) cases.push_back(make(watch));
  };
  add("rowe-ross", roweRoss);
  add("lunar-planner", lunarPlanner);
  add("camis", camis);
  add("moonplanbench", planBench);
  return cases;
}

}  // namespace talus::reproduce
