#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include <costmap/drive_cost.hpp>

namespace talus::costmap {

std::uint32_t CellCode::quantised(double gradient) noexcept {
  const double steps = std::clamp(std::round(gradient / kStep), -2048.0, 2047.0);
  return static_cast<std::uint32_t>(static_cast<int>(std::isnan(steps) ? 0.0 : steps)) & 0xfffu;
}

DriveCost::DriveCost(const Limits& limits, std::vector<DriveCurve> curves)
    : limits_(limits), curves_(std::move(curves)) {
  if (curves_.size() > CellCode::kUnknown)
    throw std::invalid_argument("DriveCost: " + std::to_string(curves_.size()) +
                                " drive curves, must be <= 254");
}

float DriveCost::costPerMetre(CellCode cell, Direction heading) const noexcept {
  constexpr float blocked = std::numeric_limits<float>::infinity();
  if (cell.curve() >= curves_.size()) return blocked;
  const double along = cell.dzDx() * heading.x + cell.dzDy() * heading.y;
  const double across = cell.dzDy() * heading.x - cell.dzDx() * heading.y;
  if (std::abs(along) > limits_.max_along || std::abs(across) > limits_.max_across) return blocked;
  const int bin = static_cast<int>(std::lround(along * 256.0)) + DriveCurve::kBins / 2;
  if (bin < 0 || bin >= DriveCurve::kBins) return blocked;
  return curves_[cell.curve()].cost_J_per_m[static_cast<std::size_t>(bin)];
}

}  // namespace talus::costmap
