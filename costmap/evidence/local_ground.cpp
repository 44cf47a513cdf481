#include <algorithm>
#include <cmath>
#include <utility>

#include <talus/costmap/evidence/evidence_store.hpp>
#include <talus/costmap/evidence/local_ground.hpp>

namespace talus::costmap {
namespace {

constexpr int kPatchBlocks = EvidenceReach::kPatchBlocks;
constexpr std::size_t kMostNeighbours = 64;

// LocalGround while it is collected.
struct NearbyEvidence {
  GroundOfClass of;
  std::vector<PlaceEvidence> places{};
  std::vector<WeakPlace> weak{}, lower{};
  std::vector<PlaceBound> bounds{};
};

// Adds the evidence of one block. Pulls that may raise an estimate are added to the Gaussian process. Places
// with less pull than the spread of their class allows, or whose readings may only lower an estimate, become
// separate bounds.
// Evidence of another class is used only if its position uncertainty includes this ground.
void place(const EvidenceStore& store, const BlockLevel& block, const BlockEvidence& e,
           NearbyEvidence& nearby) {
  const int own = store.model().classIndex(block.terrain_class);
  const GroundBelief mean = classGround(store.model(), nearby.of),
                     prior = store.model().prior(nearby.of.class_index);
  const GroundClass& ground = store.groundClass(own);
  const maps::Point middle = store.blocks.middleOf(store.blocks.blockAt(block.column, block.row));
  const bool alike = own == nearby.of.class_index;
  const double variance = static_cast<double>(e.weak_variance);
  const double below = static_cast<double>(e.weak_pull) - store.model().prior(own).pull.value;
  const double deeper = static_cast<double>(e.sinkage) - store.model().prior(own).sinkage.value;
  const bool weak = below < -kOrdinary * std::sqrt(ground.pull_std * ground.pull_std + variance);
  const bool own_lowers = alike && e.lowers;
  const bool deep = deeper > (own_lowers ? 0.0 : kOrdinary * ground.sinkage_std);
  if (alike && !std::isnan(e.pull)) {
    const double sinkage = static_cast<double>(e.sinkage) - mean.sinkage.value;
    nearby.places.push_back(
        {.place = middle,
         .pull = static_cast<double>(e.pull) - mean.pull.value,
         .sinkage = e.sinkage_raises || std::isnan(sinkage) ? sinkage : std::fmax(sinkage, 0.0),
         .variance = static_cast<double>(e.variance),
         .shared = static_cast<double>(e.shared)});
  }
  const bool may_be_here = alike || e.reach > 0;
  if (!may_be_here) return;
  if (!std::isnan(e.most_pull) || !std::isnan(e.least_sinkage))
    nearby.bounds.push_back(
        {middle, e.reach_m(), static_cast<double>(e.most_pull), static_cast<double>(e.least_sinkage)});
  const double pull = static_cast<double>(e.weak_pull) - prior.pull.value;
  const double sinkage = static_cast<double>(e.sinkage) - prior.sinkage.value;
  const WeakPlace place{.place = middle,
                        .pull = weak ? std::fmin(pull, 0.0) : 0.0,
                        .variance = variance,
                        .sinkage = std::isnan(sinkage) ? 0.0 : std::fmax(sinkage, 0.0),
                        .reach_m = e.reach_m() + (alike ? 0.0 : 0.5 * store.blocks.side_m()),
                        .beyond_reach = alike};
  if (weak || deep) nearby.weak.push_back(place);
  if (!own_lowers || !(below < 0.0)) return;
  nearby.lower.push_back(place);
  nearby.lower.back().pull = below;
}

// Uses the kMostNeighbours places nearest to `middle`, always including those of the patch. The remaining
// places become separate bounds.
LocalGround grounded(const EvidenceStore& store, NearbyEvidence nearby, const maps::Point& middle) {
  std::vector<PlaceEvidence>& places = nearby.places;
  if (places.size() > kMostNeighbours) {
    const auto far = [&](const PlaceEvidence& e) {
      return std::fmax(std::abs(e.place.x_m - middle.x_m), std::abs(e.place.y_m - middle.y_m));
    };
    std::stable_sort(places.begin(), places.end(),
                     [&](const PlaceEvidence& a, const PlaceEvidence& b) { return far(a) < far(b); });
    for (std::size_t i = kMostNeighbours; i < places.size(); ++i)
      nearby.lower.push_back({.place = places[i].place,
                              .pull = std::fmin(places[i].pull + nearby.of.state.pull, 0.0),
                              .variance = places[i].variance,
                              .sinkage = std::fmax(places[i].sinkage + nearby.of.state.sinkage, 0.0)});
    places.resize(kMostNeighbours);
  }
  return {GaussianProcess(std::move(places), variationOf(store, nearby.of.class_index)),
          std::move(nearby.weak), std::move(nearby.lower), std::move(nearby.bounds)};
}

}  // namespace

GroundBelief classGround(const GroundModel& model, const GroundOfClass& of) {
  const GroundClass& ground = model.parts().classes[static_cast<std::size_t>(of.class_index)];
  const ClassState& state = of.state;
  const GroundBelief prior = model.prior(of.class_index);
  return {.pull = {prior.pull.value + state.pull, std::hypot(ground.pull_std, state.pull_std)},
          .sinkage = {std::max(prior.sinkage.value + state.sinkage, 0.0), ground.sinkage_std}};
}

Variation variationOf(const EvidenceStore& store, int class_index) noexcept {
  const GroundClass& ground = store.groundClass(class_index);
  return {.pull_std = ground.pull_std,
          .sinkage_std = ground.sinkage_std,
          .correlation_length_m = store.model().parts().policy.correlation_length_m};
}

// The process contains only places within a correlation length of the patch. Places beyond, whose position
// uncertainty reaches the patch, are bounds only.
LocalGround groundAround(const EvidenceStore& store, const BlockLevel& patch, const GroundOfClass& of) {
  const int reach =
      store.blocks.reach() + static_cast<int>(std::ceil(store.reach.farthest_m() / store.blocks.side_m()));
  NearbyEvidence nearby{.of = of};
  const auto isNear = [&](int blocks) {
    return blocks >= -store.blocks.reach() && blocks < kPatchBlocks + store.blocks.reach();
  };
  store.bricks.visitTop({patch.column - reach, patch.row - reach, patch.column + kPatchBlocks + reach - 1,
                         patch.row + kPatchBlocks + reach - 1},
                        [&](const BlockLevel& at, const BlockEvidence& e) {
                          const std::size_t known = nearby.places.size();
                          place(store, at, e, nearby);
                          if (!isNear(at.column - patch.column) || !isNear(at.row - patch.row))
                            nearby.places.resize(known);
                        });
  const maps::Point low = store.blocks.middleOf(store.blocks.blockAt(patch.column, patch.row));
  const double half_m = 0.5 * (kPatchBlocks - 1) * store.blocks.side_m();
  return grounded(store, std::move(nearby), {low.x_m + half_m, low.y_m + half_m});
}

}  // namespace talus::costmap
