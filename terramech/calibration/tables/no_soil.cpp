#include <array>
#include <cmath>

#include <fmt/format.h>

#include <talus/common/common.hpp>
#include <talus/terramech/calibration/tables/no_soil.hpp>

namespace talus::terramech {
namespace {

constexpr double kLeft = 0.5;  // unexplained share of the root mean square of a channel's readings

// Residual of one channel relative to its readings; 0 if the residual is small compared to load or radius;
// infinite if all readings are 0 and the predictions are not.
double leftOf(const SoilAnswer& answer, int channel) {
  double readings = 0.0, residuals = 0.0;
  int rows = 0;
  for (Eigen::Index row = 0; row < answer.measured.rows(); ++row) {
    const double y = answer.measured(row, channel), f = answer.predicted(row, channel);
    if (!std::isfinite(y) || !std::isfinite(f)) continue;
    readings += y * y;
    residuals += (y - f) * (y - f);
    ++rows;
  }
  return residuals > kCoarse * kCoarse * rows ? std::sqrt(residuals / readings) : 0.0;
}

}  // namespace

const char* columnOf(Channel channel) {
  constexpr std::array<const char*, kChannels> kColumns{"drawbar_pull_N", "sinkage_m", "torque_Nm",
                                                        "side_force_N"};
  return kColumns[static_cast<std::size_t>(channel)];
}

UnexplainedColumn unexplained(const SoilAnswer& answer) {
  UnexplainedColumn worst{.column = "", .left = kLeft};
  for (int channel = 0; channel < kChannels; ++channel)
    if (const double left = leftOf(answer, channel); left > worst.left)
      worst = {.column = columnOf(static_cast<Channel>(channel)), .left = left};
  return worst;
}

bool leavesUnexplained(const SoilAnswer& answer, Channel channel) {
  return leftOf(answer, static_cast<int>(channel)) > kLeft;
}

std::string noSoilExplains(const SoilEstimate& estimate, const SoilAnswer& answer) {
  const bool poor = answer.misfit > kMisfit;
  std::string why;
  if (const UnexplainedColumn worst = unexplained(answer); poor && !worst.column.empty())
    why = std::isfinite(worst.left)
              ? fmt::format("the nearest leaves {:.0f} % of {}", 100.0 * worst.left, worst.column)
              : fmt::format("the nearest has a {} that reads 0", worst.column);
  else if (!estimate.implausible().empty())
    why = fmt::format("the nearest has a cohesion of {:.3g} kPa and a friction angle of {:.0f} deg",
                      1e-3 * estimate.cohesion_Pa, estimate.friction_angle_rad / kDegree);
  else
    return {};
  return (poor ? fmt::format("no soil explains the rows (misfit {:.1f}, 1 expected): ", answer.misfit)
               : std::string("no soil is like that of the rows: ")) +
         why;
}

}  // namespace talus::terramech
