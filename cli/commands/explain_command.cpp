// talus explain DEM --at P [--heading RAD]: explains the category and cost of a cell.
#include <cmath>
#include <optional>

#include <talus/cli/app/command.hpp>
#include <talus/cli/ground/mission.hpp>
#include <talus/costmap/costmap.hpp>
#include <talus/maps/maps_io.hpp>

namespace talus::cli {
namespace {

struct ExplainOptions {
  GroundOptions ground;
  std::string at;
  std::optional<double> heading_rad;
  bool next = false;
};

void bind(CLI::App& command, ExplainOptions& options) {
  addGroundOptions(command, options.ground);
  addOption(command, "--at P", options.at)->required();
  addHeading(command, "--heading", options.heading_rad);
  command.add_flag("--next", options.next);
}

nlohmann::ordered_json explainJson(const costmap::Explanation& why, const maps::Point& point,
                                   const maps::Cell& cell) {
  const auto causes = jsonList(why.causes, [](const costmap::Cause& cause) -> nlohmann::ordered_json {
    return {{"name", cause.name},
            {"value", cause.value},
            {"std", cause.std},
            {"source", cause.source},
            {"remark", cause.remark}};
  });
  return {{"category", terramech::name(why.category)},
          {"probability", why.probability},
          {"verdict", why.verdict},
          {"x_m", point.x_m},
          {"y_m", point.y_m},
          {"column", cell.column},
          {"row", cell.row},
          {"causes", causes}};
}

std::string explainText(const costmap::Explanation& why, const std::string& place) {
  const std::string sure =
      std::isnan(why.probability) ? "" : fmt::format(" (probability {:.2f})", why.probability);
  std::string text = fmt::format("{}\n{}{}\n", place, why.verdict, sure);
  for (const costmap::Cause& cause : why.causes) {
    const std::string std = std::isnan(cause.std) ? "" : fmt::format(" +- {:.3g}", cause.std);
    const std::string value = std::isnan(cause.value) ? "not known" : fmt::format("{:.5g}", cause.value);
    text += fmt::format("  {:<28} {:>12}{:<12} {}{}{}\n", cause.name, value, std, cause.source,
                        cause.remark.empty() ? "" : "; ", cause.remark);
  }
  return text;
}

// Adds the place to drive to next to the JSON `out`, or null; returns it as text.
std::string addNext(const costmap::TraversabilityMap& map, const maps::Cell& cell,
                    nlohmann::ordered_json& out) {
  const auto next = costmap::nextDrive(map, cell);
  out["next"] = nullptr;
  if (!next) return "next drive: none nearby tells about ground that is not safe\n";
  const maps::Point at = map.grid().centre(next->cell);
  const double turn = std::atan2(next->heading.y, next->heading.x);
  out["next"] = {{"x_m", at.x_m},
                 {"y_m", at.y_m},
                 {"heading_rad", turn},
                 {"std", next->std},
                 {"expected_std", next->after}};
  return fmt::format(
      "next drive: {:.2f},{:.2f}, heading {:.2f} rad: DP/W of {} blocks nearby that are not safe +- {:.3f}, "
      "expected +- {:.3f}\n",
      at.x_m, at.y_m, turn, next->cells, next->std, next->after);
}

int run(ExplainOptions& options, Context& context) {
  readMission(options.ground);
  const Ground site = readGround(options.ground, context);
  if (context.stop.stop_requested()) return Exit::kCancelled;
  const maps::Point point = maps::readPlace(options.at, site.map.elevation(), "--at");
  const maps::Cell cell = *site.map.grid().cellAt(point);
  std::optional<costmap::Direction> heading;
  if (options.heading_rad) heading = {std::cos(*options.heading_rad), std::sin(*options.heading_rad)};
  const costmap::Explanation why = costmap::explain(site.map, cell, heading);
  nlohmann::ordered_json out = explainJson(why, point, cell);
  const std::string next = options.next ? addNext(site.map, cell, out) : "";
  context.answer(out, explainText(why, maps::describe(point, site.map.elevation())) + next);
  return Exit::kDone;
}

}  // namespace

void addExplain(CLI::App& app, Context& context) {
  addCommand<ExplainOptions>(app, context, "explain", bind, run);
}

}  // namespace talus::cli
