#include <algorithm>
#include <cmath>
#include <numbers>

#include <talus/planner/bound/triangle_prices.hpp>

namespace talus::planner {
namespace {

constexpr std::size_t kHeadingCount = HeadingLimits::kHeadings;
constexpr std::size_t kQuarter = kHeadingCount / 4;
constexpr std::size_t kEighth = kHeadingCount / 8;

// Along the headings of an angle of a triangle: how far the opposite side is, in sides of a cell, and at which share
// of that side it is met.
template <std::size_t kCount>
struct Fan {
  std::array<float, kCount> share, length;
};

constexpr double kTurn = 2.0 * std::numbers::pi / kHeadingCount;

// From a corner, from its side of the cell towards the middle.
const Fan<kEighth + 1>& cornerFan() noexcept {
  static const auto fan = [] {
    Fan<kEighth + 1> made;
    for (std::size_t i = 0; i <= kEighth; ++i) {
      const double angle = static_cast<double>(i) * kTurn, sum = std::cos(angle) + std::sin(angle);
      made.share[i] = static_cast<float>(2.0 * std::sin(angle) / sum);
      made.length[i] = static_cast<float>(1.0 / sum);
    }
    made.share[kEighth] = 1.0F;
    return made;
  }();
  return fan;
}

// From the middle, from the first corner of a triangle to the second.
const Fan<kQuarter + 1>& middleFan() noexcept {
  static const auto fan = [] {
    Fan<kQuarter + 1> made;
    for (std::size_t i = 0; i <= kQuarter; ++i) {
      const double angle = (static_cast<double>(i) - static_cast<double>(kEighth)) * kTurn;
      made.share[i] = static_cast<float>(0.5 + 0.5 * std::tan(angle));
      made.length[i] = static_cast<float>(0.5 / std::cos(angle));
    }
    made.share[0] = 0.0F;
    made.share[kQuarter] = 1.0F;
    return made;
  }();
  return fan;
}

constexpr std::size_t headingOf(std::size_t triangle, std::size_t k) noexcept {
  return (kQuarter * triangle + k) % kHeadingCount;
}

float less(float a, float b) noexcept {
  return a < b ? a : b;
}

float leastOf(const std::array<float, kEighth>& values) noexcept {
  return less(less(less(values[0], values[4]), less(values[1], values[5])),
              less(less(values[2], values[6]), less(values[3], values[7])));
}

// Headings as columns.
struct Headings {
  std::array<float, kHeadingCount> x, y;
};

const Headings& headingColumns() noexcept {
  static const auto made = [] {
    Headings all;
    for (std::size_t k = 0; k < kHeadingCount; ++k) {
      all.x[k] = static_cast<float>(HeadingLimits::heading(static_cast<int>(k)).x);
      all.y[k] = static_cast<float>(HeadingLimits::heading(static_cast<int>(k)).y);
    }
    return all;
  }();
  return made;
}

}  // namespace

TrianglePrices::TrianglePrices(const HeadingLimits::Limits& limits, double side_m) noexcept {
  for (std::size_t k = 0; k < kStored; ++k)
    prices[k] = static_cast<float>(side_m) * limits[k % kHeadingCount];
}

float TrianglePrices::first(std::size_t triangle, float share, const Values& values) const noexcept {
  const auto& fan = cornerFan();
  const float* price = prices.data() + headingOf(triangle, 0);
  const float rise = values.middle - values.second;
  std::array<float, kEighth> least;
  for (std::size_t i = 0; i < kEighth; ++i)
    least[i] = values.second + fan.share[i] * rise + price[i] * fan.length[i] * share;
  return less(leastOf(least), values.middle + price[kEighth] * fan.length[kEighth] * share);
}

float TrianglePrices::second(std::size_t triangle, float share, const Values& values) const noexcept {
  const auto& fan = cornerFan();
  const float* price = prices.data() + headingOf(triangle, 3 * kEighth);
  const float rise = values.middle - values.first;
  std::array<float, kEighth> least;
  for (std::size_t i = 0; i < kEighth; ++i)
    least[i] = values.first + fan.share[i] * rise + price[kEighth - i] * fan.length[i] * share;
  return less(leastOf(least), values.middle + price[0] * fan.length[kEighth] * share);
}

float TrianglePrices::middle(std::size_t triangle, float share, const Values& values) const noexcept {
  const auto& fan = middleFan();
  const float* price = prices.data() + headingOf(triangle, 5 * kEighth);
  const float rise = values.second - values.first;
  std::array<float, kEighth> least;
  for (std::size_t i = 0; i < kEighth; ++i) {
    const std::size_t j = i + kEighth;
    least[i] = less(values.first + fan.share[i] * rise + price[i] * fan.length[i] * share,
                    values.first + fan.share[j] * rise + price[j] * fan.length[j] * share);
  }
  return less(leastOf(least), values.second + price[kQuarter] * fan.length[kQuarter] * share);
}

costmap::Direction TrianglePrices::fall(std::size_t triangle, const Values& values) noexcept {
  const double along = static_cast<double>(values.first) - static_cast<double>(values.second);
  const double up = 2.0 * (static_cast<double>(values.first) - static_cast<double>(values.middle)) - along;
  switch (triangle) {
    case 0:
      return {along, up};
    case 1:
      return {-up, along};
    case 2:
      return {-along, -up};
    default:
      return {up, -along};
  }
}

bool TrianglePrices::exceeds(const costmap::Direction& fall, float share) const noexcept {
  const Headings& h = headingColumns();
  const auto x = static_cast<float>(fall.x), y = static_cast<float>(fall.y);
  std::array<float, 8> most;
  most.fill(-1.0F);
  for (std::size_t k = 0; k < kHeadingCount; k += 8)
    for (std::size_t i = 0; i < 8; ++i) {
      const float over = x * h.x[k + i] + y * h.y[k + i] - share * prices[k + i];
      most[i] = most[i] > over ? most[i] : over;
    }
  return *std::ranges::max_element(most) > 0.0F;
}

float TrianglePrices::excess(const costmap::Direction& fall) const noexcept {
  const Headings& h = headingColumns();
  const auto x = static_cast<float>(fall.x), y = static_cast<float>(fall.y);
  float most = 0.0F;
  for (std::size_t k = 0; k < kHeadingCount; ++k)
    most = std::max(most, (x * h.x[k] + y * h.y[k]) / prices[k]);
  return most;
}

float TrianglePrices::excessFromNodes(std::size_t triangle, const costmap::Direction& fall) const noexcept {
  const Headings& h = headingColumns();
  const auto x = static_cast<float>(fall.x), y = static_cast<float>(fall.y);
  float most = 0.0F;
  const auto look = [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i <= to; ++i) {
      const std::size_t k = headingOf(triangle, i);
      most = std::max(most, (x * h.x[k] + y * h.y[k]) / prices[k]);
    }
  };
  look(0, kEighth);
  look(3 * kEighth, 4 * kEighth);
  look(5 * kEighth, 7 * kEighth);
  return most;
}

}  // namespace talus::planner
