#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <talus/cli/soil/channel_report.hpp>

namespace talus::cli {

nlohmann::ordered_json errorsJson(const terramech::ChannelErrors& errors) {
  nlohmann::ordered_json out = nlohmann::ordered_json::object();
  for (terramech::Channel c : terramech::kAllChannels)
    if (const double e = errors[static_cast<std::size_t>(c)]; std::isfinite(e)) out[name(c)] = e;
  return out;
}

std::string changeText(const terramech::ChannelErrors& base, const terramech::ChannelErrors& refined) {
  std::string text;
  for (terramech::Channel c : terramech::kAllChannels)
    if (const auto k = static_cast<std::size_t>(c); std::isfinite(base[k]))
      text += fmt::format(" {} {:.4f} -> {:.4f}", name(c), base[k], refined[k]);
  return text;
}

Plot overSlip(terramech::Channel channel, const terramech::Trial& trial,
              const std::vector<NamedPredictions>& predictions) {
  Plot plot{.title = std::string(name(channel)) + " over slip",
            .x = {.label = "slip [-]"},
            .y = {.label = std::string(name(channel)) + " [-]"},
            .series = {}};
  const auto c = static_cast<Eigen::Index>(channel);
  const auto add = [&](const std::string& who, const Eigen::MatrixXd& values) {
    Series series{.name = who, .x = {}, .y = {}, .mark = Series::Mark::Points};
    for (Eigen::Index row = 0; row < values.rows(); ++row) {
      const double slip = trial.slip[static_cast<std::size_t>(row)];
      if (!std::isfinite(slip + trial.measured(row, c) + values(row, c))) continue;
      series.x.push_back(slip);
      series.y.push_back(values(row, c));
    }
    plot.series.push_back(std::move(series));
  };
  add("measured", trial.measured);
  for (const auto& [who, predicted] : predictions) add(who, predicted);
  return plot;
}

nlohmann::ordered_json searchedJson(const terramech::TraceResult& r) {
  return {{"rows", r.trial.rows()},
          {"rows_not_searched", r.unsearched.rows},
          {"base_rmse_there", errorsJson(r.unsearched.base_rmse)},
          {"refined_rmse_there", errorsJson(r.unsearched.refined_rmse)},
          {"columns_dropped", r.trial.dropped}};
}

std::string searchedText(const terramech::TraceResult& result) {
  std::string text;
  if (const terramech::UnsearchedRows& rest = result.unsearched; rest.rows > 0) {
    text += fmt::format("searched a sample of {} of {} rows; rmse on the {} others (base -> refined):{}\n",
                        result.trial.rows(), result.trial.rows() + rest.rows, rest.rows,
                        changeText(rest.base_rmse, rest.refined_rmse));
  }
  if (const auto& dropped = result.trial.dropped; !dropped.empty()) {
    constexpr std::size_t kShown = 5;
    text += fmt::format(
        "{} further columns not searched, those least related to the residuals: {}{}\n", dropped.size(),
        fmt::join(dropped.begin(), dropped.begin() + static_cast<long>(std::min(kShown, dropped.size())),
                  ", "),
        dropped.size() > kShown ? ", ... (--json lists them)" : "");
  }
  return text;
}

}  // namespace talus::cli
