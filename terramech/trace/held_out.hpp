#pragma once

#include <string>
#include <vector>

#include <talus/terramech/trace/folds.hpp>
#include <talus/terramech/trace/residual_trace.hpp>

namespace talus::terramech {

/// Errors on the rows of one group of a text column, the fit made from all groups.
struct GroupErrors {
  std::string column, value;
  int rows = 0;
  ChannelErrors base_rmse{}, refined_rmse{};
};

/// Errors on rows that the fit has not seen. The parameters are fitted again without each fold; which effects
/// the model has was chosen on all rows.
struct HeldOut {
  std::string scheme;         ///< what was held out together
  ChannelErrors base_rmse{};  ///< of the base model, its soil fitted again where it was fitted
  ChannelErrors refined_rmse{};
  std::vector<GroupErrors> groups;  ///< of each text column of which an effect acts on one group alone
};

/// A model of a result fitted again to the rows that `train` marks.
RefinedModel refitted(const RefinedModel& model, const TraceResult& result, const TraceOptions& options,
                      const std::vector<char>& train);

/// Errors at the slip and load as measured.
ChannelErrors rmseAsMeasured(const RefinedModel& model, Trial trial);

/// Errors under one way to hold rows out.
HeldOut holdOut(const TraceResult& result, const TraceOptions& options, const Folds& folds);

/// Under foldsOf() first, then whole levels of the column of each effect that was found.
std::vector<HeldOut> holdOut(const TraceResult& result, const TraceOptions& options);

}  // namespace talus::terramech
