#pragma once

#include <talus/terramech/calibration/fit/effect_candidates.hpp>
#include <talus/terramech/calibration/fit/model_fit.hpp>
#include <talus/terramech/calibration/noise/gain_distribution.hpp>
#include <talus/terramech/calibration/noise/whitening.hpp>

namespace talus::terramech {

/// A model evaluated on the rows of a trial.
struct ModelOnRows {
  const RefinedModel& model;
  const Trial& trial;
  const Whitening& whitening;
  const Eigen::MatrixXd& level;  ///< predictions of the model, rows x kChannels
  const Eigen::VectorXd& sinkage_m;
  const SolvedContacts& solved;
};

/// Linearised contribution of a candidate, whitened row by row: the change at its typical size and the
/// derivatives by its other parameters, or the derivatives by a curve's values at its knots.
Contender contenderOf(const Candidate& candidate, const ModelOnRows& at);

/// Linearised change of the predictions by the free parameters of a plan at a fitted model, in steps of
/// rangeOf().scale.
LinearModel linearised(const RefinedModel& fitted, const Trial& trial, const Whitening& whitening,
                       const FitPlan& plan, SolvedContacts& solved);

/// The model with the parts of a candidate appended to its effects.
RefinedModel withCandidate(const RefinedModel& model, const Candidate& candidate);

}  // namespace talus::terramech
