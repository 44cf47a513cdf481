#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include <talus/costmap/cost/travel_states.hpp>
#include <talus/costmap/ground/cost_curve_table.hpp>

namespace talus::costmap {
namespace {

// Returns a cost that refuses every heading, for classes whose prior was not requested.
const GroundCost& refused() {
  static const GroundCost ground = [] {
    auto states = std::make_shared<const TabulatedStates>(
        std::vector<TravelState>(TravelCurve::kBins, {.refusal = Refusal::Unknown}));
    return GroundCost{.curve = states->curve({}), .states = states};
  }();
  return ground;
}

}  // namespace

CostCurveTable::CostCurveTable(std::shared_ptr<const GroundModel> model) : model_(std::move(model)) {
  if (classes() > kMost)
    throw std::invalid_argument("cost curves: " + std::to_string(classes()) +
                                " classes of ground, must be <= " + std::to_string(kMost));
  for (int i = 0; i < static_cast<int>(classes()); ++i) priors_.push_back(model_->prior(i));
  beliefs_ = priors_;
  grounds_.assign(classes(), refused());
  categories_.resize(classes());
  priced_.assign(classes(), false);
  price(0);
}

void CostCurveTable::price(std::size_t class_index) {
  priced_[class_index] = true;
  const GroundBelief& prior = priors_[class_index];
  grounds_[class_index] = model_->ground(static_cast<int>(class_index), prior);
  beliefs_[class_index] = prior;
  categories_[class_index] = CategoryTable(*model_, prior, grounds_[class_index]);
  cost_.reset();
}

CellCode::Curve CostCurveTable::prior(int class_index) {
  if (!priced_[static_cast<std::size_t>(class_index)]) price(static_cast<std::size_t>(class_index));
  return static_cast<CellCode::Curve>(class_index);
}

CellCode::Curve CostCurveTable::added(GroundCost ground, const GroundBelief& belief,
                                      CategoryTable categories) {
  grounds_.push_back(std::move(ground));
  beliefs_.push_back(belief);
  categories_.push_back(std::move(categories));
  cost_.reset();
  return static_cast<CellCode::Curve>(grounds_.size() - 1);
}

CellCode::Curve CostCurveTable::learned(int class_index, int other_class, const GroundBelief& belief) {
  const GroundKind kind = GroundKind::of(model_->prior(class_index), class_index, other_class, belief);
  if (const auto known = numbers_.find(kind); known != numbers_.end()) return known->second;
  if (grounds_.size() >= kMost) return CellCode::kBlocked;
  // Uses the worst estimate of the kind, so that the curve does not depend on the estimate that occurred
  // first.
  const GroundBelief worst =
      kind.belief(model_->prior(class_index), model_->parts().classes[static_cast<std::size_t>(class_index)]);
  GroundCost ground = model_->ground(class_index, other_class, worst);
  CategoryTable categories(*model_, worst, ground);
  return numbers_[kind] = added(std::move(ground), worst, std::move(categories));
}

GroundCost CostCurveTable::dearer(const GroundCost& ground, double added_J_per_m) const {
  const TravelPolicy& policy = model_->parts().policy;
  const auto states = ground.states->withAdded(added_J_per_m);
  return {
      .curve = states->curve({.energy = 1.0, .time_W = policy.time_weight_W, .risk_J = policy.risk_weight_J}),
      .states = states,
      .turns = ground.turns};
}

CellCode::Curve CostCurveTable::dearer(CellCode::Curve number, int step, double added_J_per_m) {
  if (const auto known = dearer_.find({number, step}); known != dearer_.end()) return known->second.number;
  if (grounds_.size() >= kMost) return CellCode::kBlocked;
  const CellCode::Curve next =
      added(dearer(grounds_[number], added_J_per_m), beliefs_[number], categories_[number]);
  dearer_.emplace(std::pair(number, step), Dearer{next, added_J_per_m});
  return next;
}

void CostCurveTable::restart() {
  grounds_.resize(classes());
  beliefs_.resize(classes());
  categories_.resize(classes());
  numbers_.clear();
  dearer_.clear();
  cost_.reset();
}

bool CostCurveTable::setPrior(int class_index, const GroundBelief& next) {
  const auto i = static_cast<std::size_t>(class_index);
  const auto same = [](const Estimate& a, const Estimate& b) { return a.value == b.value && a.std == b.std; };
  if (same(next.pull, priors_[i].pull) && same(next.sinkage, priors_[i].sinkage)) return false;
  priors_[i] = next;
  if (!priced_[i]) return true;  // at class borders, the prior is in use
  price(i);
  for (const auto& [from, its] : dearer_)
    if (from.first == i) {
      grounds_[its.number] = dearer(grounds_[i], its.added_J_per_m);
      beliefs_[its.number] = next;
      categories_[its.number] = categories_[i];
    }
  return true;
}

// Computes the fraction of the pull variance of each class that is common to all of its ground: the excess
// over the variance between places.
SoilUncertainty CostCurveTable::uncertainty() const {
  const GroundModel::Parts& parts = model_->parts();
  if (parts.stated) return {};
  SoilUncertainty uncertainty{.correlation_length_m = parts.policy.correlation_length_m,
                              .entrapment = parts.policy.held()};
  for (std::size_t i = 0; i < classes(); ++i) {
    const double all = priors_[i].pull.std, apart = parts.classes[i].pull_std;
    uncertainty.shared.push_back(all > apart ? 1.0 - apart * apart / (all * all) : 0.0);
  }
  return uncertainty;
}

std::shared_ptr<const TravelCost> CostCurveTable::cost() const {
  if (!cost_) cost_ = std::make_shared<TravelCost>(model_->limits(), grounds_, uncertainty());
  return cost_;
}

}  // namespace talus::costmap
