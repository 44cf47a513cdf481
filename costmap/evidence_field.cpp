#include <algorithm>
#include <cmath>
#include <utility>

#include <costmap/evidence_field.hpp>

namespace talus::costmap {
namespace {

using octomap::OcTreeKey;

constexpr unsigned kDepth = 16;
constexpr double kBlocksPerLength = 4.0;
constexpr double kReferenceStd = 0.05;   // of the sample that counts as one
constexpr double kMostPerSample = 25.0;  // no sample counts for more
constexpr double kNugget =
    0.01;  // of a block's mean however many samples it has: ground varies inside it too
constexpr std::size_t kMostNeighbours = 64;
constexpr int kPatchBlocks = 8;
constexpr double kFreedom = 4.0;              // of Student's t
constexpr double kContradicts = 1.5;          // standard deviations
constexpr std::size_t kMostRemembered = 512;  // patches, so that a whole map is worked out in little memory
constexpr double kUnit = 1048576.0;           // of the fixed-point sums

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
      tree_(site_->keys.grid().resolution_m),
      sums_(site_->model->parts().classes.size()),
      posteriors_(site_->model->parts().classes.size()) {
  const maps::Grid& grid = site_->grid();
  first_block_ = blockOf({0, 0});
  const maps::Cell last = blockOf({grid.width - 1, grid.height - 1});
  block_columns_ = ((last.column - first_block_.column) >> block_shift_) + 1;
  driven_.resize(static_cast<std::size_t>(block_columns_) *
                 static_cast<std::size_t>(((last.row - first_block_.row) >> block_shift_) + 1));
  for (std::size_t i = 0; i < posteriors_.size(); ++i) refresh(static_cast<int>(i));
}

std::size_t EvidenceField::slotOf(maps::Cell block) const noexcept {
  return static_cast<std::size_t>((block.row - first_block_.row) >> block_shift_) *
             static_cast<std::size_t>(block_columns_) +
         static_cast<std::size_t>((block.column - first_block_.column) >> block_shift_);
}

// Blocks lie on the octree's own lines: a block is named by its south-west cell, which may lie outside the
// grid.
maps::Cell EvidenceField::blockOf(maps::Cell cell) const noexcept {
  const OcTreeKey first = site_->keys.key({0, 0}, site_->keys.baseElevation_m());
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

// The key of a block lies at the height of its first cell with an elevation.
std::optional<OcTreeKey> EvidenceField::keyOf(maps::Cell cell) const {
  const maps::Cell block = blockOf(cell);
  const maps::Grid& grid = site_->keys.grid();
  const int side = 1 << block_shift_;
  for (int row = std::max(block.row, 0); row < std::min(block.row + side, grid.height); ++row)
    for (int column = std::max(block.column, 0); column < std::min(block.column + side, grid.width);
         ++column) {
      const float elevation = site_->elevation.elevation_m[{column, row}];
      if (!std::isnan(elevation)) return site_->keys.key({column, row}, static_cast<double>(elevation));
    }
  return std::nullopt;
}

double EvidenceField::measuredVariance(const CellBelief& block) const noexcept {
  return kReferenceStd * kReferenceStd / static_cast<double>(block.evidence) + kNugget * kNugget;
}

// One block speaks for as many independent places as its length holds integral scales (2/3 of the correlation
// length). Ground that departs from its class by much more than the class varies is other ground that no
// class raster shows: it counts for less by the weight of Student's t with four degrees of freedom
// (lange_1989).
void EvidenceField::contribute(const CellBelief& block, int class_index, std::int64_t sign) {
  if (block.evidence <= 0.0F) return;
  const GroundClass& ground = site_->model->parts().classes[static_cast<std::size_t>(class_index)];
  const GroundBelief prior = site_->model->prior(class_index);
  const double block_m = (1 << block_shift_) * site_->keys.grid().resolution_m;
  const double places = std::min(1.0, 1.5 * block_m / site_->model->parts().policy.correlation_length_m);
  const double variance = ground.pull_std * ground.pull_std;
  const double departure = static_cast<double>(block.evidence_pull) - prior.pull.mean;
  const double spread = variance + ground.mean_std * ground.mean_std + measuredVariance(block);
  const double alike = std::min(1.0, (kFreedom + 1.0) / (kFreedom + departure * departure / spread));
  const double weight = alike * places * variance / (variance + measuredVariance(block));
  ClassSums& sums = sums_[static_cast<std::size_t>(class_index)];
  sums.weight += sign * fixed(weight);
  sums.pull += sign * fixed(weight * departure);
  sums.sinkage += sign * fixed(weight * (static_cast<double>(block.evidence_sinkage) - prior.sinkage.mean));
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

std::optional<CellRange> EvidenceField::add(const WheelObservation& observation) {
  const maps::Grid& grid = site_->keys.grid();
  const auto cell = grid.cellAt(observation.place);
  if (!cell || std::isnan(site_->elevation.elevation_m[*cell])) return std::nullopt;
  const int class_index = site_->classIndex(*cell);
  const auto key = keyOf(*cell);
  if (class_index < 0 || !key) return std::nullopt;
  CellBelief& block = tree_.at(*key, kDepth - static_cast<unsigned>(block_shift_));
  const int owner = block.evidence > 0.0F ? site_->model->classIndex(block.terrain_class) : class_index;
  if (owner != class_index) return std::nullopt;  // a block speaks for the class that was driven first in it
  contribute(block, class_index, -1);
  const double share = kReferenceStd / observation.pull.std;
  const auto weight = static_cast<float>(std::min(share * share, kMostPerSample));
  // A block is as weak as its weakest part: what stronger ground in it told before counts no more than the
  // sample that contradicts it.
  if (observation.pull.mean < static_cast<double>(block.evidence_pull) - kContradicts * observation.pull.std)
    block.evidence = std::min(block.evidence, weight);
  const float gain = weight / (block.evidence + weight);
  if (block.evidence <= 0.0F)
    block.evidence_sinkage = static_cast<float>(site_->model->prior(class_index).sinkage.mean);
  block.evidence_pull += gain * (static_cast<float>(observation.pull.mean) - block.evidence_pull);
  if (std::isfinite(observation.sinkage.std))
    block.evidence_sinkage += gain * (static_cast<float>(observation.sinkage.mean) - block.evidence_sinkage);
  block.evidence += weight;
  block.updated_s = observation.time_s > 0.0 && observation.time_s < 4294967295.0
                        ? static_cast<std::uint32_t>(observation.time_s)
                        : 0U;
  block.terrain_class =
      static_cast<std::uint8_t>(site_->model->parts().classes[static_cast<std::size_t>(class_index)].number);
  contribute(block, class_index, 1);
  refresh(class_index);
  driven_[slotOf(blockOf(*cell))] = true;

  const int side = 1 << block_shift_;
  const int reach =
      static_cast<int>(std::ceil(site_->model->parts().policy.correlation_length_m / grid.resolution_m)) +
      side;
  return CellRange{
      {std::max(cell->column - reach, 0), std::max(cell->row - reach, 0)},
      {std::min(cell->column + reach, grid.width - 1), std::min(cell->row + reach, grid.height - 1)}};
}

void EvidenceField::restore(maps::Cell cell, const CellBelief& saved) {
  const auto key = keyOf(cell);
  const int class_index = site_->model->classIndex(saved.terrain_class);
  if (!key || class_index < 0 || saved.evidence <= 0.0F || evidence(cell)) return;
  CellBelief& block = tree_.at(*key, kDepth - static_cast<unsigned>(block_shift_));
  block = CellBelief{};
  block.evidence = saved.evidence;
  block.evidence_pull = saved.evidence_pull;
  block.evidence_sinkage = saved.evidence_sinkage;
  block.updated_s = saved.updated_s;
  block.terrain_class = saved.terrain_class;
  driven_[slotOf(blockOf(cell))] = true;
  contribute(block, class_index, 1);
  refresh(class_index);
}

const CellBelief* EvidenceField::evidence(maps::Cell cell) const {
  if (!driven_[slotOf(blockOf(cell))]) return nullptr;
  const auto key = keyOf(cell);
  return key ? tree_.find(*key) : nullptr;
}

// Evidence of the class that can reach a patch of blocks, nearest first where there is more than enough.
GaussianProcess EvidenceField::process(maps::Cell patch, int class_index) const {
  const GroundClass& ground = site_->model->parts().classes[static_cast<std::size_t>(class_index)];
  const GroundBelief mean = classBelief(class_index);
  const maps::Grid& grid = site_->grid();
  const double length_m = site_->model->parts().policy.correlation_length_m;
  const int side = 1 << block_shift_;
  const int reach = static_cast<int>(std::ceil(length_m / (side * grid.resolution_m))) * side;
  const int span = kPatchBlocks * side;
  std::vector<PlaceEvidence> found;
  for (int row = patch.row - reach; row < patch.row + span + reach; row += side)
    for (int column = patch.column - reach; column < patch.column + span + reach; column += side) {
      const maps::Cell inside{std::max(column, 0), std::max(row, 0)};
      if (column + side <= 0 || row + side <= 0 || !grid.contains(inside) || !driven_[slotOf({column, row})])
        continue;
      const CellBelief* block = evidence(inside);
      if (block->terrain_class != ground.number) continue;
      found.push_back({.place = middleOf({column, row}),
                       .pull = static_cast<double>(block->evidence_pull) - mean.pull.mean,
                       .sinkage = static_cast<double>(block->evidence_sinkage) - mean.sinkage.mean,
                       .variance = measuredVariance(*block)});
    }
  if (found.size() > kMostNeighbours) {
    const maps::Point low = middleOf(patch);
    const maps::Point middle{low.x_m + 0.5 * span * grid.resolution_m,
                             low.y_m + 0.5 * span * grid.resolution_m};
    const auto far = [&](const PlaceEvidence& e) {
      return std::hypot(e.place.x_m - middle.x_m, e.place.y_m - middle.y_m);
    };
    std::stable_sort(found.begin(), found.end(),
                     [&](const PlaceEvidence& a, const PlaceEvidence& b) { return far(a) < far(b); });
    found.resize(kMostNeighbours);
  }
  return GaussianProcess(
      std::move(found),
      {.pull_std = ground.pull_std, .sinkage_std = ground.sinkage_std, .correlation_length_m = length_m});
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
  return {.pull = {prior.pull.mean + posterior.pull.mean + departure.pull.mean,
                   std::hypot(departure.pull.std, open * posterior.pull.std)},
          .sinkage = {std::max(prior.sinkage.mean + posterior.sinkage.mean + departure.sinkage.mean, 0.0),
                      departure.sinkage.std}};
}

const EvidenceField::Belief& EvidenceField::Beliefs::away(int class_index) {
  auto known = away_.find(class_index);
  if (known == away_.end())
    known = away_.emplace(class_index, Belief{field_.classBelief(class_index), false}).first;
  return *(last_belief_ = &known->second);
}

const EvidenceField::Belief& EvidenceField::Beliefs::at(maps::Cell cell, int class_index) {
  const maps::Cell block = field_.blockOf(cell);
  const Key key{block.column, block.row, class_index};
  if (last_belief_ && key == last_) return *last_belief_;
  last_ = key;
  auto known = known_.find(key);
  if (known == known_.end()) {
    const int span = kPatchBlocks << field_.block_shift_;
    const auto down = [&](int value, int first) { return first + (value - first) / span * span; };
    const maps::Cell patch{down(block.column, field_.first_block_.column),
                           down(block.row, field_.first_block_.row)};
    const Key patch_key{patch.column, patch.row, class_index};
    if (processes_.size() >= kMostRemembered) {
      processes_.clear();
      known_.clear();
    }
    auto process = processes_.find(patch_key);
    if (process == processes_.end())
      process = processes_.emplace(patch_key, field_.process(patch, class_index)).first;
    if (process->second.empty()) return away(class_index);
    const GroundBelief departure = process->second.at(field_.middleOf(block));
    const double prior_std =
        field_.site_->model->parts().classes[static_cast<std::size_t>(class_index)].pull_std;
    known =
        known_.emplace(key, Belief{field_.combined(class_index, departure), departure.pull.std != prior_std})
            .first;
  }
  return *(last_belief_ = &known->second);
}

}  // namespace talus::costmap
