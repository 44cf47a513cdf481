#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <talus/cli/app/output_file.hpp>
#include <talus/cli/draw/html_report.hpp>
#include <talus/cli/draw/pareto_chart.hpp>
#include <talus/cli/draw/plot.hpp>

namespace talus::cli {
namespace {

std::vector<Plot> charts(const std::vector<planner::ParetoRoute>& front) {
  Series risk{.name = {}, .x = {}, .y = {}, .y_std = {}, .mark = Series::Mark::Points};
  Series time = risk;
  for (const planner::ParetoRoute& route : front) {
    const double above_least = 100 * (route.demand.energy_J / front.front().demand.energy_J - 1.0);
    risk.x.push_back(above_least);
    risk.y.push_back(100 * route.demand.risk);
    time.x.push_back(above_least);
    time.y.push_back(route.demand.time_s / 3600);
  }
  return {{.title = "Energy and risk",
           .x = {"energy above the minimum [%]"},
           .y = {"immobilisation probability [%]"},
           .series = {risk}},
          {.title = "Energy and time",
           .x = {"energy above the minimum [%]"},
           .y = {"time [h]"},
           .series = {time}}};
}

}  // namespace

void saveParetoChart(const std::string& path, const std::vector<planner::ParetoRoute>& front) {
  if (!isNamed(path, ".html")) return save(path, charts(front));
  HtmlReport page("Energy, time and risk");
  std::vector<std::vector<std::string>> rows;
  rows.reserve(front.size());
  for (const planner::ParetoRoute& route : front)
    rows.push_back({fmt::format("{:.1f}", route.demand.energy_J / 1e3),
                    fmt::format("{:.2f}", route.demand.time_s / 3600),
                    fmt::format("{:.4f}", 100 * route.demand.risk)});
  page.paragraph("The Pareto set: no other route is better in energy, time and risk at once.");
  page.table({"energy [kJ]", "time [h]", "immobilisation probability [%]"}, rows);
  page.charts(charts(front));
  writeFile(path, page.html());
}

nlohmann::ordered_json paretoJson(const std::vector<planner::ParetoRoute>& front) {
  auto array = nlohmann::ordered_json::array();
  for (const planner::ParetoRoute& route : front)
    array.push_back({{"energy_J", route.demand.energy_J},
                     {"time_s", route.demand.time_s},
                     {"risk", route.demand.risk},
                     {"time_weight_W", route.weights.time_W},
                     {"risk_weight_J", route.weights.risk_J}});
  return array;
}

}  // namespace talus::cli
