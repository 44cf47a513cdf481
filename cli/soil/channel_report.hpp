#pragma once

#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>

#include <talus/cli/draw/plot.hpp>
#include <talus/terramech/calibration/search/trace_result.hpp>

/// Errors and predictions by channel (measured quantity); channels without a value are omitted.
namespace talus::cli {

/// Returns the errors as {NAME: ERROR}.
nlohmann::ordered_json errorsJson(const terramech::ChannelErrors& errors);

/// Returns the errors of the base model and of the refined model as text: " NAME BASE -> REFINED" for each
/// channel.
std::string changeText(const terramech::ChannelErrors& base, const terramech::ChannelErrors& refined);

/// Name and values of predictions: one matrix row per table row, one matrix column per channel (measured
/// quantity).
using NamedPredictions = std::pair<std::string, Eigen::MatrixXd>;

/// Returns a plot of one channel over the slip, measured and predicted. Rows without slip, measurement or
/// prediction are omitted.
Plot overSlip(terramech::Channel channel, const terramech::Trial& trial,
              const std::vector<NamedPredictions>& predictions);

/// Returns the rows and columns of a large table that were not searched, one line each; empty if all were
/// searched.
std::string searchedText(const terramech::TraceResult& result);

/// Returns JSON: {rows, rows_not_searched, base_rmse_there, refined_rmse_there, columns_dropped}.
nlohmann::ordered_json searchedJson(const terramech::TraceResult& result);

}  // namespace talus::cli
