#include <algorithm>
#include <cmath>

#include <talus/costmap/cost/cross_slope.hpp>
#include <talus/costmap/cost/drive_cost.hpp>

// What is behind the cost of a metre: apart from drive_cost.cpp, which does not know how a curve was made.
namespace talus::costmap {
namespace {

terramech::Gradient gradientSeen(CellCode cell, Direction heading) noexcept {
  return {cell.dzDx() * heading.x + cell.dzDy() * heading.y,
          cell.dzDy() * heading.x - cell.dzDx() * heading.y};
}

DriveState refused(Refusal reason) noexcept {
  DriveState state;
  state.refusal = reason;
  return state;
}

}  // namespace

DriveState DriveCost::detail(CellCode cell, Direction heading) const noexcept {
  if (cell.curve() == CellCode::kBlocked) return refused(Refusal::Blocked);
  if (cell.curve() >= curves_.size()) return refused(Refusal::Unknown);
  const terramech::Gradient d = gradientSeen(cell, heading);
  const int bin = std::clamp(DriveCurve::bin(d.along), 0, DriveCurve::kBins - 1);
  const auto& table = states_[cell.curve()];
  const auto& crossing = crossings_[cell.curve()];
  DriveState state = !table     ? DriveState{}
                     : crossing ? crossing->state(*table, DriveCurve::row(d.across), bin)
                                : (*table)[static_cast<std::size_t>(bin)];
  if (std::abs(d.across) > limits_.max_across) state.refusal = Refusal::Roll;
  if (std::abs(d.along) > limits_.max_along || bin != DriveCurve::bin(d.along))
    state.refusal = Refusal::Pitch;
  return state;
}

SlopeHold DriveCost::hold(CellCode cell, Direction heading) const noexcept {
  if (cell.curve() >= curves_.size() || !crossings_[cell.curve()]) return {};
  const terramech::Gradient d = gradientSeen(cell, heading);
  return crossings_[cell.curve()]->hold(d);
}

}  // namespace talus::costmap
