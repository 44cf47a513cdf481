#pragma once

#include <string>

#include <terramech/residual_trace.hpp>

namespace talus::terramech {

/// Whether a rigid wheel on soil, with physical effects, says anything of the rows at all.
struct Applicability {
  bool applies = true;
  std::string reason;  ///< why not
};

/// The physics alone, curves of no known cause left out, on rows held out: it must explain a tenth of the
/// variance of at least one channel that varies by more than its noise. And where drawbar pull, torque and
/// sinkage are measured together, the relation between them that holds for every soil (closure_offset.hpp)
/// must not fail by 0.15 in half of the rows while the physics is as far off: then no cohesion and friction
/// can explain them. Both limits are ours.
Applicability applicability(const TraceResult& result, const TraceOptions& options);

}  // namespace talus::terramech
