#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>
#include <utility>

#include <talus/costmap/evidence/evidence.hpp>
#include <talus/costmap/evidence/evidence_store.hpp>
#include <talus/costmap/evidence/local_ground.hpp>

namespace talus::costmap {

namespace {

namespace kind = reading_kind;

constexpr double kStep = 0.01;
constexpr double kLowest = -1.28;
constexpr double kSurest = 0.025;  // standard deviation of grade 0 [-]
constexpr double kModel =
    0.02;  // error of thesis Eq. 3.12 for drawbar pull over load, common to all readings of a place [-]
constexpr double kReferenceStd = 0.05;  // standard deviation of a reading that counts as one sample [-]
constexpr double kLeastShared = 0.02, kSharedStep = 1.5;
// Shared error of unverified readings, those of a sound slip sensor before its offset and scale are estimated
// (ours).
constexpr double kUnverifiedShared = 0.03;

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

double stdOf(std::size_t grade) noexcept {
  return kSurest * std::exp2(0.5 * static_cast<double>(grade));
}

std::uint8_t stepped(double steps) noexcept {
  return static_cast<std::uint8_t>(std::clamp(steps, 0.0, 255.0));
}

double pullOf(std::uint8_t step) noexcept {
  return kLowest + kStep * step;
}
// Returns the pull of a bound. Step 0 represents all lower pulls and returns -10.
double mostPullOf(std::uint8_t step) noexcept {
  constexpr double kLeast = -10.0;
  return step == 0 ? kLeast : pullOf(step);
}
double sinkageOf(std::uint8_t step) noexcept {
  return kStep * step;
}

// Both grades of a kind of pulls, g + 8 h.
std::size_t gradesOf(std::uint8_t of) noexcept {
  return of >= kind::kPullTwice ? std::size_t{of} - kind::kPullTwice : of;
}

// True if a kind is a pull.
bool isPull(std::uint8_t of) noexcept {
  return of < kind::kSinkage || of >= kind::kPullTwice;
}

}  // namespace

double SourcePull::variance() const noexcept {
  return kModel * kModel + 1.0 / weight;
}

double sharedStd(std::size_t grade) noexcept {
  return grade == 0 ? 0.0 : kLeastShared * std::pow(kSharedStep, static_cast<double>(grade) - 1.0);
}

ReadingCount pullReading(const Estimate& pull, Trust trust, double shared_std) noexcept {
  const double grade = std::ceil(2.0 * std::log2(pull.std / kSurest) - 1e-9);
  const double clamped = grade > 0.0 ? std::min(grade, kind::kGrades - 1.0) : 0.0;
  std::size_t shared = 0;
  while (shared < kind::kSharedGrades && !(shared_std <= sharedStd(shared) + 1e-9)) ++shared;
  const bool unverified = trust == Trust::Unverified || shared == kind::kSharedGrades;
  const std::size_t first =
      unverified ? kind::kPullUnverified
                 : (trust == Trust::Twice ? kind::kPullTwice : kind::kPull) + shared * kind::kGrades;
  return {static_cast<std::uint8_t>(static_cast<double>(first) + clamped),
          stepped(std::round((pull.value - kLowest) / kStep)), 1};
}

ReadingCount sinkageReading(double sinkage_over_radius, bool verified) noexcept {
  return {verified ? kind::kSinkage : kind::kSinkageUnverified,
          stepped(std::round(sinkage_over_radius / kStep)), 1};
}

std::vector<ReadingCount> boundReadings(const GroundBound& bound) {
  std::vector<ReadingCount> readings;
  if (!std::isnan(bound.most_pull))
    readings.push_back(
        {kind::kMostPullHere, stepped(std::floor((bound.most_pull - kLowest) / kStep + 1e-6)), 1});
  if (!std::isnan(bound.least_sinkage))
    readings.push_back({kind::kLeastSinkageHere, stepped(std::ceil(bound.least_sinkage / kStep - 1e-6)), 1});
  return readings;
}

std::vector<SourcePull> pullsOf(std::span<const ReadingCount> counts) {
  std::map<Source, SourcePull> sources;
  for (const ReadingCount& c : counts) {
    if (!isPull(c.kind)) continue;
    const bool twice = c.kind >= kind::kPullTwice, unverified = !twice && c.kind >= kind::kPullUnverified;
    const std::size_t grades = gradesOf(c.kind);
    const double std = stdOf(grades % kind::kGrades), w = c.count / (std * std);
    SourcePull& one = sources[{c.drive, unverified ? Trust::Unverified : twice ? Trust::Twice : Trust::Once}];
    one.weight += w;
    one.pull += w * pullOf(c.step);
    one.shared += w * (unverified ? kUnverifiedShared : sharedStd(grades / kind::kGrades));
  }
  std::vector<SourcePull> pulls;
  for (auto& [source, one] : sources)
    pulls.push_back({source, one.weight, one.pull / one.weight, one.shared / one.weight});
  return pulls;
}

void summarise(std::span<const ReadingCount> counts, BlockEvidence& block) {
  block.pull = block.sinkage = block.most_pull = block.least_sinkage = kNone;
  double weight = 0.0, pull = 0.0, depths = 0.0, depth = 0.0;
  for (const SourcePull& one : pullsOf(counts)) {
    weight += one.weight;
    pull += one.weight * one.pull;
  }
  if (weight > 0.0) block.pull = static_cast<float>(pull / weight);
  block.sinkage_verified = std::ranges::any_of(counts, [](auto& c) { return c.kind == kind::kSinkage; });
  for (const ReadingCount& c : counts) {
    if (c.kind == (block.sinkage_verified ? kind::kSinkage : kind::kSinkageUnverified)) {
      depths += c.count;
      depth += c.count * sinkageOf(c.step);
    }
    if (c.kind == kind::kMostPullHere)
      block.most_pull = std::fmin(block.most_pull, static_cast<float>(mostPullOf(c.step)));
    if (c.kind == kind::kLeastSinkageHere)
      block.least_sinkage = std::fmax(block.least_sinkage, static_cast<float>(sinkageOf(c.step)));
  }
  if (depths > 0.0) block.sinkage = static_cast<float>(depth / depths);
}

double samples(std::span<const ReadingCount> counts) noexcept {
  double sum = 0.0;
  for (const ReadingCount& c : counts) {
    if (!isPull(c.kind)) continue;
    const double std = stdOf(gradesOf(c.kind) % kind::kGrades);
    sum += c.count * kReferenceStd * kReferenceStd / (std * std);
  }
  return sum;
}

namespace {

constexpr int kShift = 3;  // log2 of the side of a brick in blocks
constexpr int kMask = (1 << kShift) - 1;

// Sort key within a brick: place, class.
std::uint32_t keyOf(const BlockOfClass& block) noexcept {
  const auto place = static_cast<std::uint32_t>((block.row & kMask) << kShift | (block.column & kMask));
  return place << 8 | block.terrain_class;
}
std::uint32_t keyOf(const BlockEvidence& e) noexcept {
  return static_cast<std::uint32_t>(e.place_in_brick) << 8 | e.terrain_class;
}

bool before(const BlockEvidence& e, std::uint32_t key) noexcept {
  return keyOf(e) < key;
}

// Grows the capacity by 1/8: doubling would leave up to half of the memory of a large map unused.
template <typename T>
void makeRoom(std::vector<T>& list) {
  if (list.size() == list.capacity()) list.reserve(list.size() + 4 + list.size() / 8);
}

int bricksAcross(int blocks) noexcept {
  return (blocks + kMask) >> kShift;
}

}  // namespace

EvidenceBricks::EvidenceBricks(int block_columns, int block_rows)
    : columns_(block_columns),
      rows_(block_rows),
      brick_columns_(bricksAcross(block_columns)),
      bricks_(static_cast<std::size_t>(brick_columns_) * static_cast<std::size_t>(bricksAcross(block_rows))) {
}

std::size_t EvidenceBricks::brickOf(int column, int row) const noexcept {
  return static_cast<std::size_t>(row >> kShift) * static_cast<std::size_t>(brick_columns_) +
         static_cast<std::size_t>(column >> kShift);
}

const BlockEvidence* EvidenceBricks::find(const BlockOfClass& block) const noexcept {
  if (!contains(block.column, block.row)) return nullptr;
  const auto& blocks = bricks_[brickOf(block.column, block.row)].blocks;
  const std::uint32_t key = keyOf(block);
  const auto found = std::lower_bound(blocks.begin(), blocks.end(), key, before);
  return found != blocks.end() && keyOf(*found) == key ? &*found : nullptr;
}

BlockEvidence& EvidenceBricks::at(const BlockOfClass& block) {
  auto& blocks = bricks_[brickOf(block.column, block.row)].blocks;
  const std::uint32_t key = keyOf(block);
  auto found = std::lower_bound(blocks.begin(), blocks.end(), key, before);
  if (found != blocks.end() && keyOf(*found) == key) return *found;
  const auto place = found - blocks.begin();
  makeRoom(blocks);
  return *blocks.insert(blocks.begin() + place, {.terrain_class = block.terrain_class,
                                                 .place_in_brick = static_cast<std::uint8_t>(key >> 8)});
}

void EvidenceBricks::erase(const BlockOfClass& block) {
  std::erase_if(bricks_[brickOf(block.column, block.row)].blocks,
                [key = keyOf(block)](const BlockEvidence& e) { return keyOf(e) == key; });
}

std::vector<ReadingCount> EvidenceBricks::counts(const BlockOfClass& block) const {
  std::vector<ReadingCount> out;
  if (!contains(block.column, block.row)) return out;
  const auto& readings = bricks_[brickOf(block.column, block.row)].readings;
  const std::uint32_t key = keyOf(block);
  const auto first = std::lower_bound(readings.begin(), readings.end(), key,
                                      [](const BlockReadings& h, std::uint32_t k) { return h.block < k; });
  for (auto at = first; at != readings.end() && at->block == key; ++at) out.push_back(at->reading);
  return out;
}

std::uint64_t EvidenceBricks::orderOf(const BlockReadings& readings) noexcept {
  return static_cast<std::uint64_t>(readings.block) << 32 |
         static_cast<std::uint64_t>(readings.reading.kind) << 24 |
         static_cast<std::uint64_t>(readings.reading.step) << 16 | readings.reading.drive;
}

// Position of a count in the sorted list, or the position at which to insert the count.
std::vector<EvidenceBricks::BlockReadings>::iterator EvidenceBricks::placeOf(
    std::vector<BlockReadings>& readings, const BlockReadings& one) {
  return std::lower_bound(readings.begin(), readings.end(), orderOf(one),
                          [](const BlockReadings& h, std::uint64_t key) { return orderOf(h) < key; });
}

void EvidenceBricks::uncount(const BlockOfClass& block, const ReadingCount& reading) {
  auto& readings = bricks_[brickOf(block.column, block.row)].readings;
  const BlockReadings taken{keyOf(block), reading};
  const auto found = placeOf(readings, taken);
  if (found == readings.end() || orderOf(*found) != orderOf(taken)) return;
  std::uint16_t& count = found->reading.count;
  if (count == std::numeric_limits<std::uint16_t>::max() && reading.count < count) return;
  count = static_cast<std::uint16_t>(count - std::min(count, reading.count));
  if (count == 0) readings.erase(found);
}

void EvidenceBricks::count(const BlockOfClass& block, const ReadingCount& reading) {
  auto& readings = bricks_[brickOf(block.column, block.row)].readings;
  const BlockReadings added{keyOf(block), reading};
  const auto found = placeOf(readings, added);
  if (found != readings.end() && orderOf(*found) == orderOf(added)) {
    const unsigned sum = found->reading.count + static_cast<unsigned>(reading.count);
    found->reading.count =
        static_cast<std::uint16_t>(std::min<unsigned>(sum, std::numeric_limits<std::uint16_t>::max()));
    return;
  }
  const auto at = found - readings.begin();
  makeRoom(readings);
  readings.insert(readings.begin() + at, added);
}

void EvidenceBricks::visit(const Box& box, const Visit& visit) const {
  const int west = std::max(box.west, 0), east = std::min(box.east, columns_ - 1);
  const int south = std::max(box.south, 0), north = std::min(box.north, rows_ - 1);
  for (int y = south >> kShift; y <= north >> kShift; ++y)
    for (int x = west >> kShift; x <= east >> kShift; ++x)
      for (const BlockEvidence& e : bricks_[brickOf(x << kShift, y << kShift)].blocks) {
        const int column = (x << kShift) + (e.place_in_brick & kMask);
        const int row = (y << kShift) + (e.place_in_brick >> kShift);
        if (column >= west && column <= east && row >= south && row <= north)
          visit({column, row, e.terrain_class}, e);
      }
}

void EvidenceBricks::visitAll(const Visit& visit) const {
  for (int row = 0; row < rows_; ++row)
    for (int column = 0; column < columns_; ++column) this->visit({column, row, column, row}, visit);
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
