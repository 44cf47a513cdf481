#include <algorithm>
#include <cmath>
#include <numbers>

#include <talus/terramech/estimate/truncated_gaussian.hpp>
#include <talus/terramech/numerics/normal_distribution.hpp>

namespace talus::terramech {
namespace {

// Below this probability mass only the far tail remains, which is approximated by an exponential.
constexpr double kLeastMass = 1e-280;

// Truncated standard normal at fraction u of its probability mass, and the logarithm of its density.
struct Cut {
  double at;
  double log_density;
};

Cut tail(double low, double high, double u) {
  const double rate = -high;
  const double away = std::max(std::log(u) / rate, low - high);
  return {high + away, std::log(rate) + rate * away};
}

Cut cut(double low, double high, double u) {
  if (low > 0.0) {  // mirror to the lower tail, where the distribution function is accurate
    const Cut mirrored = cut(-high, -low, 1.0 - u);
    return {-mirrored.at, mirrored.log_density};
  }
  const double below = normalProbability(low);
  const double mass = normalProbability(high) - below;
  if (mass < kLeastMass) return tail(low, high, u);
  const double at = std::clamp(normalQuantile(std::clamp(below + u * mass, 1e-300, 1.0 - 1e-16)), low, high);
  return {at, -0.5 * at * at - 0.5 * std::log(2.0 * std::numbers::pi) - std::log(mass)};
}

}  // namespace

TruncatedGaussian::TruncatedGaussian(const SoilVector& mean, const SoilMatrix& covariance, const SoilBox& box)
    : mean_(mean), box_(box) {
  SoilMatrix left = covariance;  // conditional covariance given the coordinates drawn so far
  for (int turn = 0; turn < kSoilParameters; ++turn) {
    int widest = 0;
    left.diagonal().maxCoeff(&widest);
    order_[static_cast<std::size_t>(turn)] = widest;
    root_.col(turn) = left.col(widest) / std::sqrt(left(widest, widest));
    left -= root_.col(turn) * root_.col(turn).transpose();
    left.row(widest).setZero();
    left.col(widest).setZero();
    left(widest, widest) = -1.0;  // drawn
  }
}

TruncatedGaussian::Draw TruncatedGaussian::draw(const SoilVector& even) const {
  Draw draw{.at = mean_, .log_density = 0.0};
  for (int turn = 0; turn < kSoilParameters; ++turn) {
    const int k = order_[static_cast<std::size_t>(turn)];
    const double centre = draw.at[k];  // shifted by the coordinates drawn before
    const double scale = root_(k, turn);
    const auto [e, log_density] =
        cut((box_.low[k] - centre) / scale, (box_.high[k] - centre) / scale, even[turn]);
    draw.at += e * root_.col(turn);
    draw.log_density += log_density - std::log(scale);
  }
  return draw;
}

}  // namespace talus::terramech
