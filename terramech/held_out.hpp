#pragma once

#include <string>
#include <vector>

#include <terramech/folds.hpp>
#include <terramech/residual_trace.hpp>

namespace talus::terramech {

/// Errors on rows that the fit has not seen. The parameters are fitted anew without each fold; which effects
/// the model has was chosen on all rows.
struct HeldOut {
  std::string scheme;         ///< what was held out together
  ChannelErrors base_rmse{};  ///< of the base model, its soil fitted anew where it was fitted at all
  ChannelErrors refined_rmse{};
};

/// Errors under one way to hold rows out.
HeldOut holdOut(const TraceResult& result, const TraceOptions& options, const Folds& folds);

/// Under foldsOf() first, then whole levels of the column of each effect that was found.
std::vector<HeldOut> holdOut(const TraceResult& result, const TraceOptions& options);

}  // namespace talus::terramech
