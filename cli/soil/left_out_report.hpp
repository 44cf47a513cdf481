#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <talus/terramech/calibration/trace/left_out.hpp>

namespace talus::cli {

/// Errors on rows that tracing did not see, a table of base, refined model, sensors alone and plain regression.
std::string leftOutText(const std::vector<terramech::LeftOutErrors>& all);
nlohmann::ordered_json leftOutJson(const std::vector<terramech::LeftOutErrors>& all);

/// The same as a page, with what was measured and foretold over the column that was held out (`request`: COLUMN[=VALUES]).
/// `source` is the table's path.
std::string leftOutPage(const std::vector<terramech::LeftOutErrors>& all, const std::string& request,
                        const std::string& source);

}  // namespace talus::cli
