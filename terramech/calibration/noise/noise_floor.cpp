#include <cmath>

#include <talus/terramech/calibration/noise/noise_floor.hpp>

namespace talus::terramech {

std::array<double, kChannels> noiseFloor(const Trial& trial, const Eigen::MatrixXd& level,
                                         const InputSlopes& slopes, const SensorNoise& noise) {
  std::array<double, kChannels> floor{};
  for (std::size_t c = 0; c < kChannels; ++c) {
    double sum = 0.0;
    int count = 0;
    for (int row = 0; row < trial.rows(); ++row) {
      const auto k = static_cast<int>(c);
      if (!std::isfinite(trial.measured(row, k))) continue;
      const double slip = noise.slipStd(trial.slip[static_cast<std::size_t>(row)]);
      // (T53)
      sum += std::pow(noise.absolute[c] / trial.denominator(row, static_cast<Channel>(k)), 2) +
             std::pow(noise.relative[c] * level(row, k), 2) + std::pow(slip * slopes.by_slip(row, k), 2) +
             std::pow(noise.load_relative * slopes.by_load(row, k), 2);
      ++count;
    }
    floor[c] = count ? std::sqrt(sum / count) : std::nan("");
  }
  return floor;
}

}  // namespace talus::terramech
