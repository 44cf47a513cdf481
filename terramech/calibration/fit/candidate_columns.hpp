#pragma once

#include <talus/terramech/calibration/fit/effect_candidates.hpp>
#include <talus/terramech/calibration/fit/model_fit.hpp>
#include <talus/terramech/calibration/noise/gain_distribution.hpp>
#include <talus/terramech/calibration/noise/whitening.hpp>

namespace talus::terramech {

/// A wheel model, evaluated on the rows of a trial (table of measured rows).
struct ModelOnRows {
  const RefinedModel& model;
  const Trial& trial;
  /// Transforms residuals to unit variance.
  const Whitening& whitening;
  const Eigen::MatrixXd& level;  ///< predictions of the model, rows x kChannels
  /// Sinkage of the model in each row.
  const Eigen::VectorXd& sinkage_m;
  /// Solved wheel-soil contact of each row.
  const SolvedContacts& solved;
};

/// Returns the linearised contribution of a candidate (possible addition to the model), whitened row by row.
/// The contribution of an effect is the change of the predictions at the effect's typical size, with the
/// derivatives with respect to its other parameters. The contribution of a curve consists of the derivatives
/// with respect to the curve's values at the knots.
Contender contenderOf(const Candidate& candidate, const ModelOnRows& at);

/// Returns the derivatives of the predictions of a fitted model with respect to the free parameters of a
/// plan. The unit of each parameter is rangeOf().scale.
LinearModel linearised(const RefinedModel& fitted, const Trial& trial, const Whitening& whitening,
                       const FitPlan& plan, SolvedContacts& solved);

/// Returns the model with the effects of a candidate appended to its effects.
RefinedModel withCandidate(const RefinedModel& model, const Candidate& candidate);

}  // namespace talus::terramech
