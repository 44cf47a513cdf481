#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <random>
#include <set>
#include <variant>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <talus/cli/app/context.hpp>
#include <talus/cli/draw/plot.hpp>
#include <talus/cli/study/bench_suite.hpp>
#include <talus/common/common.hpp>
#include <talus/costmap/ground/ground_model.hpp>
#include <talus/maps/sites/site_generator.hpp>
#include <talus/planner/bench/grid_suite.hpp>
#include <talus/planner/bench/slip_world.hpp>
#include <talus/planner/grid/field_planner.hpp>
#include <talus/planner/route/route.hpp>
#include <talus/planner/simulation/simulation.hpp>
#include <talus/terramech/terramech_io.hpp>

namespace talus::cli {

namespace {

using planner::BenchmarkCase;

maps::Point anywhere(const maps::Grid& grid, std::mt19937_64& random) {
  const auto pick = [&random](int n) { return static_cast<int>(random() % static_cast<std::uint64_t>(n)); };
  const int column = pick(grid.width);
  return grid.centre({column, pick(grid.height)});
}

// Distant places between which the field planner finds a route; fewer than `count` if the map has few such
// places.
std::vector<BenchmarkCase> pairsOn(const std::string& name,
                                   const std::shared_ptr<const costmap::CostGrid>& map, int count,
                                   std::uint64_t seed) {
  const maps::Grid& grid = map->grid();
  const double least_m = 0.5 * grid.resolution_m * std::hypot(grid.width, grid.height);
  std::mt19937_64 random(seed);
  planner::FieldPlanner field;
  std::vector<BenchmarkCase> cases;
  // Limits the unsuccessful field searches: drawing places is fast, but each search without a route covers
  // the whole map.
  int in_vain = 0;
  for (int tries = 0; tries < 1000 && in_vain < 20 && static_cast<int>(cases.size()) < count; ++tries) {
    planner::Problem problem;
    problem.map = map;
    problem.prove = false;
    problem.start = anywhere(grid, random);
    problem.goal = anywhere(grid, random);
    if (std::hypot(problem.goal.x_m - problem.start.x_m, problem.goal.y_m - problem.start.y_m) < least_m)
      continue;
    const planner::MotionCost cost(map);
    if (!cost.allowed(problem.start) || !cost.allowed(problem.goal)) continue;
    if (field.plan(problem).status != planner::RouteStatus::Found) {
      ++in_vain;
      continue;
    }
    cases.push_back({.name = name + " " + std::to_string(cases.size() + 1),
                     .map = map,
                     .start = problem.start,
                     .goal = problem.goal});
  }
  return cases;
}

// Assigns the rover's kinematics, with the option's turning radius, to the cases.
void giveKinematics(std::vector<BenchmarkCase>& cases, const costmap::GroundModel& model,
                    const SuiteOptions& options) {
  for (BenchmarkCase& made : cases) {
    made.kinematics = planner::kinematicsOn(model, made.map->cost());
    if (options.turning_radius_m >= 0.0) made.kinematics.turning_radius_m = options.turning_radius_m;
  }
}

std::shared_ptr<const costmap::GroundModel> generatedGround() {
  costmap::GroundModel::Parts parts;
  parts.rover = terramech::loadRover("mer");
  const std::array soils{std::pair{maps::SiteClass::Firm, "mars_crusty"},
                         std::pair{maps::SiteClass::Loose, "sand"},
                         std::pair{maps::SiteClass::VeryLoose, "mars_drift"}};
  for (const auto& [site_class, soil] : soils)
    parts.classes.push_back(
        costmap::groundClass(static_cast<int>(site_class), terramech::loadSoilPrior(soil), parts.rover));
  return std::make_shared<const costmap::GroundModel>(std::move(parts));
}

std::vector<BenchmarkCase> generatedCases(const SuiteOptions& options, const Context& context) {
  std::vector<BenchmarkCase> cases;
  const auto model = generatedGround();
  for (const auto& [kind, name] :
       {std::pair{maps::SiteKind::Craters, "craters"}, std::pair{maps::SiteKind::Dunes, "dunes"},
        std::pair{maps::SiteKind::Rocks, "rocks"}}) {
    maps::Site site = maps::generateSite({.kind = kind,
                                          .width = options.side_cells,
                                          .height = options.side_cells,
                                          .resolution_m = 1.0,
                                          .seed = context.seed});
    costmap::MapLayers layers;
    layers.elevation = std::move(site.map);
    layers.classes = std::move(site.classes);
    layers.rock_abundance = std::move(site.rock_abundance);
    const auto map = costmap::TraversabilityMap(std::move(layers), model, {}).published();
    for (BenchmarkCase& made : pairsOn(name, map, options.pairs, context.seed))
      cases.push_back(std::move(made));
  }
  giveKinematics(cases, *model, options);
  return cases;
}

// Each world yields two cases: planned with the mean slip of the visible terrain, and with the tail of the
// slip distribution.
std::vector<BenchmarkCase> slipCases(const SuiteOptions& options, const Context& context) {
  std::vector<BenchmarkCase> cases;
  for (int k = 1; k <= options.pairs; ++k)
    for (const bool risk_aware : {false, true}) {
      const auto world = std::make_shared<const planner::SlipWorld>(planner::slipWorld(
          {.seed = context.seed * 1000 + static_cast<std::uint64_t>(k), .risk_aware = risk_aware}));
      const maps::Grid& grid = world->map->grid();
      const std::string group = risk_aware ? "slip tail" : "slip mean";
      cases.push_back({.name = group + " " + std::to_string(k),
                       .map = world->map,
                       .start = grid.centre({8, 8}),
                       .goal = grid.centre({grid.width - 9, grid.height - 9}),
                       .kinematics = {.turning_radius_m = std::max(0.0, options.turning_radius_m)},
                       .world = world,
                       .group = group});
    }
  return cases;
}

std::vector<BenchmarkCase> mapCases(const std::string& path, const SuiteOptions& options,
                                    const Context& context) {
  GroundOptions ground = options.ground;
  ground.elevation.path = path;
  const Ground read = readGround(ground, context);
  auto cases =
      pairsOn(std::filesystem::path(path).stem().string(), read.map.published(), options.pairs, context.seed);
  if (static_cast<int>(cases.size()) < options.pairs)
    context.warn(path + ": " + std::to_string(cases.size()) +
                 " pairs of distant places with a route between them, fewer than requested");
  giveKinematics(cases, read.map.model(), options);
  return cases;
}

std::vector<BenchmarkCase> casesOf(const std::string& name, const SuiteOptions& options,
                                   const Context& context) {
  if (name == "generated") return generatedCases(options, context);
  if (name == "slip") return slipCases(options, context);
  if (name == "grids") return planner::gridCases(64, options.pairs, context.seed);
  if (name.ends_with(".scen")) return planner::readMovingAi(name, static_cast<std::size_t>(options.pairs));
  return mapCases(name, options, context);
}

bool isMap(const std::string& name) {
  return name != "generated" && name != "slip" && name != "grids" && !name.ends_with(".scen");
}

void refuseUnusedGround(const SuiteOptions& options) {
  const GroundOptions& g = options.ground;
  const bool given = !g.soil.empty() || !g.soils.empty() || !g.model.empty() || !g.rover.empty() ||
                     !g.classes.empty() || !g.rocks.empty() || !g.keep_out.empty();
  if (given && std::ranges::none_of(options.names, isMap))
    throw InputError({"talus bench", "a soil, rover or layer is given without an elevation map",
                      "name a map; the other suites have their own terrain"});
}

}  // namespace

std::vector<BenchmarkCase> suiteCases(const SuiteOptions& options, const Context& context) {
  refuseUnusedGround(options);
  std::vector<BenchmarkCase> all;
  std::set<std::string> names;
  for (const std::string& name : options.names)
    for (BenchmarkCase& made : casesOf(name, options, context)) {
      // Maps in different folders may have the same name; log files are named after cases.
      std::string unique = made.name;
      for (int k = 2; !names.insert(unique).second; ++k) unique = made.name + " of map " + std::to_string(k);
      made.name = unique;
      all.push_back(std::move(made));
    }
  return all;
}

namespace {

using planner::BenchmarkPlan;
using planner::BenchmarkRun;
using planner::RouteStatus;

constexpr std::size_t kMostPlots = 12;  // limit for a legible page

double median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::ranges::sort(values);
  return (values[(values.size() - 1) / 2] + values[values.size() / 2]) / 2;
}

double largest(const std::vector<double>& values) {
  return values.empty() ? std::numeric_limits<double>::quiet_NaN() : std::ranges::max(values);
}

BenchmarkLine lineOf(const BenchmarkPlan& plan, const std::vector<BenchmarkRun>& runs,
                     const std::string& planner) {
  BenchmarkLine line{.planner = planner};
  std::vector<double> gaps, seconds, clearances;
  int standing = 0;
  for (const BenchmarkRun& run : runs) {
    if (run.planner != planner) continue;
    ++line.runs;
    line.crashed += run.crashed;
    line.breached += run.breached;
    line.worst_megabytes = std::max(line.worst_megabytes, run.megabytes);
    if (run.crashed) continue;
    seconds.push_back(run.seconds);
    if (run.status != RouteStatus::Found) continue;
    ++line.found;
    if (!planner::stands(run)) continue;
    ++standing;
    line.mean_cusps += run.cusps;
    line.max_curvature_1_m = std::max(line.max_curvature_1_m, run.max_curvature_1_m);
    clearances.push_back(-run.clearance_cells);
    gaps.push_back(run.cost_J / planner::bestKnown_J(plan, runs, run.case_index) - 1.0);
  }
  line.median_gap = median(gaps);
  line.worst_gap = largest(gaps);
  line.mean_cusps /= std::max(1, standing);
  line.least_clearance_cells = -largest(clearances);
  line.median_seconds = median(seconds);
  return line;
}

// A column of the comparison: its heading, its key in JSON, and the format of the number times `factor`.
struct LineColumn {
  const char *title, *key;
  std::variant<int BenchmarkLine::*, double BenchmarkLine::*> value;
  const char* format = "{}";
  double factor = 1.0;
};
const LineColumn kColumns[] = {
    {"runs", "runs", &BenchmarkLine::runs},
    {"solved", "found", &BenchmarkLine::found},
    {"invalid", "breached", &BenchmarkLine::breached},
    {"crashed", "crashed", &BenchmarkLine::crashed},
    {"gap p50 %", "median_gap", &BenchmarkLine::median_gap, "{:.2f}", 100.0},
    {"gap max %", "worst_gap", &BenchmarkLine::worst_gap, "{:.2f}", 100.0},
    {"time p50 s", "median_seconds", &BenchmarkLine::median_seconds, "{:.4f}"},
    {"MB max", "worst_megabytes", &BenchmarkLine::worst_megabytes, "{:.0f}"},
    {"cusps", "mean_cusps", &BenchmarkLine::mean_cusps, "{:.2f}"},
    {"curv. 1/m", "max_curvature_1_m", &BenchmarkLine::max_curvature_1_m, "{:.3g}"},
    {"clearance", "least_clearance_cells", &BenchmarkLine::least_clearance_cells, "{:.2f}"}};

// Table rows, beginning with the header.
Table lineRows(const std::vector<BenchmarkLine>& lines) {
  Table rows{{"planner"}};
  for (const LineColumn& column : kColumns) rows.front().emplace_back(column.title);
  for (const BenchmarkLine& line : lines) {
    rows.push_back({line.planner});
    for (const LineColumn& column : kColumns)
      if (const auto* count = std::get_if<int BenchmarkLine::*>(&column.value))
        rows.back().push_back(std::to_string(line.**count));
      else if (const double value = line.*std::get<double BenchmarkLine::*>(column.value);
               std::isfinite(value))
        rows.back().push_back(fmt::format(fmt::runtime(column.format), column.factor * value));
      else
        rows.back().emplace_back("-");
  }
  return rows;
}

// Colour of a planner, which its start with nothing (:cold) shares.
Colour colourOf(const BenchmarkPlan& plan, const std::string& planner) {
  const std::string warm = planner.substr(0, planner.find(":cold"));
  return seriesColour(
      static_cast<std::size_t>(std::ranges::find(plan.planners, warm) - plan.planners.begin()));
}

// How dear and how fast: the medians of each planner.
Plot dearAndFast(const BenchmarkPlan& plan, const std::vector<BenchmarkLine>& lines) {
  Plot plot{.title = "Each planner: how dear, how fast",
            .x = {.label = "median time [s]", .logarithmic = true},
            .y = {.label = "median gap [%]"},
            .series = {}};
  for (const BenchmarkLine& line : lines)
    plot.series.push_back({.name = line.planner,
                           .x = {line.median_seconds},
                           .y = {100.0 * line.median_gap},
                           .mark = Series::Mark::Points,
                           .dashed = line.planner.find(":cold") != std::string::npos,
                           .colour = colourOf(plan, line.planner)});
  return plot;
}

// The fastest planner that solves all of its runs within 1 % of the best known cost in the median.
std::string fastestText(const std::vector<BenchmarkLine>& lines) {
  const BenchmarkLine* fastest = nullptr;
  for (const BenchmarkLine& line : lines)
    if (line.found == line.runs && line.breached == 0 && line.median_gap <= 0.01 &&
        (fastest == nullptr || line.median_seconds < fastest->median_seconds))
      fastest = &line;
  return fastest == nullptr
             ? "No planner solves all runs within 1 % of the best known cost in the median."
             : fmt::format(
                   "Fastest of the planners that solve all runs within 1 % of the best known cost in the "
                   "median: {}, {:.3g} s, gap {:.2f} % (greatest {:.2f} %).",
                   fastest->planner, fastest->median_seconds, 100.0 * fastest->median_gap,
                   100.0 * fastest->worst_gap);
}

Plot gapOverTime(const BenchmarkPlan& plan, const std::vector<BenchmarkRun>& runs, std::size_t case_index) {
  Plot plot{.title = plan.cases[case_index].name,
            .x = {.label = "time [s]", .logarithmic = true},
            .y = {.label = "gap [%]"},
            .series = {}};
  const double best_J = planner::bestKnown_J(plan, runs, case_index);
  constexpr double kSoonest_s = 1e-3;  // a logarithmic axis has no 0
  double end_s = kSoonest_s;
  for (const BenchmarkRun& run : runs)
    if (run.case_index == case_index)
      end_s = std::max(end_s, 1.2 * run.seconds);  // beyond the slowest planner
  for (const BenchmarkRun& run : runs) {
    if (run.case_index != case_index || run.seed != 1 || !planner::stands(run) || run.progress.empty())
      continue;
    Series series{.name = run.planner,
                  .x = {},
                  .y = {},
                  .dashed = run.planner.find(":cold") != std::string::npos,
                  .colour = colourOf(plan, run.planner)};
    for (const auto& at : run.progress) {
      if (!series.x.empty()) {  // step curve: the cost holds until the next improvement
        series.x.push_back(std::max(at.seconds, kSoonest_s));
        series.y.push_back(series.y.back());
      }
      series.x.push_back(std::max(at.seconds, kSoonest_s));
      series.y.push_back(100 * (at.cost_J / best_J - 1.0));
    }
    series.x.push_back(end_s);  // the last cost holds until the end
    series.y.push_back(series.y.back());
    plot.series.push_back(std::move(series));
  }
  return plot;
}

// Groups of worlds in the order of the cases.
std::vector<std::string> groupsOf(const BenchmarkPlan& plan) {
  std::vector<std::string> groups;
  for (const auto& asked : plan.cases)
    if (asked.world && std::ranges::find(groups, asked.group) == groups.end()) groups.push_back(asked.group);
  return groups;
}

// Table rows, beginning with the header.
Table worldRows(const std::vector<WorldLine>& lines) {
  Table rows{{"belief", "planner", "runs", "success %", "95 %", "time p50 s", "slip max p50"}};
  for (const WorldLine& line : lines) {
    const auto rate =
        planner::share(static_cast<std::size_t>(line.reached), static_cast<std::size_t>(line.runs));
    rows.push_back({line.group, line.planner, std::to_string(line.runs),
                    fmt::format("{:.1f}", 100 * rate.value),
                    fmt::format("{:.1f}-{:.1f}", 100 * rate.interval_95[0], 100 * rate.interval_95[1]),
                    std::isfinite(line.median_drive_s) ? fmt::format("{:.0f}", line.median_drive_s) : "-",
                    std::isfinite(line.median_max_slip) ? fmt::format("{:.2f}", line.median_max_slip) : "-"});
  }
  return rows;
}

}  // namespace

std::vector<BenchmarkLine> compared(const BenchmarkPlan& plan, const std::vector<BenchmarkRun>& runs) {
  std::vector<BenchmarkLine> lines;
  for (const std::string& planner : plan.planners) lines.push_back(lineOf(plan, runs, planner));
  return lines;
}

std::vector<WorldLine> drivesOf(const BenchmarkPlan& plan, const std::vector<BenchmarkRun>& runs) {
  std::vector<WorldLine> lines;
  for (const std::string& group : groupsOf(plan))
    for (const std::string& planner : plan.planners) {
      WorldLine line{.group = group, .planner = planner};
      std::vector<double> seconds, slips;
      for (const BenchmarkRun& run : runs) {
        if (run.planner != planner || plan.cases[run.case_index].group != group) continue;
        ++line.runs;
        line.reached += run.reached;
        if (run.reached) seconds.push_back(run.drive_s);
        if (run.status == RouteStatus::Found && !run.crashed) slips.push_back(run.max_slip);
      }
      line.median_drive_s = median(seconds);
      line.median_max_slip = median(slips);
      lines.push_back(std::move(line));
    }
  return lines;
}

nlohmann::ordered_json asJson(const std::vector<BenchmarkLine>& lines, const std::vector<WorldLine>& drives) {
  auto array = nlohmann::ordered_json::array();
  for (const BenchmarkLine& line : lines) {
    array.push_back({{"planner", line.planner}});
    for (const LineColumn& column : kColumns)
      std::visit([&](auto value) { array.back()[column.key] = line.*value; }, column.value);
    for (const WorldLine& drive : drives)
      if (drive.planner == line.planner)
        array.back()["drives"].push_back({{"belief", drive.group},
                                          {"runs", drive.runs},
                                          {"reached", drive.reached},
                                          {"median_drive_s", drive.median_drive_s},
                                          {"median_max_slip", drive.median_max_slip}});
  }
  return array;
}

std::vector<Plot> gapsOverTime(const BenchmarkPlan& plan, const std::vector<BenchmarkRun>& runs) {
  std::vector<Plot> plots;
  for (std::size_t c = 0; c < std::min(plan.cases.size(), kMostPlots); ++c)
    plots.push_back(gapOverTime(plan, runs, c));
  return plots;
}

Report benchReport(const BenchmarkPlan& plan, const std::vector<BenchmarkRun>& runs) {
  Report page("Planner benchmark");
  if (const std::size_t asked = planner::jobsOf(plan).size(); runs.size() < asked)
    page.paragraph(fmt::format("cancelled: {} of {} runs", runs.size(), asked));
  const std::vector<BenchmarkLine> lines = compared(plan, runs);
  page.paragraph(fastestText(lines));
  std::vector<Plot> plots = gapsOverTime(plan, runs);
  plots.insert(plots.begin(), dearAndFast(plan, lines));
  const auto first = plots.begin() + std::min<std::ptrdiff_t>(3, std::ssize(plots));  // one row of a screen
  page.charts({plots.begin(), first});
  page.table(lineRows(lines));
  if (const auto drives = worldRows(drivesOf(plan, runs)); drives.size() > 1) {
    page.heading("Simulated drives over the true slip");
    page.table(drives);
  }
  page.charts({first, plots.end()},
              "The curves are those of the first seed of each planner whose final route passes the check. "
              "Intermediate costs are those that the planner reports; none is drawn below the cost of the "
              "final route.");
  page.paragraph(fmt::format(
      "{} cases, {} runs per case and planner, time limit {} s per run, each run in its own process. Gap: "
      "relative to the known optimum, or to the best of all runs. Invalid: the independent check rejects the "
      "route; its gap, curvature and clearance are not counted. Clearance is in cells. OMPL's planners begin "
      "with the field's "
      "route, those with :cold with nothing.",
      plan.cases.size(), plan.seeds, plan.time_limit_s));
  return page;
}

}  // namespace talus::cli
