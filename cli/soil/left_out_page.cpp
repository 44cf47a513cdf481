#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <talus/cli/draw/html_report.hpp>
#include <talus/cli/soil/left_out_report.hpp>

namespace talus::cli {
namespace {

using namespace terramech;

bool measures(const std::vector<LeftOutErrors>& all, Channel channel) {
  return std::any_of(all.begin(), all.end(), [&](const LeftOutErrors& part) {
    return std::isfinite(part.base[static_cast<std::size_t>(channel)]);
  });
}

/// Root mean square error over the rows of all held-out parts.
double pooled(const std::vector<LeftOutErrors>& all, ChannelErrors LeftOutErrors::*errors, Channel channel) {
  const auto k = static_cast<std::size_t>(channel);
  double sum = 0.0, rows = 0.0;
  for (const LeftOutErrors& part : all) {
    if (!std::isfinite((part.*errors)[k])) continue;
    sum += part.rows * std::pow((part.*errors)[k], 2);
    rows += part.rows;
  }
  return std::sqrt(sum / rows);
}

void verdict(HtmlReport& page, const std::vector<LeftOutErrors>& all) {
  for (Channel c : kAllChannels) {
    if (!measures(all, c)) continue;
    const double before = pooled(all, &LeftOutErrors::base, c),
                 after = pooled(all, &LeftOutErrors::refined, c);
    page.paragraph(fmt::format("{}: error on rows that the search did not see {:.4f} before, {:.4f} after{}.",
                               name(c), before, after, after > before ? ": worse than the base" : ""));
  }
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

/// Plots predicted against measured values; on the dashed line both are equal.
Plot againstMeasured(const std::vector<LeftOutErrors>& all, Channel channel) {
  const Plot over = overColumn(all, "slip", channel);
  Series base = over.series[0], refined = over.series[1];
  base.x = refined.x = over.series[2].y;
  const auto [low, high] = std::minmax_element(base.x.begin(), base.x.end());
  const Series line{.name = "", .x = {*low, *high}, .y = {*low, *high}, .dashed = true};
  return {.title = fmt::format("{}, predicted over measured", name(channel)),
          .x = {.label = "measured [-]"},
          .y = {.label = "predicted [-]"},
          .series = {base, refined, line}};
}

}  // namespace

std::string leftOutPage(const std::vector<LeftOutErrors>& all, const std::string& request,
                        const std::string& source) {
  HtmlReport page("Held out of " + source + ": " + request);
  verdict(page, all);
  std::vector<Plot> plots;
  for (Channel c : kAllChannels) {
    if (!measures(all, c)) continue;
    plots.push_back(overColumn(all, request.substr(0, request.find('=')), c));
    plots.push_back(againstMeasured(all, c));
  }
  page.charts(plots);
  table(page, all);
  return page.html();
}

}  // namespace talus::cli
