#include <array>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <talus/cli/app/campaign.hpp>
#include <talus/cli/app/context.hpp>
#include <talus/cli/route/plan_pairs.hpp>
#include <talus/common/input_error.hpp>
#include <talus/planner/route/route_json.hpp>
#include <talus/terramech/io/csv_reader.hpp>

namespace talus::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array kColumns{"start_x_m", "start_y_m",         "goal_x_m",
                              "goal_y_m",  "start_heading_rad", "goal_heading_rad"};
constexpr std::size_t kNeeded = 4;
constexpr double kGreatestPlace_m = 1e9;  // as in telemetry; beyond any map, and any heading

// Returns the index of each column in the file; empty for a missing heading column.
std::array<std::optional<std::size_t>, kColumns.size()> columnsOf(const std::string& path,
                                                                  const std::vector<std::string>& header) {
  std::array<std::optional<std::size_t>, kColumns.size()> found;
  for (std::size_t i = 0; i < header.size(); ++i)
    for (std::size_t k = 0; k < kColumns.size(); ++k)
      if (header[i] == kColumns[k]) found[k] = i;
  for (std::size_t k = 0; k < kNeeded; ++k)
    if (!found[k])
      throw InputError({path + ":1", fmt::format("has no column {}", kColumns[k]),
                        "give start_x_m, start_y_m, goal_x_m, goal_y_m"});
  return found;
}

Json planned(const PlacePair& pair, const PairedRequest& common, planner::RoutePlanner& planner) {
  PlanRequest request = common.request;
  request.watch.progress = {};
  request.start = pair.start;
  request.goal = pair.goal;
  const bool headings = planner.capabilities().headings;
  if (headings && pair.start_heading_rad) request.start_heading_rad = pair.start_heading_rad;
  if (headings && pair.goal_heading_rad) request.goal_heading_rad = pair.goal_heading_rad;
  const planner::Route route = planner.plan(common.map, request, common.settings);
  Json line = summaryJson(route);
  if (route.status != planner::RouteStatus::Found) line["reason"] = route.reason;
  return line;
}

std::string cell(const Json& line, const char* key) {
  const auto value = line.find(key);
  if (value == line.end() || value->is_null()) return {};
  return value->is_string() ? terramech::csvField(value->get<std::string>()) : jsonText(*value);
}

}  // namespace

std::vector<PlacePair> readPairs(const std::string& path) {
  terramech::CsvReader reader(path);
  const auto columns = columnsOf(path, reader.header());
  std::vector<PlacePair> pairs;
  terramech::CsvRow row;
  while (reader.next(row)) {
    const std::string where = fmt::format("{}:{}", path, row.line);
    if (!row.fault.empty()) throw InputError({where, row.fault, "fix the line"});
    std::array<std::optional<double>, kColumns.size()> values;
    for (std::size_t k = 0; k < kColumns.size(); ++k) {
      double value = 0.0;
      const std::string field = columns[k] ? row.fields[*columns[k]] : "";
      if (field.empty() && k >= kNeeded) continue;
      if (!terramech::parseNumber(field, value) || !std::isfinite(value))
        throw InputError(
            {where, fmt::format("{} = '{}' is not a finite number", kColumns[k], field), "fix the line"});
      if (std::abs(value) > kGreatestPlace_m)
        throw InputError(
            {where, fmt::format("{} = {:g}, must be within {:g} of 0", kColumns[k], value, kGreatestPlace_m),
             "give metres and radians"});
      values[k] = value;
    }
    pairs.push_back({{*values[0], *values[1]}, {*values[2], *values[3]}, values[4], values[5]});
  }
  if (pairs.empty()) throw InputError({path, "contains no pair", "add one line per start and goal"});
  return pairs;
}

std::vector<Json> planPairs(const std::vector<PlacePair>& pairs, const PairedRequest& common,
                            planner::RoutePlanner& planner, const Campaign& campaign, const Part& part) {
  const std::vector<std::size_t> own = part.of(pairs.size());
  const auto outcomes = campaign.run(
      own.size(), [&](std::size_t i) { return jsonText(planned(pairs[own[i]], common, planner)); },
      common.request.watch);
  std::vector<Json> lines;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    Json line{{"pair", own[i] + 1}};
    if (outcomes[i].failed)
      line.update(Json{{"status", "failed"}, {"reason", outcomes[i].text}});
    else
      line.update(Json::parse(outcomes[i].text));
    lines.push_back(std::move(line));
  }
  return lines;
}

std::string pairsCsv(const std::vector<Json>& lines) {
  constexpr std::array keys{"pair",          "status",      "planner",  "cost",
                            "energy_J",      "time_s",      "length_m", "max_slip",
                            "max_slope_rad", "lower_bound", "gap",      "immobilisation_risk",
                            "reason"};
  std::string text;
  for (const char* key : keys) text += (text.empty() ? "" : ",") + std::string(key);
  text += "\n";
  for (const Json& line : lines) {
    std::string row;
    for (const char* key : keys) row += (key == keys[0] ? "" : ",") + cell(line, key);
    text += row + "\n";
  }
  return text;
}

}  // namespace talus::cli
