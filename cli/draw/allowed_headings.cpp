#include <algorithm>
#include <cmath>

#include <talus/cli/draw/allowed_headings.hpp>

namespace talus::cli {

using costmap::CellCode;

HeadingsOfCells::HeadingsOfCells(const costmap::TraversabilityMap& map)
    : map_(map), grid_(map.published()), sets_(grid_->cost()), known_(grid_->cost().curves().size()) {}

AllowedHeadings HeadingsOfCells::at(maps::Cell cell) {
  const CellCode code = grid_->at(cell);
  if (code.curve() >= CellCode::kUnknown)
    return map_.costs().category(cell) == static_cast<std::uint8_t>(terramech::Category::Unknown)
               ? AllowedHeadings::Unknown
               : AllowedHeadings::None;
  const double steepness = std::hypot(code.stepsX(), code.stepsY());
  const AllowedHeadings gentler = on(code.curve(), static_cast<int>(std::floor(steepness))),
                        steeper = on(code.curve(), static_cast<int>(std::ceil(steepness)));
  return gentler == steeper ? gentler : of(code);
}

AllowedHeadings HeadingsOfCells::on(CellCode::Curve curve, int steepness) {
  std::vector<AllowedHeadings>& known = known_[curve];
  const auto step = static_cast<std::size_t>(steepness);
  if (known.size() <= step) known.resize(step + 1, AllowedHeadings::Unknown);
  if (known[step] == AllowedHeadings::Unknown)
    known[step] = of(CellCode({.dz_dx = steepness * CellCode::kStep, .dz_dy = 0.0, .curve = curve}));
  return known[step];
}

AllowedHeadings HeadingsOfCells::of(CellCode code) {
  const planner::HeadingSet& set = sets_.of(code);
  return set.all() ? AllowedHeadings::All : set.empty() ? AllowedHeadings::None : AllowedHeadings::Some;
}

}  // namespace talus::cli
