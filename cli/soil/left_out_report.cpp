#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <talus/cli/draw/html_report.hpp>
#include <talus/cli/soil/channel_report.hpp>
#include <talus/cli/soil/left_out_report.hpp>

namespace talus::cli {
namespace {

using namespace terramech;

/// Channels in which the refined model has larger errors than the base.
nlohmann::ordered_json worse(const LeftOutErrors& part) {
  auto out = nlohmann::ordered_json::array();
  for (Channel c : kAllChannels)
    if (const auto k = static_cast<std::size_t>(c); part.refined[k] > part.base[k]) out.push_back(name(c));
  return out;
}

bool measures(const std::vector<LeftOutErrors>& all, Channel channel) {
  return std::any_of(all.begin(), all.end(), [&](const LeftOutErrors& part) {
    return std::isfinite(part.base[static_cast<std::size_t>(channel)]);
  });
}

void table(HtmlReport& page, const std::vector<LeftOutErrors>& all) {
  page.heading("Effects found without these rows, and errors on them");
  std::vector<std::vector<std::string>> found, rows;
  for (const LeftOutErrors& part : all) {
    found.push_back({part.what, fmt::format("{}", part.rows),
                     part.effects.empty() ? "none" : fmt::format("{}", fmt::join(part.effects, ", "))});
    for (Channel c : kAllChannels) {
      const auto k = static_cast<std::size_t>(c);
      if (!std::isfinite(part.base[k])) continue;
      rows.push_back({part.what, name(c), fmt::format("{:.4f}", part.base[k]),
                      fmt::format("{:.4f}", part.refined[k]), fmt::format("{:.4f}", part.floor[k]),
                      fmt::format("{:.4f}", part.regression[k]),
                      part.refined[k] > part.base[k] ? "worse than base" : ""});
    }
  }
  page.table({"held out", "rows", "effects (column)"}, found);
  page.paragraph(
      "Root mean square errors. The noise floor is the error from sensor noise alone, the regression one of "
      "the "
      "columns and their squares, which knows no wheel.");
  page.table({"held out", "channel", "base", "refined", "noise floor", "regression", ""}, rows);
}

/// Plots values against the held-out column, or against the row index if the column contains text.
Plot overColumn(const std::vector<LeftOutErrors>& all, const std::string& column, Channel channel) {
  Series base{.name = "base", .x = {}, .y = {}, .mark = Series::Mark::Points}, refined = base,
                                                                               measured = base;
  refined.name = "refined";
  measured.name = "measured";
  const auto c = static_cast<Eigen::Index>(channel);
  double count = 0.0;
  bool words = false;
  for (const LeftOutErrors& part : all) {
    for (int row = 0; row < part.trial.rows(); ++row) {
      if (!std::isfinite(part.trial.measured(row, c))) continue;
      const double value = part.trial.states[static_cast<std::size_t>(row)].covariate(column);
      words |= !std::isfinite(value);
      const double x = std::isfinite(value) ? value : ++count;
      for (Series* series : {&base, &refined, &measured}) series->x.push_back(x);
      base.y.push_back(part.base_predicted(row, c));
      refined.y.push_back(part.predicted(row, c));
      measured.y.push_back(part.trial.measured(row, c));
    }
  }
  return {.title = fmt::format("{} over {}", name(channel), column),
          .x = {.label = words ? "row" : column},
          .y = {.label = std::string(name(channel)) + " [-]"},
          .series = {base, refined, measured}};
}

}  // namespace

std::string leftOutText(const std::vector<LeftOutErrors>& all) {
  std::string out;
  for (const LeftOutErrors& part : all) {
    out += fmt::format("traced without {} ({} rows): {}\n  {:26s} {:>10s} {:>10s} {:>12s} {:>12s}\n",
                       part.what, part.rows,
                       part.effects.empty() ? "no effect" : fmt::format("{}", fmt::join(part.effects, ", ")),
                       "rmse", "base", "refined", "noise floor", "regression");
    for (Channel c : kAllChannels) {
      const auto k = static_cast<std::size_t>(c);
      if (!std::isfinite(part.base[k])) continue;
      out += fmt::format("  {:26s} {:10.4f} {:10.4f} {:12.4f} {:12.4f}{}\n", name(c), part.base[k],
                         part.refined[k], part.floor[k], part.regression[k],
                         part.refined[k] > part.base[k] ? "  refined is worse than base" : "");
    }
  }
  return out;
}

nlohmann::ordered_json leftOutJson(const std::vector<LeftOutErrors>& all) {
  auto out = nlohmann::ordered_json::array();
  for (const LeftOutErrors& part : all)
    out.push_back({{"left_out", part.what},
                   {"rows", part.rows},
                   {"effects", part.effects},
                   {"base_rmse", errorsJson(part.base)},
                   {"refined_rmse", errorsJson(part.refined)},
                   {"worse_than_base", worse(part)},
                   {"noise_floor", errorsJson(part.floor)},
                   {"regression_rmse", errorsJson(part.regression)}});
  return out;
}

std::string leftOutPage(const std::vector<LeftOutErrors>& all, const std::string& request,
                        const std::string& source) {
  HtmlReport page("Held out of " + source + ": " + request);
  std::vector<Plot> plots;
  for (Channel c : kAllChannels)
    if (measures(all, c)) plots.push_back(overColumn(all, request.substr(0, request.find('=')), c));
  page.charts(plots);
  table(page, all);
  return page.html();
}

}  // namespace talus::cli
