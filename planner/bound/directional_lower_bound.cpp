#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include <talus/common/constants.hpp>
#include <talus/planner/bound/directional_lower_bound.hpp>

namespace talus::planner {
namespace {

using costmap::CellCode;
using costmap::TravelCurve;

constexpr double kBin = 1.0 / 256.0;  // gradient step of one bin of a curve
constexpr int kMiddleBin = TravelCurve::kBins / 2;
constexpr double kOctagon = 0.92387;  // cos(pi/8), rounded down by more than the float error
// Raising rounds: more rounds favour single headings and leave their neighbours cheap.
constexpr int kRaises = 4;
constexpr double kRounding = 1.0 - 1e-6;  // costs are stored as floats
// With tilt, each cost is at least this share of the lowest cost: every step has a positive cost.
constexpr double kLeastPriceShare = 0.1;
constexpr double kDiagonal = std::numbers::sqrt2 / 2;

double priceAt(const TravelCurve& curve, int bin, int row = 0) noexcept {
  const int at = bin + kMiddleBin;
  return at >= 0 && at < TravelCurve::kBins ? static_cast<double>(curve.rows()[row * TravelCurve::kBins + at])
                                            : kInfinity;
}

// Returns a lower bound of cost - tilt * gradient over all gradients along in [from, to] and gradients
// across >= `across`. The cost is linear between nodes, so its minimum lies at a node; costs never decrease
// from row to row.
double leastIn(const TravelCurve& curve, double tilt, double from, double to, double across) noexcept {
  double least = kInfinity;
  const int row = std::min(static_cast<int>(across * TravelCurve::kRowsPerUnit), curve.lastRow());
  for (int bin = static_cast<int>(std::floor(from / kBin)); bin <= static_cast<int>(std::ceil(to / kBin));
       ++bin)
    least = std::min(least, priceAt(curve, bin, row) - tilt * bin * kBin);
  return least;
}

// Returns the gradient along grid heading k.
double along(double dz_dx, double dz_dy, std::size_t k) noexcept {
  const double scale = k % 2 == 0 ? 1.0 : kDiagonal;
  return scale * (dz_dx * kStep[k].column + dz_dy * kStep[k].row);
}

constexpr int kParts = 8;  // sub-sectors of the 45 degrees between two headings
constexpr std::size_t kDirections = 8 * kParts;
constexpr double kPart = std::numbers::pi / 4 / kParts;

using ByDirection = std::array<double, kDirections>;

// Unit vectors of the directions. A direction j sub-sectors from heading e is p e + q f, f the next heading;
// inverse_p = 1 / p, q_over_p = q / p.
struct Directions {
  std::array<double, kDirections + 1> x{}, y{};
  std::array<double, kParts> inverse_p{}, q_over_p{};

  Directions() noexcept {
    for (std::size_t i = 0; i <= kDirections; ++i) {
      x[i] = std::cos(static_cast<double>(i) * kPart);
      y[i] = std::sin(static_cast<double>(i) * kPart);
    }
    for (int j = 0; j < kParts; ++j) {
      const double p = std::sin((kParts - j) * kPart), q = std::sin(j * kPart);
      inverse_p[static_cast<std::size_t>(j)] = std::sin(kParts * kPart) / p;
      q_over_p[static_cast<std::size_t>(j)] = q / p;
    }
  }
};

const Directions& directions() noexcept {
  static const Directions all;
  return all;
}

// Largest increase of before[k] allowed by the limits of the directions around heading k, neighbours
// unchanged.
double roomAt(std::size_t k, const ByDirection& limit, const std::array<double, 8>& before) noexcept {
  const Directions& mix = directions();
  const double left = before[(k + 1) % 8], right = before[(k + 7) % 8];
  double most = (left + right) * kDiagonal;  // a higher cost would not be convex and would be lowered again
  for (std::size_t j = 0; j < kParts; ++j) {
    const double on_left = limit[(k * kParts + j) % kDirections],
                 on_right = limit[(k * kParts + kDirections - j) % kDirections];
    most = std::min({most, on_left * mix.inverse_p[j] - mix.q_over_p[j] * left,
                     on_right * mix.inverse_p[j] - mix.q_over_p[j] * right});
  }
  return std::max(0.0, most - before[k]);
}

// Returns the costs of the eight headings for which the gauge is below the limit of every direction. Each
// round raises each cost by half of its allowed increase. Two neighbouring headings share a limit, so that
// the two halves together stay within the limit.
std::array<double, 8> raised(const ByDirection& limit) noexcept {
  std::array<double, 8> prices{};
  prices.fill(std::max(0.0, kOctagon * *std::ranges::min_element(limit)));
  for (int round = 0; round < kRaises; ++round) {
    const std::array<double, 8> before = prices;
    for (std::size_t k = 0; k < 8; ++k) prices[k] += 0.5 * roomAt(k, limit, before);
  }
  return prices;
}

// Upper limit of the gauge in each direction, for one gradient. Empty if no direction is allowed.
std::optional<ByDirection> limitsOf(const TravelCurve& curve, double tilt, double dz_dx, double dz_dy,
                                    double off_gradient) {
  const double bulge = 1.0 - std::cos(kPart / 2);
  const double slack = off_gradient + std::hypot(dz_dx, dz_dy) * bulge + 1e-9;
  const Directions& all = directions();
  const auto rise = [&](std::size_t i) { return dz_dx * all.x[i] + dz_dy * all.y[i]; };
  const auto aside = [&](std::size_t i) { return dz_dy * all.x[i] - dz_dx * all.y[i]; };
  ByDirection least{}, limit{};
  double most = 0.0, from = rise(0);
  bool allowed = false;
  for (std::size_t i = 0; i < kDirections; ++i) {
    const double to = rise(i + 1);
    const double left = aside(i), right = aside(i + 1);
    const double across = left * right > 0.0 ? std::min(std::abs(left), std::abs(right)) - slack : 0.0;
    least[i] =
        leastIn(curve, tilt, std::min(from, to) - slack, std::max(from, to) + slack, std::max(across, 0.0));
    if (std::isfinite(least[i])) {
      most = std::max(most, least[i]);
      allowed = true;
    }
    from = to;
  }
  if (!allowed) return std::nullopt;
  // Directions that are not allowed need no limit; a high finite limit keeps the sums finite.
  for (std::size_t i = 0; i < kDirections; ++i)
    limit[i] = std::min({least[i], least[(i + kDirections - 1) % kDirections], 2 * most}) * (1.0 - bulge) *
               kRounding;
  return limit;
}

}  // namespace

DirectionalLowerBounds::DirectionalLowerBounds(const costmap::TravelCost& cost)
    : cost_(cost), lines_(cost), squares_(cost.curves().size()) {}

DirectionalLowerBounds::Square DirectionalLowerBounds::squareWith(std::size_t curve, double dz_dx,
                                                                  double dz_dy, double tilt_J_per_m) const {
  Square made{true, {}, tilt_J_per_m};
  made.own.fill(std::numeric_limits<float>::infinity());
  const double off_middle = std::numbers::sqrt2 * 0.5 * (kSteps - 1) * CellCode::kStep;
  const auto limit = limitsOf(cost_.curves()[curve], tilt_J_per_m, dz_dx, dz_dy, off_middle);
  if (!limit) return made;
  const auto prices = raised(*limit);
  for (std::size_t k = 0; k < 8; ++k) made.own[k] = static_cast<float>(prices[k]);
  return made;
}

// Uses the tilt with the highest sum of costs, among the tilts that leave every heading a positive cost.
DirectionalLowerBounds::Square DirectionalLowerBounds::squareOf(std::size_t curve, double dz_dx,
                                                                double dz_dy) const {
  const TravelCurve& of = cost_.curves()[curve];
  const double chord = (priceAt(of, 4) - priceAt(of, -4)) / (8 * kBin);
  const double tilt = std::isfinite(chord) ? chord : 0.0;
  Square best = squareWith(curve, dz_dx, dz_dy, 0.0);
  if (std::isinf(best.own[0])) return best;
  const auto sum = [](const Square& square) {
    double all = 0.0;
    for (const float price : square.own) all += static_cast<double>(price);
    return all;
  };
  for (const double part : {0.5, 1.0}) {
    const Square tried = squareWith(curve, dz_dx, dz_dy, part * tilt);
    const double least = kLeastPriceShare * static_cast<double>(*std::ranges::min_element(tried.own));
    const double slack = std::abs(part * tilt) * kSteps * CellCode::kStep;
    bool priced = least > 0.0;
    for (std::size_t k = 0; k < 8; ++k)
      priced =
          priced && static_cast<double>(tried.own[k]) + part * tilt * along(dz_dx, dz_dy, k) - slack >= least;
    if (priced && sum(tried) > sum(best)) best = tried;
  }
  return best;
}

DirectionalLowerBounds::DirectionCosts DirectionalLowerBounds::steep(CellCode cell) const {
  const CostLowerBound line = lines_.of(cell);
  DirectionCosts prices{};
  for (std::size_t k = 0; k < 8; ++k)
    prices[k] = static_cast<float>(kOctagon * line.level_J_per_m +
                                   line.tilt_J_per_m * along(cell.dzDx(), cell.dzDy(), k));
  return prices;
}

DirectionalLowerBounds::DirectionCosts DirectionalLowerBounds::of(CellCode cell) {
  const int x = cell.stepsX() + kReach, y = cell.stepsY() + kReach;
  if (x < 0 || y < 0 || x >= 2 * kReach || y >= 2 * kReach) return steep(cell);
  constexpr int kSquares = 2 * kReach / kSteps;
  auto& squares = squares_[cell.curve()];
  if (squares.empty()) squares.resize(std::size_t{kSquares} * kSquares);
  Square& square = squares[static_cast<std::size_t>(y / kSteps * kSquares + x / kSteps)];
  const auto middle = [](int steps) {
    return (steps / kSteps * kSteps - kReach + 0.5 * (kSteps - 1)) * CellCode::kStep;
  };
  if (!square.known) square = squareOf(cell.curve(), middle(x), middle(y));
  DirectionCosts prices = square.own;
  if (square.tilt_J_per_m != 0.0)
    for (std::size_t k = 0; k < 8; ++k)
      prices[k] += static_cast<float>(square.tilt_J_per_m * along(cell.dzDx(), cell.dzDy(), k));
  return prices;
}

}  // namespace talus::planner
