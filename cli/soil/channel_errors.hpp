#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include <talus/terramech/calibration/search/trace_result.hpp>

/// Prediction errors by channel (measured quantity) as text and as JSON; channels without an error are
/// omitted.
namespace talus::cli {

/// Returns the errors as {NAME: ERROR}.
nlohmann::ordered_json errorsJson(const terramech::ChannelErrors& errors);

/// Returns the errors of the base model and of the refined model as text: " NAME BASE -> REFINED" for each
/// channel.
std::string changeText(const terramech::ChannelErrors& base, const terramech::ChannelErrors& refined);

}  // namespace talus::cli
