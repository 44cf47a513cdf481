#pragma once

#include <string>

#include <talus/common/common.hpp>
#include <talus/terramech/calibration/trace/model_validity.hpp>

namespace talus::terramech {

/// Tests whether the model of a rigid wheel on soil describes the rows of a table, with the criterion of
/// model_validity.hpp. The test is made first with the soil alone, then with the effects that residual
/// tracing finds. The test uses at most 400 evenly spaced rows. `base` is a soil or model file; if empty, the
/// soil is fitted. `rover` supplies the wheel. For a table with insufficient data (fewer than 20 rows, or no
/// load, slip or wheel) the model counts as applicable. Throws InputError for unreadable files.
Applicability tableApplicability(const TableFile& table, const std::string& base, const std::string& rover,
                                 const ProgressMonitor& watch = {});

}  // namespace talus::terramech
