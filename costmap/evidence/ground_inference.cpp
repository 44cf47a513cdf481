#include <algorithm>
#include <cmath>

#include <talus/costmap/evidence/evidence_store.hpp>
#include <talus/costmap/evidence/ground_inference.hpp>

namespace talus::costmap {
namespace {

// True if the place of a bound may lie in the block around `at`: the place is anywhere in its block or within
// its position uncertainty around the block.
bool mayBeIn(const PlaceBound& bound, const maps::Point& at, double side_m) noexcept {
  const double gap_x_m = std::fmax(std::abs(at.x_m - bound.block.x_m) - side_m, 0.0);
  const double gap_y_m = std::fmax(std::abs(at.y_m - bound.block.y_m) - side_m, 0.0);
  const bool itself = at.x_m == bound.block.x_m && at.y_m == bound.block.y_m;
  return itself || std::hypot(gap_x_m, gap_y_m) < bound.reach_m;
}

GroundBelief bounded(const GroundBelief& belief, const PlaceBound& bound) noexcept {
  return weaker(belief, {.pull = {std::fmin(belief.pull.value, bound.most_pull), 0.0},
                         .sinkage = {std::fmax(belief.sinkage.value, bound.least_sinkage), 0.0}});
}

// Estimate that a weak place implies, from the mean and the departure. The standard deviation of the class
// mean is multiplied by the standard deviation left by the place, relative to that of the class.
GroundBelief left(const GroundBelief& weak, const GroundBelief& mean, const GroundClass& ground,
                  double mean_std) noexcept {
  const double open = std::min(weak.pull.std / ground.pull_std, 1.0);
  return {.pull = {mean.pull.value + weak.pull.value, std::hypot(weak.pull.std, open * mean_std)},
          .sinkage = {mean.sinkage.value + weak.sinkage.value, weak.sinkage.std}};
}

// Estimate from the process. The standard deviation of the class mean is multiplied by the standard deviation
// left by the process, relative to that of the class. The shared error is weighted as the evidence and the
// class mean. If the positive weights sum to more than 1, rounding the class mean down by up to pull_step may
// raise the estimate by (sum - 1) pull_step, which is subtracted.
GroundBelief combined(const GroundModel& model, const GroundOfClass& of, const LearnedPlace& learned) {
  const GroundClass& ground = model.parts().classes[static_cast<std::size_t>(of.class_index)];
  const ClassState& state = of.state;
  const GroundBelief prior = model.prior(of.class_index);
  const GroundBelief& departure = learned.departure;
  const double open = std::min(departure.pull.std / ground.pull_std, 1.0);
  const double own_std = std::hypot(departure.pull.std, open * state.own_std);
  const double variance =
      withSharedError({.prior = ground.pull_std * ground.pull_std + ground.mean_std * ground.mean_std,
                       .variance = own_std * own_std,
                       .shared = learned.shared + (1.0 - learned.weight) * state.shared});
  const double beyond = std::max(learned.positive - 1.0, 0.0);
  const double pull = departure.pull.value - beyond * state.pull_step;
  const double sinkage = departure.sinkage.value + beyond * state.sinkage_step;
  return {.pull = {prior.pull.value + state.pull + pull, std::sqrt(variance)},
          .sinkage = {std::max(prior.sinkage.value + state.sinkage + sinkage, 0.0), departure.sinkage.std}};
}

}  // namespace

InferredGround inferredGround(const EvidenceStore& store, const LocalGround& local, const GroundOfClass& of,
                              const maps::Point& at) {
  const ClassState& state = of.state;
  const GroundClass& ground = store.groundClass(of.class_index);
  const GroundBelief away = classGround(store.model(), of);
  const GroundBelief& prior = store.model().prior(of.class_index);
  GroundBelief out = away;
  if (const auto learned = local.process.learned(at); learned.any) {
    out = combined(store.model(), of, learned);
    out.pull.std = std::min(out.pull.std, away.pull.std);
    if (state.may_raise)
      out.pull.value =
          std::min(out.pull.value, std::max(away.pull.value, prior.pull.value + state.most_rise));
    else
      out = weaker(out, away);
  }
  const Variation variation = variationOf(store, of.class_index);
  for (const WeakPlace& place : local.weak)
    if (const auto weak = weakness(place, variation, at)) {
      GroundBelief bound = left(*weak, prior, ground, ground.mean_std);
      if (!(place.pull < 0.0)) bound.pull = out.pull;  // the place bounds the sinkage only
      out = weaker(out, bound);
    }
  // A place within the variation of its class limits the mean only: the standard deviation of the estimate is
  // not increased.
  for (const WeakPlace& place : local.lower)
    if (const auto weak = lowered(place, variation, at)) {
      GroundBelief bound = left(*weak, prior, ground, state.pull_std);
      bound.pull.std = std::min(bound.pull.std, out.pull.std);
      bound.sinkage.std = std::min(bound.sinkage.std, out.sinkage.std);
      out = weaker(out, bound);
    }
  for (const PlaceBound& bound : local.bounds)
    if (mayBeIn(bound, at, store.blocks.side_m())) out = bounded(out, bound);
  return {out, out.pull.value != away.pull.value || out.pull.std != away.pull.std ||
                   out.sinkage.value != away.sinkage.value};
}

}  // namespace talus::costmap
