#include <algorithm>
#include <cmath>
#include <utility>

#include <talus/costmap/costmap.hpp>
#include <talus/costmap/ground/wheel_swath.hpp>
#include <talus/costmap/map/ground_curves.hpp>
#include <talus/costmap/surface/surface_shape.hpp>

namespace talus::costmap {

namespace {

void set(const GroundBelief& strength, CellBelief& belief) {
  belief.pull_mean = static_cast<float>(strength.pull.value);
  belief.pull_std = static_cast<float>(strength.pull.std);
  belief.sinkage_mean = static_cast<float>(strength.sinkage.value);
  belief.sinkage_std = static_cast<float>(strength.sinkage.std);
}

void set(const BlockEvidence& own, CellBelief& belief) {
  const GroundBound bound = own.bound();
  belief.evidence = static_cast<float>(own.samples());
  const double weakest = std::fmin(own.pull(), bound.most_pull);
  belief.evidence_pull = std::isnan(weakest) ? 0.0F : static_cast<float>(weakest);
  belief.evidence_sinkage = static_cast<float>(std::fmax(0.0, std::fmax(own.sinkage(), bound.least_sinkage)));
  belief.updated_s = own.updated_s();
}

}  // namespace

PlaceBeliefs::PlaceBeliefs(const TraversabilityMap& map) : map_(map), beliefs_(map.evidence()) {}

CellBelief PlaceBeliefs::at(maps::Cell cell) {
  const MapSurface& surface = map_.surface();
  CellBelief belief;
  belief.terrain_class = static_cast<std::uint8_t>(surface.classNumber(cell));
  belief.hazards = surface.hazards(cell);
  const int index = surface.classIndex(cell);
  if (index < 0) return belief;
  belief.terrain_class =
      static_cast<std::uint8_t>(map_.model().parts().classes[static_cast<std::size_t>(index)].number);
  set(beliefs_.at(cell, index).ground, belief);
  if (const BlockEvidence* own = map_.evidence().evidence(cell)) set(*own, belief);
  if (const auto ranked = map_.costs().ranked(cell)) {
    belief.category = ranked->category;
    belief.confidence = ranked->confidence;
  } else if (!has(belief.hazards, Hazard::Unknown)) {
    belief.category = static_cast<std::uint8_t>(terramech::Category::Dangerous);
    belief.confidence = 16;
  }
  return belief;
}

std::optional<GroundBelief> PlaceBeliefs::ground(maps::Cell cell) {
  const int index = map_.surface().classIndex(cell);
  if (index < 0) return std::nullopt;
  return beliefs_.at(cell, index).ground;
}

CellBelief TraversabilityMap::belief(maps::Cell cell) const {
  return PlaceBeliefs(*this).at(cell);
}

std::optional<GroundBelief> TraversabilityMap::ground(maps::Cell cell) const {
  return PlaceBeliefs(*this).ground(cell);
}

namespace {

constexpr int kFew = 4;  // number of other cells that a box may include with a new cell

// Adds a cell to the last box, or as a new box if the last box would include more than kFew other cells.
void join(std::vector<maps::CellBox>& boxes, const maps::Cell& cell) {
  const auto area = [](const maps::CellBox& b) {
    return (b.last.column - b.first.column + 1) * (b.last.row - b.first.row + 1);
  };
  if (!boxes.empty()) {
    maps::CellBox& last = boxes.back();
    const maps::CellBox both{{std::min(last.first.column, cell.column), std::min(last.first.row, cell.row)},
                             {std::max(last.last.column, cell.column), std::max(last.last.row, cell.row)}};
    if (area(both) <= area(last) + (last.last.column - last.first.column + 1) + kFew) {
      last = both;
      return;
    }
  }
  boxes.push_back({cell, cell});
}

}  // namespace

GroundCurves::GroundCurves(std::shared_ptr<const GroundSite> site)
    : site_(std::move(site)),
      table_(site_->model),
      added_(site_->costs),
      swath_(site_->model->rover(), site_->grid().resolution_m, site_->model->parts().policy.pose_error_m),
      borders_(classBorders(site_->classes, swath_.reach())),
      learned_(site_->grid()) {}

WheelSwath::Ground GroundCurves::ground(maps::Cell cell) const {
  if (!site_->grid().contains(cell)) return {};
  const int index = site_->classIndex(cell);
  if (index < 0 && site_->classes[cell] == GroundSite::kNoClass && site_->model->parts().policy.allow_unknown)
    return {0, table_.priorBelief(0)};
  if (index < 0) return {.belief = {}, .unseen = true};
  const std::uint32_t word = any_learned_ ? learned_[cell] : 0U;
  if (word == 0) return {index, table_.priorBelief(index)};
  return {index, kinds_[word - 1]};
}

std::uint32_t GroundCurves::wordOf(const GroundBelief& ground, int class_index) {
  const GroundBelief kind = rounded(ground, site_->model->prior(class_index),
                                    site_->model->parts().classes[static_cast<std::size_t>(class_index)]);
  const auto next = static_cast<std::uint32_t>(kinds_.size() + 1);
  const auto [known, is_new] =
      words_.try_emplace({kind.pull.value, kind.pull.std, kind.sinkage.value, kind.sinkage.std}, next);
  if (is_new) kinds_.push_back(kind);
  return known->second;
}

maps::CellBox GroundCurves::within(const maps::CellBox& range) const noexcept {
  return grown(range, swath_.reach(), site_->grid());
}

// A change of class alters class borders within the reach; the computation of the borders needs cells within
// twice the reach.
maps::CellBox GroundCurves::takeClasses(const maps::CellBox& box) {
  const maps::CellBox changed = within(box), seen = within(changed);
  const std::vector<bool> borders = classBorders(cut(site_->classes, seen), swath_.reach());
  const auto width = static_cast<std::size_t>(seen.width());
  forEachCell(changed, [&](maps::Cell cell) {
    borders_[site_->grid().index(cell)] =
        borders[static_cast<std::size_t>(cell.row - seen.first.row) * width +
                static_cast<std::size_t>(cell.column - seen.first.column)];
  });
  return changed;
}

bool GroundCurves::alike(maps::Cell cell) const noexcept {
  if (!borders_.empty() && borders_[site_->grid().index(cell)]) return false;
  if (!any_learned_) return true;
  const std::uint32_t own = learned_[cell];
  const maps::CellBox near = within({cell, cell});
  for (int row = near.first.row; row <= near.last.row; ++row)
    for (int column = near.first.column; column <= near.last.column; ++column)
      if (learned_[{column, row}] != own) return false;
  return true;
}

CellCode::Curve GroundCurves::withLayers(CellCode::Curve number, maps::Cell cell) {
  const int step = number < CellCode::kUnknown ? added_.step(cell) : 0;
  return step == 0 ? number : table_.dearer(number, step, added_.J_per_m(step));
}

CellCode::Curve GroundCurves::number(maps::Cell cell) {
  return withLayers(numberOfGround(cell), cell);
}

CellCode::Curve GroundCurves::numberOfGround(maps::Cell cell) {
  const WheelSwath::Ground own = ground(cell);
  const bool learned = any_learned_ && learned_[cell] != 0;
  WheelSwath::Judged judged{own.belief, own.class_index};
  if (!alike(cell)) {
    around_.clear();
    for (int row = -swath_.reach(); row <= swath_.reach(); ++row)
      for (int column = -swath_.reach(); column <= swath_.reach(); ++column)
        around_.push_back(ground({cell.column + column, cell.row + row}));
    judged = swath_.judged(around_);
    if (judged.unseen) return CellCode::kUnknown;
  }
  const bool own_alone =
      judged.weakest_class == own.class_index && WheelSwath::Ground{own.class_index, judged.belief} == own;
  if (own_alone && !learned) return table_.prior(own.class_index);
  const bool one_class = judged.weakest_class == own.class_index;
  return table_.learned(own.class_index, judged.belief, one_class ? -1 : judged.weakest_class);
}

GroundCurves::ClassChange GroundCurves::learnClasses(const EvidenceField& field) {
  ClassChange changed;
  for (int i = 0; i < static_cast<int>(site_->model->parts().classes.size()); ++i)
    changed.priors |= table_.setPrior(i, field.classBelief(i));
  std::vector<ClassState> states = field.states();
  changed.learned = states != states_;
  states_ = std::move(states);
  return changed;
}

std::vector<maps::CellBox> GroundCurves::learn(EvidenceBeliefs& beliefs,
                                               const std::vector<maps::CellBox>& ranges) {
  std::vector<maps::CellBox> changed;
  for (const maps::CellBox& range : ranges)
    for (int row = range.first.row; row <= range.last.row; ++row)
      for (int column = range.first.column; column <= range.last.column; ++column) {
        const maps::Cell cell{column, row};
        const int index = site_->classIndex(cell);
        std::uint32_t word = 0;
        if (index >= 0)
          if (const InferredGround& belief = beliefs.at(cell, index); belief.learned)
            word = wordOf(belief.ground, index);
        if (!learned_.set(cell, word)) continue;
        any_learned_ = true;
        join(changed, cell);
      }
  for (maps::CellBox& range : changed) range = within(range);
  return changed;
}

std::vector<maps::CellBox> GroundCurves::mixedRanges() const {
  std::vector<maps::CellBox> mixed;
  for (const maps::CellBox& box : learned_.boxes()) mixed.push_back(within(box));
  const maps::Grid& grid = site_->grid();
  for (int row = 0; row < grid.height && !borders_.empty(); ++row)
    for (int column = 0; column < grid.width; ++column) {
      if (!borders_[grid.index({column, row})]) continue;
      const int first = column;
      while (column + 1 < grid.width && borders_[grid.index({column + 1, row})]) ++column;
      mixed.push_back({{first, row}, {column, row}});
    }
  return mixed;
}

}  // namespace talus::costmap
