#pragma once

#include <string>

#include <talus/common/progress_monitor.hpp>
#include <talus/terramech/calibration/trace/model_validity.hpp>

namespace talus::terramech {

/// Whether a rigid wheel on soil describes the rows of a table, as residual tracing judges it (model_validity.hpp): with
/// the soil alone, and where that fails with the effects that tracing finds. Of at most 400 rows, evenly taken. `base`: a soil or
/// model that is given, empty: the soil is fitted. Applies, too, where there is nothing to judge by: fewer than 20 rows,
/// or no load, slip or wheel. Throws InputError for files that cannot be read.
Applicability tableApplicability(const TableFile& table, const std::string& base, const std::string& rover,
                                 const ProgressMonitor& watch = {});

}  // namespace talus::terramech
