#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <talus/cli/soil/proposal_report.hpp>
#include <talus/terramech/calibration/table/trial.hpp>
#include <talus/terramech/io/csv_reader.hpp>

namespace talus::cli {
namespace {

using namespace terramech;
using nlohmann::ordered_json;

std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.9g}", value) : "";
}

std::string headerOf(const ProposedRun& run, const TraceResult& result) {
  std::string header = "run,slip";
  for (const auto& [column, value] : run.columns) header += ',' + csvField(column);
  for (const auto& [column, text] : run.groups) header += ',' + csvField(column);
  for (const Channel c : kAllChannels)
    if (result.trial.has(c)) header += std::string(",") + kAnswers[static_cast<std::size_t>(c)];
  for (std::size_t k = 1; k <= run.predictions.size(); ++k) {
    header += fmt::format(",predicted_{}_cause", k);
    for (const Channel c : kAllChannels)
      if (result.trial.has(c))
        header +=
            fmt::format(",predicted_{0}_{1},predicted_{0}_{1}_std", k, kAnswers[static_cast<std::size_t>(c)]);
  }
  return header + '\n';
}

}  // namespace

std::string proposalTable(const std::vector<ProposedRun>& runs, const TraceResult& result) {
  if (runs.empty()) return "";
  std::string text = headerOf(runs.front(), result);
  for (std::size_t k = 0; k < runs.size(); ++k)
    for (std::size_t row = 0; row < runs[k].slip.size(); ++row) {
      text += fmt::format("proposed {},{}", k + 1, number(runs[k].slip[row]));
      for (const auto& [column, value] : runs[k].columns) text += ',' + number(value);
      for (const auto& [column, word] : runs[k].groups) text += ',' + csvField(word);
      for (const Channel c : kAllChannels)
        if (result.trial.has(c)) text += ',';
      for (const RunPrediction& p : runs[k].row_predictions[row]) {
        text += ',' + csvField(p.cause);
        for (const Channel c : kAllChannels)
          if (const auto at = static_cast<std::size_t>(c); result.trial.has(c))
            text += ',' + number(p.mean[at]) + ',' + number(p.std[at]);
      }
      text += '\n';
    }
  return text;
}

ordered_json proposalsJson(const std::vector<ProposedRun>& runs) {
  ordered_json all = ordered_json::array();
  for (const ProposedRun& run : runs) {
    ordered_json columns{{"slip", run.slip}};
    for (const auto& [column, value] : run.columns) columns[column] = value;
    for (const auto& [column, text] : run.groups) columns[column] = text;
    ordered_json predictions = ordered_json::array();
    for (const RunPrediction& p : run.predictions) {
      ordered_json one{{"cause", p.cause}};
      for (std::size_t c = 0; c < kChannels; ++c) {
        if (!std::isfinite(p.mean[c])) continue;
        one[kAnswers[c]] = p.mean[c];
        one[c == 0 ? "std" : std::string(kAnswers[c]) + "_std"] = p.std[c];
      }
      predictions.push_back(one);
    }
    all.push_back({{"columns", columns}, {"predictions", predictions}});
  }
  return all;
}

ordered_json scoresJson(const std::vector<CauseScore>& scores) {
  ordered_json all = ordered_json::array();
  for (const CauseScore& s : scores)
    all.push_back({{"cause", s.cause}, {"log_likelihood", s.log_likelihood}, {"probability", s.probability}});
  return all;
}

std::string proposalText(const std::vector<ProposedRun>& runs, const Trial& trial) {
  if (runs.empty()) return "no run is proposed: no second cause gains anything\n";
  std::string text;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    text += fmt::format("proposed run {}: slip {:.3g} to {:.3g}", k + 1, runs[k].slip.front(),
                        runs[k].slip.back());
    for (const auto& [column, value] : runs[k].columns)
      if (std::find(trial.covariates.begin(), trial.covariates.end(), column) != trial.covariates.end())
        text += fmt::format(", {} {:.4g}", column, value);
    for (const auto& [column, word] : runs[k].groups) text += fmt::format(", {} {}", column, word);
    text += '\n';
    for (const RunPrediction& p : runs[k].predictions) {
      text += "  " + p.cause + ':';
      for (std::size_t c = 0; c < kChannels; ++c)
        if (std::isfinite(p.mean[c]))
          text += fmt::format(" {} {:.4g} +- {:.2g}", kAnswers[c], p.mean[c], p.std[c]);
      text += '\n';
    }
  }
  return text;
}

std::string causeScoreText(const std::vector<CauseScore>& scores) {
  std::string text;
  for (const CauseScore& s : scores)
    text += fmt::format("{}: log-likelihood {:.1f} of the measured runs, probability {:.3g}\n", s.cause,
                        s.log_likelihood, s.probability);
  return text;
}

}  // namespace talus::cli
