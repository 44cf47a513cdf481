#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

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

}  // namespace talus::cli
