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

/// Returns the linearised contribution of a candidate, whitened row by row. For an effect: the change of the
/// predictions at its typical size, and the derivatives by its other parameters. For a curve: the derivatives
/// by its values at the knots.
Contender contenderOf(const Candidate& candidate, const ModelOnRows& at);

/// Returns the derivatives of the predictions by the free parameters of a plan at a fitted model, in units of
/// rangeOf().scale.
LinearModel linearised(const RefinedModel& fitted, const Trial& trial, const Whitening& whitening,
                       const FitPlan& plan, SolvedContacts& solved);

/// The model with the parts of a candidate appended to its effects.
RefinedModel withCandidate(const RefinedModel& model, const Candidate& candidate);

}  // namespace talus::terramech
