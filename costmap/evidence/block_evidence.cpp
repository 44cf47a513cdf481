#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <talus/costmap/evidence/evidence.hpp>
#include <talus/costmap/evidence/evidence_store.hpp>
#include <talus/costmap/evidence/local_ground.hpp>

namespace talus::costmap {

namespace {

constexpr double kSurest = 0.025;  // least standard deviation of a reading [-]
constexpr double kModel =
    0.02;  // error of thesis Eq. 3.12 for drawbar pull over load, common to all readings of a place [-]
constexpr double kReferenceStd = 0.05;  // standard deviation of a reading that counts as one sample [-]
// Shared error of unverified readings at the reference slip, those of a sound slip sensor before its offset and scale
// are estimated; and the error above which readings count as unverified (ours).
constexpr double kUnverifiedShared = 0.03, kMostShared = 0.25;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

double real(std::int64_t value) noexcept {
  return static_cast<double>(value) / SourceReadings::kUnit;
}

}  // namespace

double SourcePull::variance() const noexcept {
  return kModel * kModel + 1.0 / weight;
}

void SourceReadings::addPull(const Estimate& of, double shared_std) noexcept {
  const double std = std::max(of.std, kSurest), w = 1.0 / (std * std);
  weight += fixedPoint(w);
  pull += fixedPoint(w * of.value);
  shared += fixedPoint(w * shared_std);
}

void SourceReadings::addSinkage(double sinkage_over_radius) noexcept {
  ++sinkages;
  sinkage += fixedPoint(sinkage_over_radius);
}

void SourceReadings::add(const SourceReadings& other, int sign) noexcept {
  for (std::int64_t SourceReadings::*const sum :
       {&SourceReadings::weight, &SourceReadings::pull, &SourceReadings::shared, &SourceReadings::sinkages,
        &SourceReadings::sinkage})
    this->*sum += sign * other.*sum;
  updated_s = std::max(updated_s, other.updated_s);
  if (sign > 0)
    bound.join(other.bound);
  else if (other.bound.any())
    bound = {};
}

std::vector<SourcePull> BlockEvidence::pulls() const {
  std::vector<SourcePull> pulls;
  for (const auto& [source, of] : sources)
    if (const double w = real(of.weight); w > 0.0)
      pulls.push_back({source, w, real(of.pull) / w, static_cast<double>(of.updated_s), real(of.shared) / w});
  return pulls;
}

std::uint32_t BlockEvidence::updated_s() const noexcept {
  std::uint32_t newest = 0;
  for (const auto& [source, of] : sources) newest = std::max(newest, of.updated_s);
  return newest;
}

double BlockEvidence::pull() const {
  double weight = 0.0, pull = 0.0;
  for (const auto& [source, of] : sources) {
    weight += real(of.weight);
    pull += real(of.pull);
  }
  return weight > 0.0 ? pull / weight : kNone;
}

double BlockEvidence::samples() const noexcept {
  double weight = 0.0;
  for (const auto& [source, of] : sources) weight += real(of.weight);
  return weight * kReferenceStd * kReferenceStd;
}

bool BlockEvidence::sinkageVerified() const noexcept {
  return std::ranges::any_of(
      sources, [](const auto& of) { return of.first.trust != Trust::Unverified && of.second.sinkages > 0; });
}

double BlockEvidence::sinkage() const noexcept {
  const bool verified = sinkageVerified();
  SourceReadings all;
  for (const auto& [source, of] : sources)
    if ((source.trust != Trust::Unverified) == verified) all.add(of, 1);
  return all.sinkages > 0 ? real(all.sinkage) / static_cast<double>(all.sinkages) : kNone;
}

GroundBound BlockEvidence::bound() const noexcept {
  GroundBound bound;
  for (const auto& [source, of] : sources) bound.join(of.bound);
  return bound;
}

namespace {

constexpr double kFarthestReach_m = 25.5;  // greatest value of BlockEvidence::reach
std::uint32_t secondsOf(double time_s) noexcept {
  return time_s > 0.0 && time_s < 4294967295.0 ? static_cast<std::uint32_t>(time_s) : 0U;
}

}  // namespace

EvidenceField::EvidenceField(std::shared_ptr<const GroundSite> site)
    : site_(std::move(site)), store_(std::make_unique<EvidenceStore>(site_)) {}

EvidenceField::~EvidenceField() = default;
EvidenceField::EvidenceField(EvidenceField&&) noexcept = default;
EvidenceField& EvidenceField::operator=(EvidenceField&&) noexcept = default;

int EvidenceField::blockCells() const noexcept {
  return store_->blocks.side();
}

// Adds or removes readings of a block and updates what the block contributes to its class. A block counts as its
// side over the integral scale (2/3 of the correlation length), at most 1 place. Returns the cells whose estimate may
// change.
maps::CellBox EvidenceField::count(const SavedBlock& readings, int sign) {
  const int class_index = site_->model->classIndex(readings.block.terrain_class);
  ClassEvidence& of_class = store_->classes[static_cast<std::size_t>(class_index)];
  const GroundBelief& prior = site_->model->prior(class_index);
  const double places =
      std::min(1.0, 1.5 * store_->blocks.side_m() / site_->model->parts().policy.correlation_length_m);
  BlockEvidence& block = store_->evidence[readings.block];
  const auto contribute = [&](int by) {
    of_class.count(block.pulls(), prior.pull.value, places, by);
    if (block.sinkageVerified()) of_class.countSinkage(block.sinkage() - prior.sinkage.value, places, by);
  };
  contribute(-1);
  for (const auto& [source, added] : readings.evidence.sources) {
    if (sign < 0 && !block.sources.contains(source)) continue;
    const auto own = block.sources.try_emplace(source).first;
    own->second.add(added, sign);
    if (own->second.empty()) block.sources.erase(own);
  }
  contribute(1);
  block.reach = std::max(block.reach, readings.evidence.reach);
  const double reach_m = block.reach_m();
  if (block.sources.empty()) store_->evidence.erase(readings.block);
  return store_->reach.add(readings.block, reach_m);
}

// True if all ground within kPoseReach standard deviations of the position is of the class.
bool EvidenceField::standsOnOneClass(const WheelObservation& observation, int class_index) const {
  const maps::Grid& grid = site_->grid();
  const double reach_m = kPoseReach * observation.pose_std_m;
  if (reach_m > kFarthestReach_m) return false;
  const int reach = static_cast<int>(std::ceil(reach_m / grid.resolution_m));
  const auto here = *grid.cellAt(observation.place);
  for (int row = std::max(here.row - reach, 0); row <= std::min(here.row + reach, grid.height - 1); ++row)
    for (int column = std::max(here.column - reach, 0);
         column <= std::min(here.column + reach, grid.width - 1); ++column) {
      const maps::Point centre = grid.centre({column, row});
      const bool near = std::abs(centre.x_m - observation.place.x_m) <= reach_m + 0.5 * grid.resolution_m &&
                        std::abs(centre.y_m - observation.place.y_m) <= reach_m + 0.5 * grid.resolution_m;
      if (near && site_->classIndex({column, row}) != class_index) return false;
    }
  return true;
}

std::optional<maps::CellBox> EvidenceField::add(const WheelObservation& observation) {
  const auto readings = readingsOf(observation);
  return readings ? std::optional(count(*readings, 1)) : std::nullopt;
}

std::optional<maps::CellBox> EvidenceField::forget(const SavedBlock& readings) {
  if (!store_->evidence.contains(readings.block)) return std::nullopt;
  return count(readings, -1);
}

std::optional<SavedBlock> EvidenceField::readingsOf(const WheelObservation& observation) const {
  const maps::Grid& grid = site_->grid();
  const auto cell = grid.cellAt(observation.place);
  if (!cell) return std::nullopt;
  const int class_index = site_->classIndex(*cell);
  if (class_index < 0 || !(std::isfinite(observation.pull.value) || observation.here.any()))
    return std::nullopt;
  const bool sure = observation.pose_std_m <= 0.0 || standsOnOneClass(observation, class_index);
  const double correlation_length_m = site_->model->parts().policy.correlation_length_m;
  SavedBlock readings{.block = store_->topOf(*cell, class_index), .evidence = {}};
  BlockEvidence& evidence = readings.evidence;
  evidence.reach = static_cast<std::uint8_t>(
      std::clamp(std::ceil(10.0 * kPoseReach * observation.pose_std_m - 1e-9), 0.0, 255.0));
  const Source unverified{observation.drive, Trust::Unverified};
  if (observation.here.any()) evidence.sources[unverified].bound = observation.here;
  // The measured ground may lie one position error away, and correlates with the ground here by `alike`. The
  // variance of the class that this correlation does not explain is added.
  Estimate pull = observation.pull;
  const double alike = sparseKernel(observation.pose_std_m, correlation_length_m);
  pull.std = std::hypot(pull.std, store_->groundClass(class_index).pull_std * std::sqrt(1.0 - alike * alike));
  const bool verified =
      sure && observation.trust != Trust::Unverified && observation.shared_std <= kMostShared;
  if (observation.estimates())
    evidence.sources[verified ? Source{observation.drive, observation.trust} : unverified].addPull(
        pull, verified ? observation.shared_std : kUnverifiedShared / std::fmax(0.1, observation.share));
  if (std::isfinite(observation.sinkage.std))
    evidence.sources[sure ? Source{observation.drive, observation.trust} : unverified].addSinkage(
        observation.sinkage.value);
  for (auto& [source, of] : evidence.sources) of.updated_s = secondsOf(observation.time_s);
  return readings;
}

void EvidenceField::visit(const std::function<void(const SavedBlock&)>& visit) const {
  for (const auto& [block, evidence] : store_->evidence) visit({block, evidence});
}

std::optional<maps::CellBox> EvidenceField::restore(const SavedBlock& saved) {
  if (saved.block.column < 0 || saved.block.row < 0 || saved.block.column >= store_->blocks.columns() ||
      saved.block.row >= store_->blocks.rows() || site_->model->classIndex(saved.block.terrain_class) < 0)
    return std::nullopt;
  return count(saved, 1);
}

const BlockEvidence* EvidenceField::evidence(maps::Cell cell) const noexcept {
  const int class_index = site_->classIndex(cell);
  if (class_index < 0) return nullptr;
  const auto found = store_->evidence.find(store_->topOf(cell, class_index));
  return found == store_->evidence.end() ? nullptr : &found->second;
}

double EvidenceField::newest_s() const noexcept {
  std::uint32_t newest = 0;
  for (const auto& [block, of] : store_->evidence)
    if (store_->groundClass(site_->model->classIndex(block.terrain_class)).soil.correlation_time_s > 0.0)
      newest = std::max(newest, of.updated_s());
  return newest;
}

std::vector<ClassState> EvidenceField::states() const {
  std::vector<ClassState> all;
  for (int i = 0; i < static_cast<int>(store_->classes.size()); ++i) all.push_back(stateOf(i));
  return all;
}

ClassState EvidenceField::stateOf(int class_index) const {
  constexpr double kStep =
      0.005;  // rounding step of class states, so that they are constant under small changes
  return store_->classes[static_cast<std::size_t>(class_index)].state(kStep);
}

GroundBelief EvidenceField::classBelief(int class_index) const {
  return classGround(*site_->model, {class_index, stateOf(class_index)});
}

std::vector<maps::CellBox> EvidenceField::reached() const {
  return store_->reach.boxes();
}

}  // namespace talus::costmap
