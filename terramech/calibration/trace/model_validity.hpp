#pragma once

#include <string>

#include <talus/terramech/calibration/search/trace_result.hpp>

namespace talus::terramech {

/// Applicability of the model of a rigid wheel on soil with physical effects.
struct Applicability {
  bool applies = true;  ///< true if the model describes the rows
  std::string reason;   ///< reason if the model does not apply
};

/// Tests the physical model, without empirical curves and sensor faults, on held-out rows. Only channels that
/// vary are tested: by more than twice their noise or, for torque and sinkage, by more than a quarter of
/// their mean. The model must explain at least half of the variance in one channel, and in no channel may its
/// mean square error exceed twice the variance. If drawbar pull, torque and sinkage are measured together,
/// the soil-independent relation between them (closure_offset.hpp) must not have a median error above 0.15
/// while the error of the model in drawbar pull is as large. All limits are ours.
Applicability applicability(const TraceResult& result, const TraceOptions& options);

}  // namespace talus::terramech
