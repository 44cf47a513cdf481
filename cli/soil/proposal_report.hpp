#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <talus/terramech/calibration/trace/run_proposal.hpp>

namespace talus::cli {

/// Returns a table of proposed test runs as CSV, one row per slip. Its columns are the conditions of the run;
/// empty columns for the channels to be measured; and, for each possible cause K of the residual, the name of
/// the cause, the predictions and their standard deviations (predicted_K_*).
std::string proposalTable(const std::vector<terramech::ProposedRun>& runs,
                          const terramech::TraceResult& result);

nlohmann::ordered_json proposalsJson(const std::vector<terramech::ProposedRun>& runs);
nlohmann::ordered_json scoresJson(const std::vector<terramech::CauseScore>& scores);

/// Returns one line of text per run, with the columns that vary in the table and, for each cause, the
/// prediction of the mean of the run's rows.
std::string proposalText(const std::vector<terramech::ProposedRun>& runs, const terramech::Trial& trial);

/// Returns one line of text per cause, with its score.
std::string causeScoreText(const std::vector<terramech::CauseScore>& scores);

}  // namespace talus::cli
