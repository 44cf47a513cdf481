#include <talus/planner/reach/reach.hpp>

namespace talus::planner {
namespace {

using maps::Cell;

// In sides of a cell: margin at start and goal, because MotionCost treats places within 1e-6 of a side as on
// the side.
constexpr double kEnds = 1e-5;
// Smaller growth of a range is rounding.
constexpr double kRounding = 1e-9;

enum : std::uint8_t { kSeen = 1, kOpen = 2 };

}  // namespace

Reach::Reach(const costmap::CostGrid& map, HeadingSets& headings, Sense sense, maps::Point place,
             double tolerance_m, const StopCheck& stop, const Reach* other, std::size_t most_cells)
    : map_(map), headings_(headings), sense_(sense), seen_(map.grid().size(), 0), other_(other) {
  for (const Cell cell : cellsWithin(map.grid(), place, tolerance_m)) {
    const InCell at = inCell(map.grid(), cell, place);
    begin(cell, tolerance_m > 0.0 ? nullptr : &at);
  }
  std::size_t steps = 0;
  while (!open_.empty() && !joined_) {
    if (cells_ > most_cells || ((++steps & 0xfffU) == 0 && stop())) {
      complete_ = false;
      return;
    }
    const std::size_t index = open_.front();
    open_.pop_front();
    seen_[index] &= static_cast<std::uint8_t>(~kOpen);
    const auto width = static_cast<std::size_t>(map.grid().width);
    spread({static_cast<int>(index % width), static_cast<int>(index / width)});
  }
}

const HeadingSet& Reach::headingsOf(Cell cell) {
  const costmap::CellCode code = map_.at(cell);
  const HeadingSet& own = headings_.of(code);
  if (sense_ == Sense::From || own.all()) return own;
  const auto known = reversed_.find(code.number());
  return known != reversed_.end() ? known->second
                                  : reversed_.emplace(code.number(), own.reversed()).first->second;
}

void Reach::enqueue(std::size_t index) {
  if (seen_[index] == 0) ++cells_;
  joined_ = joined_ || (other_ != nullptr && other_->seen_[index] != 0 && !cones_.contains(index) &&
                        !other_->cones_.contains(index));
  if ((seen_[index] & kOpen) != 0) return;
  seen_[index] = kSeen | kOpen;
  open_.push_back(index);
}

// Without a place the drive may begin anywhere in the cell.
void Reach::begin(Cell cell, const InCell* place) {
  const HeadingSet& own = headingsOf(cell);
  if (own.empty()) return;
  const std::size_t index = map_.grid().index(cell);
  if (!leadsEverywhere(own)) {
    Entries& entries = cones_[index];
    entries.has_place = place != nullptr;
    entries.anywhere = place == nullptr;
    if (place != nullptr) entries.place = *place;
  }
  enqueue(index);
}

SideRange Reach::exits(const Entries& entries, const HeadingCone& cone, int side) const noexcept {
  if (entries.anywhere) return {0.0, 1.0};
  SideRange all;
  for (int from = 0; from < 4; ++from) {
    const SideRange& entry = entries.sides[static_cast<std::size_t>(from)];
    if (!entry.empty())
      all = all.hull(cone.reached(onSide(from, entry.from), onSide(from, entry.to), side, 0.0));
  }
  return entries.has_place ? all.hull(cone.reached(entries.place, entries.place, side, kEnds)) : all;
}

bool Reach::mayCross(Cell cell, const HeadingSet& own, int side) {
  const HeadingSet& other = headingsOf(beyond(cell, side));
  if (other.empty()) return false;
  if (own.all() && other.all()) return true;
  const HeadingSet both = own.shared(other);
  if (both.empty()) return false;
  const double off = std::remainder(both.nearest(outwards_rad(side)) - outwards_rad(side), HeadingSet::kTurn);
  return std::abs(off) <= 0.25 * HeadingSet::kTurn + kEnds;
}

void Reach::spread(Cell cell) {
  const HeadingSet& own = headingsOf(cell);
  const auto found = cones_.find(map_.grid().index(cell));
  const Entries* entries =
      found == cones_.end() ? nullptr : &found->second;  // the reference stays valid when entries are added
  for (int side = 0; side < 4; ++side) {
    if (!map_.grid().contains(beyond(cell, side)) || !mayCross(cell, own, side)) continue;
    const SideRange range =
        entries == nullptr ? SideRange{0.0, 1.0} : exits(*entries, HeadingCone(own), side);
    if (!range.empty()) enter(beyond(cell, side), otherSide(side), range);
  }
}

void Reach::enter(Cell cell, int side, const SideRange& range) {
  const std::size_t index = map_.grid().index(cell);
  if (seen_[index] != 0 && !cones_.contains(index)) return;  // entered before, without restriction
  if (leadsEverywhere(headingsOf(cell))) return enqueue(index);
  Entries& entries = cones_[index];
  SideRange& known = entries.sides[static_cast<std::size_t>(side)];
  if (!known.empty() && known.from <= range.from + kRounding && range.to <= known.to + kRounding) return;
  known = ++entries.growths > kGrowths ? SideRange{0.0, 1.0} : known.hull(range);
  enqueue(index);
}

bool Reach::reaches(maps::Point place, double tolerance_m) {
  for (const Cell cell : cellsWithin(map_.grid(), place, tolerance_m)) {
    if (!holds(cell)) continue;
    const auto found = cones_.find(map_.grid().index(cell));
    if (tolerance_m > 0.0 || found == cones_.end() || found->second.anywhere) return true;
    const HeadingCone cone(headingsOf(cell));
    const InCell to = inCell(map_.grid(), cell, place);
    const Entries& entries = found->second;
    if (entries.has_place && cone.joins(entries.place, entries.place, to, kEnds)) return true;
    for (int side = 0; side < 4; ++side) {
      const SideRange& entry = entries.sides[static_cast<std::size_t>(side)];
      if (!entry.empty() && cone.joins(onSide(side, entry.from), onSide(side, entry.to), to, kEnds))
        return true;
    }
  }
  return false;
}

}  // namespace talus::planner
