#include <algorithm>
#include <cmath>

#include <talus/cli/soil/agreement_plot.hpp>

namespace talus::cli {

Plot agreementPlot(terramech::Channel channel, const Eigen::MatrixXd& measured,
                   const std::vector<NamedPredictions>& predictions) {
  Plot plot{
      .title = name(channel), .x = {.label = "measured [-]"}, .y = {.label = "predicted [-]"}, .series = {}};
  const auto c = static_cast<Eigen::Index>(channel);
  double low = INFINITY, high = -INFINITY;
  for (const auto& [who, predicted] : predictions) {
    Series series{.name = who, .x = {}, .y = {}, .mark = Series::Mark::Points};
    for (Eigen::Index row = 0; row < measured.rows(); ++row) {
      if (!std::isfinite(measured(row, c)) || !std::isfinite(predicted(row, c))) continue;
      series.x.push_back(measured(row, c));
      series.y.push_back(predicted(row, c));
      low = std::min(low, measured(row, c));
      high = std::max(high, measured(row, c));
    }
    plot.series.push_back(std::move(series));
  }
  if (low <= high)
    plot.series.push_back(
        {.name = "", .x = {low, high}, .y = {low, high}, .dashed = true, .colour = rgb(0x666666)});
  return plot;
}

}  // namespace talus::cli
