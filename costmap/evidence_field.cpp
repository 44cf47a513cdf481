#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <talus/costmap/evidence_field.hpp>

namespace talus::costmap {
namespace {

constexpr double kBlocksPerLength = 4.0;
constexpr double kReferenceStd = 0.05;   // of the sample that counts as one
constexpr double kMostPerSample = 25.0;  // no sample counts for more
constexpr double kNugget =
    0.01;  // of a block's mean however many samples it has: ground varies inside it too
constexpr std::size_t kMostNeighbours = 64;
constexpr double kFreedom = 4.0;              // of Student's t
constexpr double kContradicts = 1.5;          // standard deviations
constexpr std::size_t kMostRemembered = 512;  // patches
constexpr double kUnit = 1048576.0;           // of the fixed-point sums
constexpr double kSteepest =
    0.6;  // gradient of ground that joins places of one floor: more than rovers drive

int shiftFor(double correlation_length_m, double resolution_m) {
  const double cells = correlation_length_m / kBlocksPerLength / resolution_m;
  return std::clamp(static_cast<int>(std::floor(std::log2(std::max(cells, 1.0)))), 0, 8);
}

std::int64_t fixed(double value) {
  return static_cast<std::int64_t>(std::llround(value * kUnit));
}

}  // namespace

EvidenceField::EvidenceField(std::shared_ptr<const GroundSite> site)
    : site_(std::move(site)),
      block_shift_(
          shiftFor(site_->model->parts().policy.correlation_length_m, site_->keys.grid().resolution_m)),
      first_block_(blockOf({0, 0})),
      bricks_([this] {
        const maps::Grid& grid = site_->grid();
        const BlockLevel last = topOf(blockOf({grid.width - 1, grid.height - 1}));
        return EvidenceBricks(last.column + 1, last.row + 1);
      }()),
      sums_(site_->model->parts().classes.size()),
      posteriors_(site_->model->parts().classes.size()) {
  for (std::size_t i = 0; i < posteriors_.size(); ++i) refresh(static_cast<int>(i));
}

maps::Cell EvidenceField::cellOf(const BlockLevel& block) const noexcept {
  return {first_block_.column + block.column * (1 << block_shift_),
          first_block_.row + block.row * (1 << block_shift_)};
}

BlockLevel EvidenceField::topOf(maps::Cell block) const noexcept {
  return {(block.column - first_block_.column) >> block_shift_,
          (block.row - first_block_.row) >> block_shift_, BlockEvidence::kTop};
}

// Blocks lie on the octree's own lines: a block is named by its south-west cell, which may lie outside the
// grid.
maps::Cell EvidenceField::blockOf(maps::Cell cell) const noexcept {
  const octomap::OcTreeKey first = site_->keys.key({0, 0}, site_->keys.baseElevation_m());
  const auto snapped = [&](int value, int origin) {
    return static_cast<int>((static_cast<unsigned>(origin + value) >> block_shift_) << block_shift_) - origin;
  };
  return {snapped(cell.column, first[0]), snapped(cell.row, first[1])};
}

maps::Point EvidenceField::middleOf(maps::Cell block) const noexcept {
  const maps::Grid& grid = site_->keys.grid();
  const double half = 0.5 * (1 << block_shift_);
  return {grid.south_west.x_m + (block.column + half) * grid.resolution_m,
          grid.south_west.y_m + (block.row + half) * grid.resolution_m};
}

std::uint16_t EvidenceField::keyOf(float height_m) const noexcept {
  return site_->keys.key({0, 0}, static_cast<double>(height_m))[2];
}

// Of a block's first cell with an elevation.
std::optional<std::uint16_t> EvidenceField::topKey(maps::Cell block) const noexcept {
  const maps::Grid& grid = site_->grid();
  const int side = 1 << block_shift_;
  for (int row = std::max(block.row, 0); row < std::min(block.row + side, grid.height); ++row)
    for (int column = std::max(block.column, 0); column < std::min(block.column + side, grid.width);
         ++column) {
      const float elevation = site_->elevation.elevation_m[{column, row}];
      if (!std::isnan(elevation)) return keyOf(elevation);
    }
  return std::nullopt;
}

// The block's level of a floor: one that is known within half the headroom, else a new one.
BlockLevel EvidenceField::levelOf(maps::Cell cell, const Floor& floor) const {
  BlockLevel out = topOf(blockOf(cell));
  out.level = keyOf(floor.height_m);
  const int same = std::max(1, static_cast<int>(0.5 * Floors::kHeadroom_m / site_->grid().resolution_m));
  for (const BlockEvidence* known : bricks_.levels(out.column, out.row))
    if (known->level != BlockEvidence::kTop && std::abs(known->level - keyOf(floor.height_m)) <= same)
      out.level = known->level;
  return out;
}

int EvidenceField::reachBlocks() const noexcept {
  const double block_m = (1 << block_shift_) * site_->grid().resolution_m;
  return static_cast<int>(std::ceil(site_->model->parts().policy.correlation_length_m / block_m));
}

double EvidenceField::measuredVariance(const BlockEvidence& block) const noexcept {
  return kReferenceStd * kReferenceStd / static_cast<double>(block.weight) + kNugget * kNugget;
}

// One block speaks for as many independent places as its length holds integral scales (2/3 of the correlation
// length). Ground that departs from its class by much more than the class varies is other ground that no
// class raster shows: it counts for less by the weight of Student's t with four degrees of freedom
// (lange_1989).
void EvidenceField::contribute(const BlockEvidence& block, int class_index, std::int64_t sign) {
  if (block.weight <= 0.0F || (block.level != BlockEvidence::kTop && !site_->classes.empty())) return;
  const GroundClass& ground = site_->model->parts().classes[static_cast<std::size_t>(class_index)];
  const GroundBelief prior = site_->model->prior(class_index);
  const double block_m = (1 << block_shift_) * site_->keys.grid().resolution_m;
  const double places = std::min(1.0, 1.5 * block_m / site_->model->parts().policy.correlation_length_m);
  const double variance = ground.pull_std * ground.pull_std;
  const double departure = static_cast<double>(block.pull) - prior.pull.value;
  const double spread = variance + ground.mean_std * ground.mean_std + measuredVariance(block);
  const double alike = std::min(1.0, (kFreedom + 1.0) / (kFreedom + departure * departure / spread));
  const double weight = alike * places * variance / (variance + measuredVariance(block));
  ClassSums& sums = sums_[static_cast<std::size_t>(class_index)];
  sums.weight += sign * fixed(weight);
  sums.pull += sign * fixed(weight * departure);
  sums.sinkage += sign * fixed(weight * (static_cast<double>(block.sinkage) - prior.sinkage.value));
}

// Conjugate normal update of the class mean: prior mean_std, places that scatter by pull_std about it.
void EvidenceField::refresh(int class_index) {
  const auto i = static_cast<std::size_t>(class_index);
  const GroundClass& ground = site_->model->parts().classes[i];
  ClassPosterior& out = posteriors_[i];
  out.places = static_cast<double>(sums_[i].weight) / kUnit;
  const double variance = ground.pull_std * ground.pull_std;
  const double prior = ground.mean_std * ground.mean_std;
  const double gain = prior / (prior * out.places + variance);
  out.pull = {gain * static_cast<double>(sums_[i].pull) / kUnit,
              std::sqrt(prior * variance / (prior * out.places + variance))};
  const double sinkage_share = ground.sinkage_std / ground.pull_std;
  out.sinkage = {gain * static_cast<double>(sums_[i].sinkage) / kUnit, out.pull.std * sinkage_share};
}

// A block is as weak as its weakest part: what stronger ground in it told before counts no more than the
// sample that contradicts it.
void EvidenceField::weigh(const WheelObservation& observation, BlockEvidence& block) const {
  const double share = kReferenceStd / observation.pull.std;
  const auto weight = static_cast<float>(std::min(share * share, kMostPerSample));
  if (observation.pull.value < static_cast<double>(block.pull) - kContradicts * observation.pull.std)
    block.weight = std::min(block.weight, weight);
  const float gain = weight / (block.weight + weight);
  block.pull += gain * (static_cast<float>(observation.pull.value) - block.pull);
  if (std::isfinite(observation.sinkage.std))
    block.sinkage += gain * (static_cast<float>(observation.sinkage.value) - block.sinkage);
  block.weight += weight;
  block.updated_s = observation.time_s > 0.0 && observation.time_s < 4294967295.0
                        ? static_cast<std::uint32_t>(observation.time_s)
                        : 0U;
}

std::optional<maps::CellBox> EvidenceField::add(const WheelObservation& observation) {
  const maps::Grid& grid = site_->grid();
  const auto cell = grid.cellAt(observation.place);
  if (!cell || std::isnan(site_->elevation.elevation_m[*cell])) return std::nullopt;
  const auto floor = site_->floorAt(*cell, observation.z_m);
  const int class_index = floor ? 0 : site_->classIndex(*cell);
  if (class_index < 0) return std::nullopt;
  const int number = site_->model->parts().classes[static_cast<std::size_t>(class_index)].number;
  const BlockLevel where = floor ? levelOf(*cell, *floor) : topOf(blockOf(*cell));
  const BlockEvidence* known = bricks_.find(where);
  if (known && known->terrain_class != number)
    return std::nullopt;  // a block speaks for the class that was driven first in it
  BlockEvidence& block = bricks_.at(where);
  if (!known) {
    block.terrain_class = static_cast<std::uint8_t>(number);
    block.sinkage = static_cast<float>(site_->model->prior(class_index).sinkage.value);
  }
  contribute(block, class_index, -1);
  weigh(observation, block);
  contribute(block, class_index, 1);
  refresh(class_index);
  const int side = 1 << block_shift_;
  const int reach =
      static_cast<int>(std::ceil(site_->model->parts().policy.correlation_length_m / grid.resolution_m)) +
      side;
  return maps::CellBox{
      {std::max(cell->column - reach, 0), std::max(cell->row - reach, 0)},
      {std::min(cell->column + reach, grid.width - 1), std::min(cell->row + reach, grid.height - 1)}};
}

void EvidenceField::restore(maps::Cell cell, std::uint16_t level, const CellBelief& saved) {
  const int class_index = site_->model->classIndex(saved.terrain_class);
  BlockLevel where = topOf(blockOf(cell));
  where.level = level;
  if (class_index < 0 || saved.evidence <= 0.0F || bricks_.find(where)) return;
  BlockEvidence& block = bricks_.at(where);
  block.weight = saved.evidence;
  block.pull = saved.evidence_pull;
  block.sinkage = saved.evidence_sinkage;
  block.updated_s = saved.updated_s;
  block.terrain_class = saved.terrain_class;
  contribute(block, class_index, 1);
  refresh(class_index);
}

const BlockEvidence* EvidenceField::evidence(maps::Cell cell) const noexcept {
  return bricks_.find(topOf(blockOf(cell)));
}

const BlockEvidence* EvidenceField::evidence(maps::Cell cell, const Floor& floor) const {
  return bricks_.find(levelOf(cell, floor));
}

std::vector<EvidenceField::FloorEvidence> EvidenceField::floorEvidence() const {
  std::vector<FloorEvidence> out;
  std::set<const BlockEvidence*> seen;
  const auto width = static_cast<std::uint32_t>(site_->grid().width);
  for (const Floor& floor : site_->floors.all()) {
    const maps::Cell cell{static_cast<int>(floor.cell % width), static_cast<int>(floor.cell / width)};
    const BlockEvidence* known = evidence(cell, floor);
    if (known && seen.insert(known).second) out.push_back({cell, *known});
  }
  return out;
}

PlaceEvidence EvidenceField::placed(maps::Cell block, const BlockEvidence& evidence,
                                    const GroundBelief& mean) const {
  return {.place = middleOf(block),
          .pull = static_cast<double>(evidence.pull) - mean.pull.value,
          .sinkage = static_cast<double>(evidence.sinkage) - mean.sinkage.value,
          .variance = measuredVariance(evidence)};
}

// Evidence of the class on top that can reach a patch of blocks.
GaussianProcess EvidenceField::process(const BlockLevel& patch, int class_index) const {
  const int number = site_->model->parts().classes[static_cast<std::size_t>(class_index)].number;
  const GroundBelief mean = classBelief(class_index);
  const int reach = reachBlocks();
  std::vector<PlaceEvidence> found;
  bricks_.visitTop({patch.column - reach, patch.row - reach, patch.column + kPatchBlocks + reach - 1,
                    patch.row + kPatchBlocks + reach - 1},
                   [&](const BlockLevel& block, const BlockEvidence& e) {
                     if (e.terrain_class == number) found.push_back(placed(cellOf(block), e, mean));
                   });
  const maps::Point low = middleOf(cellOf(patch));
  const double half_m = 0.5 * kPatchBlocks * (1 << block_shift_) * site_->grid().resolution_m;
  return processOf(std::move(found), {low.x_m + half_m, low.y_m + half_m}, class_index);
}

// Nearest to the middle first where there is more than enough.
GaussianProcess EvidenceField::processOf(std::vector<PlaceEvidence> found, const maps::Point& middle,
                                         int class_index) const {
  if (found.size() > kMostNeighbours) {
    const auto far = [&](const PlaceEvidence& e) {
      return std::hypot(e.place.x_m - middle.x_m, e.place.y_m - middle.y_m);
    };
    std::stable_sort(found.begin(), found.end(),
                     [&](const PlaceEvidence& a, const PlaceEvidence& b) { return far(a) < far(b); });
    found.resize(kMostNeighbours);
  }
  const GroundClass& ground = site_->model->parts().classes[static_cast<std::size_t>(class_index)];
  return GaussianProcess(std::move(found),
                         {.pull_std = ground.pull_std,
                          .sinkage_std = ground.sinkage_std,
                          .correlation_length_m = site_->model->parts().policy.correlation_length_m});
}

// Evidence of ground, on top or not, that one can drive to from a floor without climbing.
std::vector<PlaceEvidence> EvidenceField::levelWith(maps::Cell block, std::uint16_t level) const {
  const int number = site_->model->parts().classes[0].number;
  const GroundBelief mean = classBelief(0);
  const int side = 1 << block_shift_;
  const int reach = reachBlocks() * side;
  const double resolution_m = site_->grid().resolution_m;
  std::vector<PlaceEvidence> found;
  for (int row = block.row - reach; row <= block.row + reach; row += side)
    for (int column = block.column - reach; column <= block.column + reach; column += side) {
      const BlockLevel there = topOf({column, row});
      const double away_m = resolution_m * std::hypot(column - block.column, row - block.row);
      for (const BlockEvidence* e : bricks_.levels(there.column, there.row)) {
        const auto key = e->level == BlockEvidence::kTop ? topKey({column, row}) : e->level;
        const bool near =
            key && std::abs(*key - level) * resolution_m <= 0.5 * Floors::kHeadroom_m + kSteepest * away_m;
        if (near && e->terrain_class == number) found.push_back(placed({column, row}, *e, mean));
      }
    }
  return found;
}

GroundBelief EvidenceField::floorBelief(maps::Cell cell, const Floor& floor) const {
  const maps::Cell block = blockOf(cell);
  const maps::Point middle = middleOf(block);
  return combined(0, processOf(levelWith(block, levelOf(cell, floor).level), middle, 0).at(middle));
}

GroundBelief EvidenceField::classBelief(int class_index) const {
  return combined(
      class_index,
      {.pull = {0.0, site_->model->parts().classes[static_cast<std::size_t>(class_index)].pull_std},
       .sinkage = {0.0, site_->model->parts().classes[static_cast<std::size_t>(class_index)].sinkage_std}});
}

// Doubt about the class as a whole counts as far as the place itself is not known.
GroundBelief EvidenceField::combined(int class_index, const GroundBelief& departure) const {
  const auto i = static_cast<std::size_t>(class_index);
  const GroundClass& ground = site_->model->parts().classes[i];
  const GroundBelief prior = site_->model->prior(class_index);
  const ClassPosterior& posterior = posteriors_[i];
  const double open = std::min(departure.pull.std / ground.pull_std, 1.0);
  return {.pull = {prior.pull.value + posterior.pull.value + departure.pull.value,
                   std::hypot(departure.pull.std, open * posterior.pull.std)},
          .sinkage = {std::max(prior.sinkage.value + posterior.sinkage.value + departure.sinkage.value, 0.0),
                      departure.sinkage.std}};
}

const EvidenceField::Belief& EvidenceField::Beliefs::away(int class_index) {
  auto known = away_.find(class_index);
  if (known == away_.end())
    known = away_.emplace(class_index, Belief{field_.classBelief(class_index), false}).first;
  return known->second;
}

// Patches are forgotten when there are many, so that a whole map is worked out in little memory.
EvidenceField::Beliefs::Patch& EvidenceField::Beliefs::patchAt(const BlockLevel& block, int class_index) {
  const BlockLevel first{block.column / kPatchBlocks * kPatchBlocks, block.row / kPatchBlocks * kPatchBlocks,
                         BlockEvidence::kTop};
  const Key key{first.column, first.row, class_index};
  if (last_ && key == last_key_) return *last_;
  if (patches_.size() >= kMostRemembered) patches_.clear();
  auto patch = patches_.find(key);
  if (patch == patches_.end())
    patch = patches_.emplace(key, Patch{field_.process(first, class_index), {}}).first;
  last_key_ = key;
  return *(last_ = &patch->second);
}

const EvidenceField::Belief& EvidenceField::Beliefs::at(maps::Cell cell, int class_index) {
  const BlockLevel block = field_.topOf(cell);
  Patch& patch = patchAt(block, class_index);
  if (patch.process.empty()) return away(class_index);
  std::optional<Belief>& known = patch.known[static_cast<std::size_t>(
      block.row % kPatchBlocks * kPatchBlocks + block.column % kPatchBlocks)];
  if (!known) {
    const GroundBelief departure = patch.process.at(field_.middleOf(field_.cellOf(block)));
    const double prior_std =
        field_.site_->model->parts().classes[static_cast<std::size_t>(class_index)].pull_std;
    known = Belief{field_.combined(class_index, departure), departure.pull.std != prior_std};
  }
  return *known;
}

}  // namespace talus::costmap
