#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <talus/cli/soil/channel_report.hpp>
#include <talus/cli/soil/searched_report.hpp>

namespace talus::cli {
namespace {

using namespace terramech;

}  // namespace

nlohmann::ordered_json searchedJson(const TraceResult& r) {
  return {{"rows", r.trial.rows()},
          {"rows_not_searched", r.unsearched.rows},
          {"base_rmse_there", errorsJson(r.unsearched.base_rmse)},
          {"refined_rmse_there", errorsJson(r.unsearched.refined_rmse)},
          {"columns_dropped", r.trial.dropped}};
}

std::string searchedText(const TraceResult& result) {
  std::string text;
  if (const UnsearchedRows& rest = result.unsearched; rest.rows > 0) {
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
