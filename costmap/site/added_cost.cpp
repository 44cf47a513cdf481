#include <algorithm>
#include <array>
#include <cmath>

#include <talus/costmap/site/added_cost.hpp>

namespace talus::costmap {
namespace {

constexpr std::array kDigits{10, 11, 12, 13, 15, 16, 18, 20, 22, 25, 28, 30, 35, 40, 45, 50, 60, 70, 80, 90};
constexpr int kPerDecade = static_cast<int>(kDigits.size());
constexpr int kLeastPower = -2;  // step 1 is 10e-2 J/m
constexpr int kLast = 180;       // 9e7 J/m
constexpr double kSame = 1e-7;   // tolerance for sums of floats

std::array<double, kLast + 1> tabulated() {
  std::array<double, kLast + 1> values{};
  for (int step = 1; step <= kLast; ++step) {
    const int power = kLeastPower + (step - 1) / kPerDecade;
    const double digits = kDigits[static_cast<std::size_t>((step - 1) % kPerDecade)];
    values[static_cast<std::size_t>(step)] =
        power < 0 ? digits / std::pow(10.0, -power) : digits * std::pow(10.0, power);
  }
  return values;
}

const std::array<double, kLast + 1>& values() {
  static const std::array<double, kLast + 1> all = tabulated();
  return all;
}

// Returns the sum over the layers without infinite costs.
double sumAt(const std::vector<CostLayer>& layers, std::size_t cell) {
  double sum = 0.0;
  for (const CostLayer& layer : layers) {
    const float added = layer.added_J_per_m.values()[cell];
    if (!std::isinf(added)) sum += static_cast<double>(std::isnan(added) ? layer.unseen_J_per_m : added);
  }
  return sum;
}

}  // namespace

AddedCost::AddedCost(const std::vector<CostLayer>& layers) {
  if (layers.empty()) return;
  const maps::Grid& grid = layers.front().added_J_per_m.grid();
  steps_ = maps::Raster<std::uint8_t>(grid, 0);
  for (std::size_t cell = 0; cell < grid.size(); ++cell) {
    const double sum = sumAt(layers, cell);
    steps_.values()[cell] =
        static_cast<std::uint8_t>(std::ranges::lower_bound(values(), sum * (1.0 - kSame)) - values().begin());
  }
}

double AddedCost::J_per_m(int step) noexcept {
  return values()[static_cast<std::size_t>(std::min(step, kLast))];
}

}  // namespace talus::costmap
