#pragma once

#include <string>

#include <talus/terramech/calibration/search/trace_result.hpp>

namespace talus::terramech {

/// Whether a rigid wheel on soil, with physical effects, describes the rows.
struct Applicability {
  bool applies = true;
  std::string reason;  ///< why not
};

/// The physics alone, curves of no known cause and faults of sensors left out, on rows held out. Of the channels that move (by more
/// than twice their noise, or torque and sinkage by more than a quarter of their mean) it must explain
/// half of the variance of one, and none may it predict so badly that its mean square error is twice the
/// variance. And where drawbar pull, torque and sinkage are measured together, the relation between them that
/// holds for every soil (closure_offset.hpp) must not fail by 0.15 in half of the rows while the physics is
/// as far off. All limits are ours.
Applicability applicability(const TraceResult& result, const TraceOptions& options);

}  // namespace talus::terramech
