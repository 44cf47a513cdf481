#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include <talus/costmap/cost_curve_table.hpp>
#include <talus/costmap/cross_slope.hpp>

namespace talus::costmap {
namespace {

constexpr std::size_t kNumbers = CellCode::kUnknown;

}  // namespace

CostCurveTable::CostCurveTable(std::shared_ptr<const GroundModel> model) : model_(std::move(model)) {
  if (classes() > kNumbers)
    throw std::invalid_argument("cost curves: " + std::to_string(classes()) +
                                " classes of ground, must be <= " + std::to_string(kNumbers));
  for (int i = 0; i < static_cast<int>(classes()); ++i) {
    beliefs_.push_back(model_->prior(i));
    grounds_.push_back(model_->ground(i, beliefs_.back()));
    categories_.emplace_back(*model_, beliefs_.back(), *grounds_.back().crossing);
  }
}

std::uint8_t CostCurveTable::learned(int class_index, int other_class, const GroundBelief& belief) {
  const GroundKind kind = GroundKind::of(class_index, other_class, belief, level_);
  if (const auto known = numbers_.find(kind); known != numbers_.end()) return known->second;
  if (grounds_.size() >= kNumbers) {
    overflowed_ = true;
    return standIn(kind);
  }
  // All of the kind, so that a curve does not depend on who asked for it first.
  const GroundBelief worst = kind.belief(model_->parts().classes[static_cast<std::size_t>(class_index)]);
  const auto number = static_cast<std::uint8_t>(grounds_.size());
  grounds_.push_back(model_->ground(class_index, other_class, worst));
  beliefs_.push_back(worst);
  categories_.emplace_back(*model_, worst, *grounds_.back().crossing);
  numbers_.emplace(kind, number);
  cost_.reset();
  return number;
}

// The strongest of the known beliefs on the same classes that are no better in anything.
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

DriveGround CostCurveTable::dearer(const DriveGround& ground, double added_J_per_m) const {
  auto states = std::make_shared<DriveTable>(*ground.states);
  for (DriveState& state : *states)
    state.energy_J_per_m = static_cast<float>(static_cast<double>(state.energy_J_per_m) + added_J_per_m);
  const DrivePolicy& policy = model_->parts().policy;
  DriveCurve curve = priced(*states, ground.crossing.get(),
                            {.energy = 1.0, .time_W = policy.time_weight_W, .risk_J = policy.risk_weight_J});
  return {.curve = std::move(curve), .states = std::move(states), .crossing = ground.crossing};
}

std::uint8_t CostCurveTable::dearer(std::uint8_t number, int step, double added_J_per_m) {
  if (const auto known = dearer_.find({number, step}); known != dearer_.end()) return known->second.number;
  if (grounds_.size() >= kNumbers) {
    overflowed_ = true;
    const auto greater = dearer_.lower_bound({number, step});
    return greater != dearer_.end() && greater->first.first == number ? greater->second.number
                                                                      : CellCode::kBlocked;
  }
  const auto next = static_cast<std::uint8_t>(grounds_.size());
  grounds_.push_back(dearer(grounds_[number], added_J_per_m));
  beliefs_.push_back(GroundBelief(beliefs_[number]));
  categories_.push_back(CategoryTable(categories_[number]));
  dearer_.emplace(std::pair(number, step), Dearer{next, added_J_per_m});
  cost_.reset();
  return next;
}

double CostCurveTable::used() const noexcept {
  const std::size_t all = kNumbers - classes();
  return all > 0 ? static_cast<double>(grounds_.size() - classes()) / static_cast<double>(all) : 1.0;
}

void CostCurveTable::restart(int level) {
  level_ = level;
  overflowed_ = false;
  grounds_.resize(classes());
  beliefs_.resize(classes());
  categories_.erase(categories_.begin() + static_cast<std::ptrdiff_t>(classes()), categories_.end());
  numbers_.clear();
  dearer_.clear();
  cost_.reset();
}

bool CostCurveTable::setPrior(int class_index, const GroundBelief& next) {
  const auto i = static_cast<std::size_t>(class_index);
  const auto same = [](const Estimate& a, const Estimate& b) { return a.value == b.value && a.std == b.std; };
  if (same(next.pull, beliefs_[i].pull) && same(next.sinkage, beliefs_[i].sinkage)) return false;
  beliefs_[i] = next;
  const Worked& now = worked(class_index, next);
  grounds_[i] = now.ground;
  categories_[i] = now.categories;
  for (const auto& [from, its] : dearer_)
    if (from.first == i) {
      grounds_[its.number] = dearer(grounds_[i], its.added_J_per_m);
      beliefs_[its.number] = next;
      categories_[its.number] = now.categories;
    }
  cost_.reset();
  return true;
}

const CostCurveTable::Worked& CostCurveTable::worked(int class_index, const GroundBelief& prior) {
  constexpr std::size_t kRemembered = 64;
  const auto bits = [](double value) { return std::bit_cast<std::int64_t>(value); };
  const PriorKey key{class_index, bits(prior.pull.value), bits(prior.pull.std), bits(prior.sinkage.value),
                     bits(prior.sinkage.std)};
  if (const auto known = worked_.find(key); known != worked_.end()) return known->second;
  if (worked_.size() >= kRemembered) worked_.clear();
  DriveGround ground = model_->ground(class_index, prior);
  CategoryTable categories(*model_, prior, *ground.crossing);
  return worked_.emplace(key, Worked{std::move(ground), std::move(categories)}).first->second;
}

// What a class's belief is less sure of than the scatter from place to place, all of its ground shares.
SoilDoubt CostCurveTable::doubt() const {
  const GroundModel::Parts& parts = model_->parts();
  SoilDoubt doubt{.correlation_length_m = parts.policy.correlation_length_m,
                  .entrapment = parts.policy.held()};
  for (std::size_t i = 0; i < classes(); ++i) {
    const double all = beliefs_[i].pull.std, apart = parts.classes[i].pull_std;
    doubt.shared.push_back(all > apart ? 1.0 - apart * apart / (all * all) : 0.0);
  }
  return doubt;
}

std::shared_ptr<const DriveCost> CostCurveTable::cost() const {
  if (!cost_) cost_ = std::make_shared<DriveCost>(model_->limits(), grounds_, doubt());
  return cost_;
}

}  // namespace talus::costmap
