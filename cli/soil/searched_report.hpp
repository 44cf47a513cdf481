#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include <talus/terramech/calibration/search/trace_result.hpp>

namespace talus::cli {

/// What of a large table was not searched, a line each for rows and columns; empty where all was.
std::string searchedText(const terramech::TraceResult& result);

/// The same as {rows, rows_not_searched, base_rmse_there, refined_rmse_there, columns_dropped}.
nlohmann::ordered_json searchedJson(const terramech::TraceResult& result);

}  // namespace talus::cli
