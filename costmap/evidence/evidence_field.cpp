#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include <talus/costmap/evidence/evidence_field.hpp>
#include <talus/costmap/evidence/evidence_store.hpp>
#include <talus/costmap/evidence/ground_inference.hpp>

namespace talus::costmap {
namespace {

constexpr double kFarthestReach_m = 25.5;  // greatest value of BlockEvidence::reach
constexpr double kPlaceStd = 0.06;         // standard deviation of drawbar pull over load up to which a block
                                           // counts as measured [-]

// Returns the drive of the readings that may raise an estimate; 0 if the number of such drives is not 1.
std::uint16_t driveOf(std::span<const ReadingCount> counts) noexcept {
  std::uint16_t drive = 0;
  for (const ReadingCount& c : counts) {
    if (c.kind >= reading_kind::kPullLowers) continue;
    if (drive != 0 && c.drive != drive) return 0;
    drive = c.drive;
  }
  return drive;
}

std::uint32_t secondsOf(double time_s) noexcept {
  return time_s > 0.0 && time_s < 4294967295.0 ? static_cast<std::uint32_t>(time_s) : 0U;
}

}  // namespace

EvidenceField::EvidenceField(std::shared_ptr<const GroundSite> site)
    : site_(std::move(site)), store_(std::make_unique<EvidenceStore>(site_)) {}

EvidenceField::~EvidenceField() = default;
EvidenceField::EvidenceField(EvidenceField&&) noexcept = default;
EvidenceField& EvidenceField::operator=(EvidenceField&&) noexcept = default;

const ClassPosterior& EvidenceField::posterior(int class_index) const {
  return store_->contributions[static_cast<std::size_t>(class_index)].posterior();
}

int EvidenceField::blockCells() const noexcept {
  return store_->blocks.side();
}

// Contribution of a block to its class. The weight is at most the side of the block over the integral scale
// (2/3 of the correlation length), and at most 1. The departure from the class mean is limited to
// kOrdinary standard deviations: a block that departs more is assumed to be on another soil, which the class
// raster does not show.
BlockContribution EvidenceField::lessonOf(const BlockEvidence& block, int class_index) const {
  const GroundClass& ground = store_->groundClass(class_index);
  const GroundBelief prior = site_->model->prior(class_index);
  const bool raises = !std::isnan(block.pull);
  const double measured = static_cast<double>(raises ? block.variance : block.weak_variance);
  double pull = raises ? static_cast<double>(block.pull) - prior.pull.value : 0.0;
  if (block.lowers) pull = std::min(pull, static_cast<double>(block.weak_pull) - prior.pull.value);
  const double variance = ground.pull_std * ground.pull_std;
  const double most = kOrdinary * std::sqrt(variance + ground.mean_std * ground.mean_std + measured);
  BlockContribution contribution{
      .weight =
          std::min(1.0, 1.5 * store_->blocks.side_m() / site_->model->parts().policy.correlation_length_m) *
          variance / (variance + measured),
      .pull = std::clamp(pull, -most, most),
      .sinkage = std::nullopt,
      .raises = raises,
      .shared = raises ? static_cast<double>(block.shared) : 0.0};
  if (std::isnan(block.sinkage)) return contribution;
  const double most_sinkage = kOrdinary * ground.sinkage_std;
  const double sinkage = static_cast<double>(block.sinkage) - prior.sinkage.value;
  contribution.sinkage = std::clamp(sinkage, block.sinkage_raises ? -most_sinkage : 0.0, most_sinkage);
  contribution.sinkage_raises = block.sinkage_raises;
  return contribution;
}

// Returns one contribution of all readings, with the lowest weak pull of any drive, if some readings may
// raise an estimate. Otherwise returns one contribution for each drive, so that no drive reduces the effect
// of another.
std::vector<BlockContribution> EvidenceField::contributionsOf(const BlockLevel& where,
                                                              const BlockEvidence& block,
                                                              int class_index) const {
  std::vector<BlockContribution> contributions;
  if (std::isnan(block.weak_pull)) return contributions;
  const std::vector<ReadingCount> counts = store_->bricks.counts(where);
  const std::vector<std::uint16_t> drives = drivesOf(counts);
  const bool raises = !std::isnan(block.pull);
  BlockEvidence all = block;
  if (drives.size() > 1)
    for (const std::uint16_t drive : drives) {
      BlockEvidence own = block;
      summarise(ofDrive(counts, drive), priorOf(class_index), own);
      if (std::isnan(own.weak_pull)) continue;
      all.weak_pull = std::min(all.weak_pull, own.weak_pull);
      if (raises) continue;
      contributions.push_back(lessonOf(own, class_index));
      contributions.back().drive = drive;
    }
  if (!contributions.empty()) return contributions;
  contributions.push_back(lessonOf(all, class_index));
  contributions.back().drive = raises ? driveOf(counts) : drives.front();
  return contributions;
}

Estimate EvidenceField::priorOf(int class_index) const {
  return {site_->model->prior(class_index).pull.value, store_->groundClass(class_index).pull_std};
}

// Least departure of a square's blocks from the class, over blocks that are measured to kPlaceStd or lie
// below the prior by more than their standard deviation. -infinity if no block is measured to kPlaceStd;
// nullopt if the square has no readings.
std::optional<float> EvidenceField::squareStrength(const IndependentPlaces::Square& square,
                                                   int class_index) const {
  const int side = store_->blocks.reach();
  const double prior = site_->model->prior(class_index).pull.value;
  bool driven = false, raises = false;
  double least = std::numeric_limits<double>::infinity();
  const int number = store_->groundClass(class_index).number;
  const auto take = [&](const BlockLevel& at, const BlockEvidence& e) {
    if (at.terrain_class != number || std::isnan(e.weak_pull)) return;
    driven = true;
    const double pull = static_cast<double>(e.pull) - prior, variance = static_cast<double>(e.variance);
    const bool is_known = variance <= kPlaceStd * kPlaceStd;
    raises |= is_known;
    if (is_known || pull < -std::sqrt(variance)) least = std::fmin(least, pull);
    if (e.lowers) least = std::fmin(least, static_cast<double>(e.weak_pull) - prior);
  };
  for (int row = square.second * side; row < (square.second + 1) * side; ++row)
    for (int column = square.first * side; column < (square.first + 1) * side; ++column)
      store_->bricks.visitLevels(column, row, take);
  if (!driven) return std::nullopt;
  return raises ? static_cast<float>(least) : -std::numeric_limits<float>::infinity();
}

// Adds or removes readings of a block and updates the block's contributions to its class. Returns the cells
// whose estimate may change.
maps::CellBox EvidenceField::count(const BlockLevel& where, const SavedBlock& readings, Count how) {
  const int class_index = site_->model->classIndex(where.terrain_class);
  ClassEvidence& contributions = store_->contributions[static_cast<std::size_t>(class_index)];
  if (const BlockEvidence* known = store_->bricks.find(where))
    for (const BlockContribution& before : contributionsOf(where, *known, class_index))
      contributions.remove(before);
  for (const ReadingCount& reading : readings.counts)
    how == Count::Add ? store_->bricks.count(where, reading) : store_->bricks.uncount(where, reading);
  BlockEvidence& block = store_->bricks.at(where);
  block.updated_s = std::max(block.updated_s, readings.updated_s);
  block.reach = std::max(block.reach, readings.reach);
  summarise(store_->bricks.counts(where), priorOf(class_index), block);
  const maps::CellBox reached = store_->reach.add(where, block.reach_m());
  const std::vector<BlockContribution> taught = contributionsOf(where, block, class_index);
  if (taught.empty() && how == Count::Add) return reached;
  for (const BlockContribution& contribution : taught) contributions.add(contribution);
  const IndependentPlaces::Square square{where.column / store_->blocks.reach(),
                                         where.row / store_->blocks.reach()};
  contributions.places().set(square, squareStrength(square, class_index));
  contributions.refresh();
  return reached;
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
  SavedBlock estimates = readings;
  std::erase_if(estimates.counts, [](const ReadingCount& c) {
    return c.kind == reading_kind::kMostPullHere || c.kind == reading_kind::kLeastSinkageHere;
  });
  return count(estimates.block, estimates, Count::TakeOff);
}

std::optional<SavedBlock> EvidenceField::readingsOf(const WheelObservation& observation) const {
  const maps::Grid& grid = site_->grid();
  const auto cell = grid.cellAt(observation.place);
  if (!cell) return std::nullopt;
  const int class_index = site_->classIndex(*cell);
  if (class_index < 0 || !(observation.estimates() || observation.here.any())) return std::nullopt;
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
  const bool raises = sure && observation.pull_may_raise;
  if (raises)
    pull.std =
        std::hypot(pull.std, store_->groundClass(class_index).pull_std * std::sqrt(1.0 - alike * alike));
  if (observation.estimates()) readings.counts.push_back(pullReading(pull, raises, observation.shared_std));
  if (std::isfinite(observation.sinkage.std))
    readings.counts.push_back(
        sinkageReading(observation.sinkage.value, sure && observation.sinkage_may_raise));
  for (ReadingCount& count : readings.counts) count.drive = observation.drive;
  return readings;
}

void EvidenceField::visit(const std::function<void(const SavedBlock&)>& visit) const {
  store_->bricks.visitAll([&](const BlockLevel& at, const BlockEvidence& e) {
    visit({.block = at, .updated_s = e.updated_s, .reach = e.reach, .counts = store_->bricks.counts(at)});
  });
}

std::optional<maps::CellBox> EvidenceField::restore(const SavedBlock& saved) {
  if (saved.block.level != BlockEvidence::kTop || saved.block.column < 0 || saved.block.row < 0 ||
      saved.block.column >= store_->blocks.columns() || saved.block.row >= store_->blocks.rows() ||
      site_->model->classIndex(saved.block.terrain_class) < 0)
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

std::vector<ClassState> EvidenceField::states(Classes classes) const {
  std::vector<ClassState> all;
  for (int i = 0; i < static_cast<int>(store_->contributions.size()); ++i) all.push_back(stateOf(i, classes));
  return all;
}

ClassState EvidenceField::stateOf(int class_index, Classes classes) const {
  const ClassEvidence& contributions = store_->contributions[static_cast<std::size_t>(class_index)];
  return classes == Classes::InSteps ? contributions.stateInSteps() : contributions.state();
}

GroundBelief EvidenceField::classBelief(int class_index, Classes classes) const {
  return classGround(*site_->model, {class_index, stateOf(class_index, classes)});
}

std::vector<maps::CellBox> EvidenceField::reached() const {
  return store_->reach.boxes();
}

}  // namespace talus::costmap
