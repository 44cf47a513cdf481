#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include <talus/terramech/calibration/search/trace_result.hpp>

namespace talus::cli {

/// Returns the rows and columns of a large table that were not searched, one line each; empty if all were
/// searched.
std::string searchedText(const terramech::TraceResult& result);

/// Returns JSON: {rows, rows_not_searched, base_rmse_there, refined_rmse_there, columns_dropped}.
nlohmann::ordered_json searchedJson(const terramech::TraceResult& result);

}  // namespace talus::cli
