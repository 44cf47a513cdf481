#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include <talus/costmap/cost/travel_states.hpp>
#include <talus/costmap/ground/cost_curve_table.hpp>

namespace talus::costmap {
namespace {

constexpr std::size_t kNumbers = CellCode::kUnknown;

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
  if (classes() > kNumbers)
    throw std::invalid_argument("cost curves: " + std::to_string(classes()) +
                                " classes of ground, must be <= " + std::to_string(kNumbers));
  for (int i = 0; i < static_cast<int>(classes()); ++i) priors_.push_back(model_->prior(i));
  beliefs_ = priors_;
  grounds_.assign(classes(), refused());
  categories_.resize(classes());
  slots_.assign(classes(), Slot::Free);
  price(0);
}

void CostCurveTable::price(std::size_t class_index) {
  slots_[class_index] = Slot::Own;
  const Worked& now = worked(static_cast<int>(class_index), priors_[class_index]);
  grounds_[class_index] = now.ground;
  beliefs_[class_index] = priors_[class_index];
  categories_[class_index] = now.categories;
  cost_.reset();
}

std::uint8_t CostCurveTable::prior(int class_index) {
  const auto i = static_cast<std::size_t>(class_index);
  if (slots_[i] == Slot::Free) price(i);
  if (slots_[i] == Slot::Own) return static_cast<std::uint8_t>(class_index);
  slots_[i] = Slot::Wanted;
  overflowed_ = true;
  return standIn(GroundKind::of(model_->prior(class_index), class_index, class_index, priors_[i], level_));
}

// Appends a curve index, or reuses the highest free class index; nullopt if all indices are in use.
std::optional<std::uint8_t> CostCurveTable::freeNumber() {
  if (grounds_.size() < kNumbers) {
    grounds_.emplace_back();
    beliefs_.emplace_back();
    categories_.emplace_back();
    return static_cast<std::uint8_t>(grounds_.size() - 1);
  }
  const auto free = std::find(slots_.rbegin(), slots_.rend(), Slot::Free);
  if (free == slots_.rend()) return std::nullopt;
  *free = Slot::Lent;
  return static_cast<std::uint8_t>(slots_.rend() - free - 1);
}

std::uint8_t CostCurveTable::learned(int class_index, int other_class, const GroundBelief& belief) {
  const GroundKind kind =
      GroundKind::of(model_->prior(class_index), class_index, other_class, belief, level_);
  if (const auto known = numbers_.find(kind); known != numbers_.end()) return known->second;
  const auto number = freeNumber();
  if (!number) {
    overflowed_ = true;
    return standIn(kind);
  }
  // Uses the worst estimate of the kind, so that the curve does not depend on the estimate that occurred
  // first.
  const GroundBelief worst =
      kind.belief(model_->prior(class_index), model_->parts().classes[static_cast<std::size_t>(class_index)]);
  grounds_[*number] = model_->ground(class_index, other_class, worst);
  beliefs_[*number] = worst;
  categories_[*number] = CategoryTable(*model_, worst, grounds_[*number]);
  numbers_.emplace(kind, *number);
  cost_.reset();
  return *number;
}

// Returns the curve index of the known kind with the greatest pull among those of the same classes that are
// no better in pull, standard deviation and sinkage; kBlocked without such a kind.
std::uint8_t CostCurveTable::standIn(const GroundKind& kind) const {
  const GroundKind* best = nullptr;
  std::uint8_t number = CellCode::kBlocked;
  for (const auto& [known, its] : numbers_) {
    const bool same = known.class_index == kind.class_index && known.other_class == kind.other_class;
    const bool no_better =
        known.pull <= kind.pull && known.pull_std >= kind.pull_std && known.sinkage >= kind.sinkage;
    if (!same || !no_better || (best && known.pull <= best->pull)) continue;
    best = &known;
    number = its;
  }
  return number;
}

GroundCost CostCurveTable::dearer(const GroundCost& ground, double added_J_per_m) const {
  const TravelPolicy& policy = model_->parts().policy;
  const auto states = dynamic_cast<const GroundStates&>(*ground.states).withAdded(added_J_per_m);
  return {
      .curve = states->curve({.energy = 1.0, .time_W = policy.time_weight_W, .risk_J = policy.risk_weight_J}),
      .states = states,
      .turns = ground.turns};
}

std::uint8_t CostCurveTable::dearer(std::uint8_t number, int step, double added_J_per_m) {
  if (const auto known = dearer_.find({number, step}); known != dearer_.end()) return known->second.number;
  const auto next = freeNumber();
  if (!next) {
    overflowed_ = true;
    const auto greater = dearer_.lower_bound({number, step});
    return greater != dearer_.end() && greater->first.first == number ? greater->second.number
                                                                      : CellCode::kBlocked;
  }
  grounds_[*next] = dearer(grounds_[number], added_J_per_m);
  beliefs_[*next] = beliefs_[number];
  categories_[*next] = categories_[number];
  dearer_.emplace(std::pair(number, step), Dearer{*next, added_J_per_m});
  cost_.reset();
  return *next;
}

double CostCurveTable::used() const noexcept {
  const auto own = static_cast<std::size_t>(std::ranges::count(slots_, Slot::Own)),
             idle = static_cast<std::size_t>(std::ranges::count(slots_, Slot::Free));
  const std::size_t all = kNumbers - own;
  return all > 0 ? static_cast<double>(grounds_.size() - own - idle) / static_cast<double>(all) : 1.0;
}

void CostCurveTable::restart(int level) {
  level_ = level;
  overflowed_ = false;
  grounds_.resize(classes());
  beliefs_.resize(classes());
  categories_.resize(classes());
  numbers_.clear();
  dearer_.clear();
  cost_.reset();
  for (std::size_t i = 0; i < classes(); ++i) {
    if (slots_[i] == Slot::Wanted) price(i);
    if (slots_[i] != Slot::Lent) continue;
    slots_[i] = Slot::Free;
    grounds_[i] = refused();
    categories_[i] = {};
  }
}

bool CostCurveTable::setPrior(int class_index, const GroundBelief& next) {
  const auto i = static_cast<std::size_t>(class_index);
  const auto same = [](const Estimate& a, const Estimate& b) { return a.value == b.value && a.std == b.std; };
  if (same(next.pull, priors_[i].pull) && same(next.sinkage, priors_[i].sinkage)) return false;
  priors_[i] = next;
  if (slots_[i] != Slot::Own) return true;  // at class borders, the prior is in use
  price(i);
  for (const auto& [from, its] : dearer_)
    if (from.first == i) {
      grounds_[its.number] = dearer(grounds_[i], its.added_J_per_m);
      beliefs_[its.number] = next;
      categories_[its.number] = categories_[i];
    }
  return true;
}

const CostCurveTable::Worked& CostCurveTable::worked(int class_index, const GroundBelief& prior) {
  constexpr std::size_t kRemembered = 64;
  const auto bits = [](double value) { return std::bit_cast<std::int64_t>(value); };
  const PriorKey key{class_index, bits(prior.pull.value), bits(prior.pull.std), bits(prior.sinkage.value),
                     bits(prior.sinkage.std)};
  if (const auto known = worked_.find(key); known != worked_.end()) return known->second;
  if (worked_.size() >= kRemembered) worked_.clear();
  GroundCost ground = model_->ground(class_index, prior);
  CategoryTable categories(*model_, prior, ground);
  return worked_.emplace(key, Worked{std::move(ground), std::move(categories)}).first->second;
}

// Computes the fraction of the pull variance of each class that is common to all of its ground: the excess
// over the variance between places.
SoilUncertainty CostCurveTable::uncertainty() const {
  const GroundModel::Parts& parts = model_->parts();
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
