#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include <talus/costmap/cost/cost_model.hpp>
#include <talus/costmap/ground/cost_curve_table.hpp>

namespace talus::costmap {

namespace {

using terramech::Category;

constexpr int kJudgedHeadings =
    24;                       // headings over 180 degrees, as SlopeLattice::steepest(): left and right are
                              // symmetric
constexpr int kSteps = 2898;  // greatest gradient of CellCode in steps: 2048 sqrt(2)

// True if the reason for the refusal depends on the uncertain pull of the ground.
bool isOfSoil(Refusal refusal) {
  return refusal == Refusal::Pull || refusal == Refusal::SideForce;
}

CellCategory entryOf(const RankedCategory& ranked) {
  // Rounded to the nearest step for dangerous ground, else down: the probability of better ground is never
  // overstated.
  const double steps = 16.0 * ranked.probability;
  const double rounded = ranked.category == Category::Dangerous ? std::round(steps) : std::floor(steps);
  return {static_cast<std::uint8_t>(ranked.category), static_cast<std::uint8_t>(rounded)};
}

}  // namespace

Direction worstHeading(const TravelCost& cost, CellCode cell) noexcept {
  const double length = std::hypot(cell.dzDx(), cell.dzDy());
  if (!(length > 0.0)) return {};
  const Direction up{cell.dzDx() / length, cell.dzDy() / length};
  constexpr double kClearly = 1.0 / 32.0;  // gradient difference of two rows
  Direction found = up;
  double most = cost.climb(cell, up) + kClearly;
  for (int k = 1; k < kJudgedHeadings; ++k) {
    const double c = std::cos(k * std::numbers::pi / kJudgedHeadings),
                 s = std::sin(k * std::numbers::pi / kJudgedHeadings);
    const Direction tried{c * up.x - s * up.y, s * up.x + c * up.y};
    if (const double climb = cost.climb(cell, tried); climb > most) {
      most = climb;
      found = tried;
    }
  }
  return found;
}

RankedCategory judged(const GroundModel& model, const GroundBelief& belief, const TravelState& state,
                      double climb) {
  const RankedCategory ranked = model.category(belief, climb);
  const bool driven = state.refusal == Refusal::None || state.refusal == Refusal::Category;
  if (driven || ranked.category == Category::Dangerous) return ranked;
  return {Category::Dangerous, isOfSoil(state.refusal) ? static_cast<double>(state.weak) : 1.0};
}

CategoryTable::CategoryTable(std::shared_ptr<const GroundModel> model, const GroundBelief& belief,
                             GroundCost ground)
    : model_(std::move(model)), belief_(belief), ground_(std::move(ground)) {}

std::vector<CellCategory> CategoryTable::tabulated() const {
  TravelCost::Limits limits = model_->limits();
  limits.stance.reset();  // only TravelCost::tips() needs the stance
  const TravelCost cost(limits, std::vector{ground_});
  const auto judgedAt = [&](int step) {
    const CellCode plane({.dz_dx = step * CellCode::kStep, .dz_dy = 0.0, .curve = 0});
    const Direction worst = worstHeading(cost, plane);
    return judged(*model_, belief_, cost.detail(plane, worst),
                  ground_.states->steepest(step * CellCode::kStep));
  };
  // Categories are monotone in the gradient.
  int refused = 0;
  for (int end = kSteps - 1; refused < end;) {
    const int middle = (refused + end) / 2;
    if (judgedAt(middle).category < Category::Dangerous)
      refused = middle + 1;
    else
      end = middle;
  }
  const CellCategory dangerous = entryOf(judgedAt(refused));
  std::vector<CellCategory> entries;
  for (int step = 0; step < kSteps; ++step) {
    const RankedCategory here = model_->category(belief_, ground_.states->steepest(step * CellCode::kStep));
    entries.push_back(step >= refused && here.category < Category::Dangerous ? dangerous : entryOf(here));
  }
  return entries;
}

CellCategory CategoryTable::at(CellCode cell) const {
  std::call_once(once_, [this] { entries_ = tabulated(); });
  const auto x = static_cast<float>(cell.stepsX()), y = static_cast<float>(cell.stepsY());
  return entries_[static_cast<std::size_t>(std::ceil(std::sqrt(x * x + y * y)))];
}

namespace {

// Rounds down to a multiple of a step; a value remains equal if it is a multiple but for rounding.
double roundedDown(double value, double step) {
  constexpr double kSame = 1e-6;  // [steps]
  return step * std::floor(value / step + kSame);
}

double roundedUp(double value, double step) {
  return -roundedDown(-value, step);
}

}  // namespace

GroundBelief rounded(const GroundBelief& belief, const GroundBelief& prior,
                     const GroundClass& ground) noexcept {
  constexpr double kPullStep = 0.005, kSinkageStep = 0.02, kOctaveStep = 0.125;
  constexpr double kLeastStd = 0.01;  // least unit of the standard deviation, for priors with a smaller one
  const double unit = std::max(prior.pull.std, kLeastStd),
               octaves = std::clamp(std::log2(belief.pull.std / unit), -6.0, 8.0),
               std = unit * std::exp2(roundedUp(octaves, kOctaveStep));
  const double deeper = roundedUp(std::max(belief.sinkage.value, 0.0) - prior.sinkage.value, kSinkageStep);
  return {.pull = {prior.pull.value + roundedDown(belief.pull.value - prior.pull.value, kPullStep), std},
          .sinkage = {std::max(prior.sinkage.value + deeper, 0.0),
                      std::min(std / ground.pull_std, 1.0) * ground.sinkage_std}};
}

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
  for (const GroundBelief& prior : priors_) curves_.push_back(curve(refused(), prior));
  priced_.assign(classes(), false);
  price(0);
}

void CostCurveTable::price(std::size_t class_index) {
  priced_[class_index] = true;
  const GroundBelief& prior = priors_[class_index];
  curves_[class_index] = curve(model_->ground(static_cast<int>(class_index), prior), prior);
  cost_.reset();
}

CellCode::Curve CostCurveTable::prior(int class_index) {
  if (!priced_[static_cast<std::size_t>(class_index)]) price(static_cast<std::size_t>(class_index));
  return static_cast<CellCode::Curve>(class_index);
}

CellCode::Curve CostCurveTable::added(Curve curve) {
  curves_.push_back(std::move(curve));
  cost_.reset();
  return static_cast<CellCode::Curve>(curves_.size() - 1);
}

CellCode::Curve CostCurveTable::learned(int class_index, const GroundBelief& belief, int other_class) {
  // Uses the rounded estimate, so that the curve does not depend on the estimate that occurred first.
  const GroundBelief worst = rounded(belief, model_->prior(class_index),
                                     model_->parts().classes[static_cast<std::size_t>(class_index)]);
  const std::tuple key(class_index, other_class, worst.pull.value, worst.pull.std, worst.sinkage.value);
  if (const auto known = numbers_.find(key); known != numbers_.end()) return known->second;
  if (curves_.size() >= kMost) return CellCode::kBlocked;
  return numbers_[key] = added(curve(model_->ground(class_index, worst, other_class), worst));
}

CostCurveTable::Curve CostCurveTable::dearer(Curve curve, double added_J_per_m) const {
  curve.ground.states = curve.ground.states->withAdded(added_J_per_m);
  curve.ground.curve = curve.ground.states->curve(model_->weights());
  return curve;
}

CellCode::Curve CostCurveTable::dearer(CellCode::Curve number, int step, double added_J_per_m) {
  if (const auto known = dearer_.find({number, step}); known != dearer_.end()) return known->second.number;
  if (curves_.size() >= kMost) return CellCode::kBlocked;
  const CellCode::Curve next = added(dearer(curves_[number], added_J_per_m));
  dearer_.emplace(std::pair(number, step), Dearer{next, added_J_per_m});
  return next;
}

void CostCurveTable::restart() {
  curves_.erase(curves_.begin() + static_cast<std::ptrdiff_t>(classes()), curves_.end());
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
    if (from.first == i) curves_[its.number] = dearer(curves_[i], its.added_J_per_m);
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
    uncertainty.ruts.push_back({parts.classes[i].soil.rut_stiffness, parts.classes[i].rut_stiffness_std});
  }
  return uncertainty;
}

std::shared_ptr<const TravelCost> CostCurveTable::cost() const {
  if (cost_) return cost_;
  std::vector<GroundCost> grounds;
  for (const Curve& curve : curves_) grounds.push_back(curve.ground);
  return cost_ = std::make_shared<TravelCost>(model_->limits(), grounds, uncertainty(), model_->weights());
}

}  // namespace talus::costmap
