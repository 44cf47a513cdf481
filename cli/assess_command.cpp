#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cli/command.hpp>
#include <cli/commands.hpp>
#include <cli/html_report.hpp>
#include <cli/output_file.hpp>
#include <cli/wheel_rows.hpp>
#include <terramech/category.hpp>
#include <terramech/category_probability.hpp>
#include <terramech/drawbar_pull.hpp>

namespace talus::cli {
namespace {

using namespace terramech;
using Json = nlohmann::ordered_json;

constexpr double kDegree = std::numbers::pi / 180.0;

struct AssessOptions {
  std::string table, formula = "single-force", rover, html;
  double slope_rad = 10.0 * kDegree;  // thesis Fig. 3.12
  double margin_rad = 0.0;
  double z_threshold = 0.5;
  double z_critical = 0.75;
  double noise = 0.05;
};

// What a row comes to.
struct Assessment {
  std::size_t line = 0;
  Uncertain pull;  // DP/W
  double sinkage_over_radius = 0.0;
  double torque_over_load_radius = 0.0;
  Category category = Category::Unknown;
  CategoryProbability probability{};
};

void bind(CLI::App& command, AssessOptions& options) {
  command.add_option("table", options.table, "wheel telemetry")->required()->type_name("T.csv");
  command.add_option("--slope", options.slope_rad, "slope that must be climbed")
      ->type_name("RAD")
      ->capture_default_str();
  command.add_option("--margin", options.margin_rad, "doubt of the slope, either way")
      ->type_name("RAD")
      ->capture_default_str();
  command.add_option("--z-threshold", options.z_threshold, "z/r from which a rank is lost")
      ->capture_default_str();
  command.add_option("--z-critical", options.z_critical, "z/r above which ground is dangerous")
      ->capture_default_str();
  command
      .add_option("--formula", options.formula, "drawbar pull from W, T, z (thesis 3.6, 3.12, 3.21, or ours)")
      ->check(CLI::IsMember({"single-force", "small-angle", "triangular", "plane"}))
      ->capture_default_str();
  command.add_option("--rover", options.rover, "whose wheel, where the file does not say")
      ->type_name("NAME|FILE");
  command.add_option("--noise", options.noise, "relative error of each reading")
      ->check(CLI::Range(0.0, 0.5))
      ->capture_default_str();
  command.add_option("--html", options.html, "a page with the traversability map")->type_name("R.html");
}

// Each formula with the scatter that it has over thesis Table 2.1 (talus reproduce --goals), and the
// readings' errors.
Uncertain pullBy(const std::string& formula, const WheelRows& rows, const WheelSample& s,
                 const ReadingErrors& errors) {
  const Uncertain ours = pullOverLoad(rows.wheel, s, errors);
  if (formula == "small-angle") return {pullAtSmallAngle(rows.wheel, s), std::hypot(ours.std, 0.013)};
  if (formula == "triangular") return {pullOfTriangularStress(rows.wheel, s), std::hypot(ours.std, 0.014)};
  if (formula == "plane") return {kThesisPlane.at(rows.wheel, s), std::hypot(ours.std, 0.028)};
  return ours;
}

std::vector<Assessment> assess(const AssessOptions& options, const WheelRows& rows,
                               const CategoryThresholds& limits) {
  const ReadingErrors errors = ReadingErrors::relative(options.noise);
  std::vector<Assessment> result;
  for (std::size_t k = 0; k < rows.samples.size(); ++k) {
    const WheelSample& s = rows.samples[k];
    Assessment a;
    a.line = rows.lines[k];
    a.pull = pullBy(options.formula, rows, s, errors);
    a.sinkage_over_radius = s.sinkage_m / rows.wheel.radius_m;
    a.torque_over_load_radius = torqueOverLoadRadius(rows.wheel, s);
    a.category = categorise(
        {.drawbar_pull_over_load = a.pull.value, .sinkage_over_radius = a.sinkage_over_radius}, limits);
    a.probability = categoryProbability(
        {.mean = {.drawbar_pull_over_load = a.pull.value, .sinkage_over_radius = a.sinkage_over_radius},
         .drawbar_pull_over_load_std = a.pull.std,
         .sinkage_over_radius_std = errors.sinkage.std(a.sinkage_over_radius)},
        limits);
    result.push_back(a);
  }
  return result;
}

Json jsonOf(const std::vector<Assessment>& rows) {
  Json list = Json::array();
  for (const Assessment& a : rows) {
    const Uncertain slope = climbableSlope_rad(a.pull);
    list.push_back(
        {{"row", a.line - 1},
         {"line", a.line},
         {"drawbar_pull_over_load", a.pull.value},
         {"std", a.pull.std},
         {"sinkage_over_radius", a.sinkage_over_radius},
         {"torque_over_load_radius", a.torque_over_load_radius},
         {"category", name(a.category)},
         {"probability",
          {{"safe", a.probability[0]}, {"marginal", a.probability[1]}, {"dangerous", a.probability[2]}}},
         {"climbable_slope_rad", slope.value},
         {"climbable_slope_std_rad", slope.std}});
  }
  return list;
}

std::string textOf(const std::vector<Assessment>& rows) {
  std::string text =
      "  line     DP/W      +-     z/r   T/rW  climbs deg  category   (safe marginal dangerous)\n";
  for (const Assessment& a : rows) {
    text += fmt::format("{:6}  {:7.3f}  {:6.3f}  {:6.3f} {:6.3f}  {:10.1f}  {:9}  ({:.2f} {:.2f} {:.2f})\n",
                        a.line, a.pull.value, a.pull.std, a.sinkage_over_radius, a.torque_over_load_radius,
                        std::atan(a.pull.value) / kDegree, name(a.category), a.probability[0],
                        a.probability[1], a.probability[2]);
  }
  return text;
}

// The plane of thesis Figs. 3.10 to 3.12: where each row stands in it.
Plot mapOf(const std::vector<Assessment>& rows) {
  Plot plot{
      .title = "Traversability map", .x = {.label = "T/(rW) [-]"}, .y = {.label = "z/r [-]"}, .series = {}};
  constexpr std::array kColours{rgb(0x2e9e4f), rgb(0xe0a020), rgb(0xc83030)};
  for (const Category c : {Category::Safe, Category::Marginal, Category::Dangerous}) {
    Series cloud{.name = name(c),
                 .x = {},
                 .y = {},
                 .mark = Series::Mark::Points,
                 .colour = kColours[static_cast<std::size_t>(c)]};
    for (const Assessment& a : rows) {
      if (a.category != c) continue;
      cloud.x.push_back(a.torque_over_load_radius);
      cloud.y.push_back(a.sinkage_over_radius);
    }
    if (!cloud.x.empty()) plot.series.push_back(cloud);
  }
  return plot;
}

void writePage(const AssessOptions& options, const std::vector<Assessment>& rows) {
  HtmlReport page("Traversability of " + options.table);
  page.paragraph(fmt::format(
      "Slope to climb {:.1f} +- {:.1f} deg; z/r below {:.2f} keeps the rank, above {:.2f} is dangerous.",
      options.slope_rad / kDegree, options.margin_rad / kDegree, options.z_threshold, options.z_critical));
  page.charts({mapOf(rows)});
  std::vector<std::vector<std::string>> cells;
  for (const Assessment& a : rows) {
    cells.push_back({fmt::format("{}", a.line), fmt::format("{:.3f}", a.pull.value),
                     fmt::format("{:.3f}", a.pull.std), fmt::format("{:.3f}", a.sinkage_over_radius),
                     name(a.category)});
  }
  page.table({"line", "DP/W", "std", "z/r", "category"}, cells);
  writeFile(options.html, page.html());
}

int run(const AssessOptions& options, Context& context) {
  CategoryThresholds limits = thresholds({.slope_rad = options.slope_rad, .margin_rad = options.margin_rad});
  limits.z_threshold = options.z_threshold;
  limits.z_critical = options.z_critical;
  validate(limits);
  const WheelRows rows =
      readWheelRows(options.table, {.rover = options.rover, .needs_slip = false}, context.watch("reading"));
  if (!rows.rejected.empty()) {
    context.warn(fmt::format("{}:{}: {} ({} rows rejected)", rows.source, rows.rejected.front().line,
                             rows.rejected.front().reason, rows.rejected.size()));
  }
  const std::vector<Assessment> assessed = assess(options, rows, limits);
  if (!options.html.empty()) writePage(options, assessed);
  if (context.json) {
    printJson(jsonOf(assessed));
  } else {
    print(textOf(assessed));
  }
  return Exit::kDone;
}

}  // namespace

void addAssess(CLI::App& app, Context& context) {
  addCommand<AssessOptions>(
      app, context,
      {.name = "assess",
       .group = Group::kSoil,
       .description = "drawbar pull and traversability category of each row of telemetry",
       .examples = "  talus assess drive.csv --slope 0.26 --margin 0.087\n"},
      bind, run);
}

}  // namespace talus::cli
