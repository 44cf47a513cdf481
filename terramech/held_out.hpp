#pragma once

#include <string>

#include <terramech/residual_trace.hpp>

namespace talus::terramech {

/// Errors on rows that the fit has not seen. The parameters are fitted anew without each fold; which effects the model
/// has was chosen on all rows.
struct HeldOut {
  std::string scheme;             ///< what was held out together
  ChannelErrors base_rmse{};      ///< of the base model, its soil fitted anew where it was fitted at all
  ChannelErrors refined_rmse{};
};

/// Holds out whole runs where the rows have runs, else whole levels or bands of slip, or of load where slip is constant:
/// never rows of the same run on both sides. Five folds.
HeldOut holdOut(const TraceResult& result, const TraceOptions& options);

}  // namespace talus::terramech
