#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include <talus/costmap/evidence/evidence.hpp>
#include <talus/costmap/evidence/evidence_store.hpp>
#include <talus/costmap/evidence/local_ground.hpp>

namespace talus::costmap {
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

// Adds or removes readings of a block and updates what the block contributes to its class. A block counts as
// its side over the integral scale (2/3 of the correlation length), at most 1 place. Returns the cells whose
// estimate may change.
maps::CellBox EvidenceField::count(const BlockOfClass& where, const SavedBlock& readings, Count how) {
  const int class_index = site_->model->classIndex(where.terrain_class);
  ClassEvidence& of_class = store_->classes[static_cast<std::size_t>(class_index)];
  const GroundBelief& prior = site_->model->prior(class_index);
  const double places =
      std::min(1.0, 1.5 * store_->blocks.side_m() / site_->model->parts().policy.correlation_length_m);
  const auto contribute = [&](const BlockEvidence& block, int sign) {
    of_class.count(pullsOf(store_->bricks.counts(where)), prior.pull.value, places, sign);
    const double deeper = static_cast<double>(block.sinkage) - prior.sinkage.value;
    if (block.sinkage_verified) of_class.countSinkage(deeper, places, sign);
  };
  if (const BlockEvidence* known = store_->bricks.find(where)) contribute(*known, -1);
  for (const ReadingCount& reading : readings.counts)
    how == Count::Add ? store_->bricks.count(where, reading) : store_->bricks.uncount(where, reading);
  BlockEvidence& block = store_->bricks.at(where);
  block.updated_s = std::max(block.updated_s, readings.updated_s);
  block.reach = std::max(block.reach, readings.reach);
  const double reach_m = block.reach_m();
  if (store_->bricks.counts(where).empty()) {
    store_->bricks.erase(where);
  } else {
    summarise(store_->bricks.counts(where), block);
    contribute(block, 1);
  }
  return store_->reach.add(where, reach_m);
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
  return readings ? std::optional(count(readings->block, *readings)) : std::nullopt;
}

std::optional<maps::CellBox> EvidenceField::forget(const SavedBlock& readings) {
  if (!store_->bricks.find(readings.block)) return std::nullopt;
  return count(readings.block, readings, Count::TakeOff);
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
  SavedBlock readings{.block = store_->topOf(*cell, class_index),
                      .updated_s = secondsOf(observation.time_s),
                      .reach = static_cast<std::uint8_t>(std::clamp(
                          std::ceil(10.0 * kPoseReach * observation.pose_std_m - 1e-9), 0.0, 255.0)),
                      .counts = boundReadings(observation.here)};
  // The measured ground may lie one position error away, and correlates with the ground here by `alike`. The
  // variance of the class that this correlation does not explain is added.
  Estimate pull = observation.pull;
  const double alike = sparseKernel(observation.pose_std_m, correlation_length_m);
  const Trust trust = sure ? observation.trust : Trust::Unverified;
  pull.std = std::hypot(pull.std, store_->groundClass(class_index).pull_std * std::sqrt(1.0 - alike * alike));
  if (observation.estimates()) readings.counts.push_back(pullReading(pull, trust, observation.shared_std));
  if (std::isfinite(observation.sinkage.std))
    readings.counts.push_back(
        sinkageReading(observation.sinkage.value, sure && observation.sinkage_verified));
  for (ReadingCount& count : readings.counts) count.drive = observation.drive;
  return readings;
}

void EvidenceField::visit(const std::function<void(const SavedBlock&)>& visit) const {
  store_->bricks.visitAll([&](const BlockOfClass& at, const BlockEvidence& e) {
    visit({.block = at, .updated_s = e.updated_s, .reach = e.reach, .counts = store_->bricks.counts(at)});
  });
}

std::optional<maps::CellBox> EvidenceField::restore(const SavedBlock& saved) {
  if (saved.block.column < 0 || saved.block.row < 0 || saved.block.column >= store_->blocks.columns() ||
      saved.block.row >= store_->blocks.rows() || site_->model->classIndex(saved.block.terrain_class) < 0)
    return std::nullopt;
  return count(saved.block, saved);
}

const BlockEvidence* EvidenceField::evidence(maps::Cell cell) const noexcept {
  const int class_index = site_->classIndex(cell);
  return class_index < 0 ? nullptr : store_->bricks.find(store_->topOf(cell, class_index));
}

double EvidenceField::samplesOf(maps::Cell cell) const {
  const int class_index = site_->classIndex(cell);
  return class_index < 0 ? 0.0 : samples(store_->bricks.counts(store_->topOf(cell, class_index)));
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
