#include <cmath>

#include <talus/common/constants.hpp>
#include <talus/terramech/calibration/fit/model_fit.hpp>
#include <talus/terramech/calibration/held_out/refit.hpp>
#include <talus/terramech/calibration/noise/whitening.hpp>

namespace talus::terramech {
namespace {

/// Whitening of the rows for one model, because the effect of the noise of slip and load depends on the
/// model.
Whitening whiteningOf(const RefinedModel& model, const SharedError& shared, const TraceResult& result) {
  SolvedContacts solved;
  Whitening all = whitening(result.trial, predictRows(model, result.trial, solved),
                            inputSlopes(model, result.trial, solved), model.noise);
  all.common = shared;
  return all;
}

RefinedModel refitted(const RefinedModel& model, const SharedError& shared, const TraceResult& result,
                      const TraceOptions& options, const std::vector<char>& train) {
  const Trial seen = subset(result.trial, train);
  const Whitening white = subset(whiteningOf(model, shared, result), train);
  SolvedContacts start;
  FitPlan plan = fitPlan(model, options.fit_soil);
  plan.iterations = 8;
  plan.misfit = misfitOf(white.apply(seen.measured - predictRows(model, seen, start)), seen);
  return fitModel(model, seen, white, plan, start).model;
}

}  // namespace

void SquaredErrors::add(const Eigen::MatrixXd& residual) {
  for (int c = 0; c < kChannels; ++c)
    for (double r : residual.col(c))
      if (std::isfinite(r)) {
        sum_[static_cast<std::size_t>(c)] += r * r;
        ++count_[static_cast<std::size_t>(c)];
      }
}

ChannelErrors SquaredErrors::rmse() const {
  ChannelErrors e{};
  for (std::size_t c = 0; c < kChannels; ++c) e[c] = count_[c] ? std::sqrt(sum_[c] / count_[c]) : kNaN;
  return e;
}

Eigen::MatrixXd leftAsMeasured(const RefinedModel& model, const Trial& trial) {
  SolvedContacts solved;
  return trial.measured - predictRows(model, asMeasured(trial), solved);
}

ChannelErrors rmseAsMeasured(const RefinedModel& model, const Trial& trial) {
  SquaredErrors sums;
  sums.add(leftAsMeasured(model, trial));
  return sums.rmse();
}

RefinedModel refittedBase(const TraceResult& result, const TraceOptions& options, std::vector<char> train) {
  const std::vector<char> of_soil = rowsOfSoil(subset(result.trial, train));
  for (std::size_t row = 0, seen = 0; row < train.size(); ++row)
    if (train[row] && !of_soil[seen++]) train[row] = 0;
  return refitted(result.base, result.base_shared, result, options, train);
}

RefinedModel refittedModel(const TraceResult& result, const TraceOptions& options,
                           const std::vector<char>& train) {
  return refitted(result.refined, result.shared, result, options, train);
}

}  // namespace talus::terramech
