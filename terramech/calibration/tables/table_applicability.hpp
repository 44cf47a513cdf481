#pragma once

#include <string>

#include <talus/common/progress_monitor.hpp>
#include <talus/terramech/calibration/trace/model_validity.hpp>

namespace talus::terramech {

/// Tests whether a rigid wheel on soil describes the rows of a table, with the criterion of residual tracing
/// (model_validity.hpp): first with the soil alone, then with the effects that tracing finds. Uses at most
/// 400 evenly spaced rows. `base` is a given soil or model; if empty, the soil is fitted. A table with
/// insufficient data (fewer than 20 rows, or no load, slip or wheel) counts as applicable. Throws InputError
/// for unreadable files.
Applicability tableApplicability(const TableFile& table, const std::string& base, const std::string& rover,
                                 const ProgressMonitor& watch = {});

}  // namespace talus::terramech
