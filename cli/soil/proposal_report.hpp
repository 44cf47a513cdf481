#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <talus/terramech/calibration/trace/run_proposal.hpp>

namespace talus::cli {

/// A table of proposed runs: a row each slip with the conditions, empty columns for what the result measures, and of each
/// cause its name, predictions and standard deviations (predicted_K_*).
std::string proposalTable(const std::vector<terramech::ProposedRun>& runs,
                          const terramech::TraceResult& result);

nlohmann::ordered_json proposalsJson(const std::vector<terramech::ProposedRun>& runs);
nlohmann::ordered_json scoresJson(const std::vector<terramech::CauseScore>& scores);

/// A line each run, with the columns that vary in the table, and what each cause predicts of the mean of its rows.
std::string proposalText(const std::vector<terramech::ProposedRun>& runs, const terramech::Trial& trial);

/// A line each cause.
std::string causeScoreText(const std::vector<terramech::CauseScore>& scores);

}  // namespace talus::cli
