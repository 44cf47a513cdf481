#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include <talus/terramech/calibration/search/trace_result.hpp>

/// Errors by channel as text and as JSON; channels without an error are omitted.
namespace talus::cli {

/// {NAME: ERROR}.
nlohmann::ordered_json errorsJson(const terramech::ChannelErrors& errors);

/// Errors of base and refined model: " NAME BASE -> REFINED" for each channel.
std::string changeText(const terramech::ChannelErrors& base, const terramech::ChannelErrors& refined);

}  // namespace talus::cli
