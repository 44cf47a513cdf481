#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <talus/planner/bound/fitted_octagon.hpp>
#include <talus/planner/route/kernels.hpp>

namespace talus::planner {
namespace {

constexpr std::size_t kParts = DirectionalCostBounds::kHeadings / 8;  // limits of one sector of the octagon
constexpr int kProjections = 2, kRaises = 4, kFullRaises = 3;
constexpr float kDiagonal = static_cast<float>(std::numbers::sqrt2 / 2);
constexpr float kEven = 0.92387F;  // cos(pi/8): equal weights of this share of a limit are below the limit
constexpr float kLeastOfEven = 0.25F;      // smallest weight as a share of these equal weights
constexpr float kRounding = 1.0F - 4e-6F;  // sums of floats

float more(float a, float b) noexcept {
  return a < b ? b : a;
}

// Heading j of a sector is p[j] e + q[j] f, where e and f are the headings at the ends of the sector.
struct Mix {
  Lanes p{}, q{}, inverse_p{};
  Mix() noexcept {
    constexpr double part = std::numbers::pi / 4 / kParts;
    for (std::size_t j = 0; j < kParts; ++j) {
      const double of = std::sin(static_cast<double>(kParts - j) * part) * std::numbers::sqrt2;
      p[j] = static_cast<float>(of);
      q[j] = static_cast<float>(std::sin(static_cast<double>(j) * part) * std::numbers::sqrt2);
      inverse_p[j] = static_cast<float>(1.0 / of);
    }
  }
};

const Mix kMix;  // in no function, because loops must not check that it is made

// Limits of the sectors counter-clockwise and clockwise from each heading.
struct Sectors {
  std::array<Lanes, 8> left, right;
  explicit Sectors(const DirectionalCostBounds::Limits& limits) noexcept {
    for (std::size_t k = 0; k < 8; ++k)
      for (std::size_t j = 0; j < kParts; ++j) {
        left[k][j] = limits[k * kParts + j];
        right[k][j] = limits[(k * kParts + limits.size() - j) % limits.size()];
      }
  }
};

// Moves the weights of a sector towards the nearest ones below each of its limits in turn.
void project(const Lanes& limits, float& left, float& right) noexcept {
  for (std::size_t j = 0; j < kParts; ++j) {
    const float p = kMix.p[j], q = kMix.q[j];
    const float over = more(0.0F, p * left + q * right - limits[j]) / (p * p + q * q);
    left = more(0.0F, left - p * over);
    right = more(0.0F, right - q * over);
  }
}

// Largest factor, at most 1, of the weights of a sector for which they are below its limits.
float ratioOf(const Lanes& limits, float left, float right) noexcept {
  Lanes ratio;
  for (std::size_t j = 0; j < kParts; ++j) ratio[j] = limits[j] / (kMix.p[j] * left + kMix.q[j] * right);
  return less(1.0F, leastOf(ratio));
}

// Largest weight of heading k that the limits, its neighbours and convexity permit.
float mostAt(std::size_t k, const Sectors& sectors, const Octagon& weights) noexcept {
  const float left = weights[(k + 1) % 8], right = weights[(k + 7) % 8];
  Lanes most;
  for (std::size_t j = 0; j < kParts; ++j)
    most[j] = less(sectors.left[k][j] - kMix.q[j] * left, sectors.right[k][j] - kMix.q[j] * right) *
              kMix.inverse_p[j];
  return less((left + right) * kDiagonal, leastOf(most));
}

// Raises each weight by half of the increase permitted, all at once, then one after the other by all of it.
void raise(const Sectors& sectors, Octagon& weights) noexcept {
  for (int round = 0; round < kRaises; ++round) {
    const Octagon before = weights;
    for (std::size_t k = 0; k < 8; ++k)
      weights[k] += 0.5F * more(0.0F, mostAt(k, sectors, before) - before[k]);
  }
  for (int round = 0; round < kFullRaises; ++round)
    for (std::size_t k = 0; k < 8; ++k) weights[k] = more(weights[k], mostAt(k, sectors, weights));
}

// Lowers weights above (sum of the neighbours) / sqrt(2) until none is left; equal weights are convex, too.
void makeConvex(Octagon& weights) noexcept {
  for (int pass = 0; pass < 16; ++pass) {
    bool lowered = false;
    for (std::size_t k = 0; k < 8; ++k) {
      const float most = (weights[(k + 7) % 8] + weights[(k + 1) % 8]) * kDiagonal;
      if (!(weights[k] > most * (1.0F + 2e-7F))) continue;
      weights[k] = most;
      lowered = true;
    }
    if (!lowered) return;
  }
  weights.fill(*std::ranges::min_element(weights));
}

}  // namespace

Octagon fittedOctagon(const DirectionalCostBounds::Limits& limits, const Octagon& wanted) {
  const float even = kEven * *std::ranges::min_element(limits);
  const Sectors sectors(limits);
  Octagon weights, ratio;
  for (std::size_t k = 0; k < 8; ++k) weights[k] = more(wanted[k], kLeastOfEven * even);
  for (int sweep = 0; sweep < kProjections; ++sweep)
    for (std::size_t k = 0; k < 8; ++k)
      if (ratioOf(sectors.left[k], weights[k], weights[(k + 1) % 8]) < 1.0F)
        project(sectors.left[k], weights[k], weights[(k + 1) % 8]);
  for (std::size_t k = 0; k < 8; ++k) ratio[k] = ratioOf(sectors.left[k], weights[k], weights[(k + 1) % 8]);
  for (std::size_t k = 0; k < 8; ++k) weights[k] *= less(ratio[k], ratio[(k + 7) % 8]);
  raise(sectors, weights);
  makeConvex(weights);
  // Octagons below the limits can be mixed; the share of equal weights keeps every weight positive.
  const float least = *std::ranges::min_element(weights), missing = kLeastOfEven * even - least,
              share = missing > 0.0F ? missing / (even - least) : 0.0F;
  Octagon octagon;
  for (std::size_t k = 0; k < 8; ++k) octagon[k] = (weights[k] + share * (even - weights[k])) * kRounding;
  return octagon;
}

Octagon FittedOctagons::of(costmap::CellCode cell) {
  const auto reflected = DirectionalCostBounds::reflected(cell);
  const std::uint32_t number = limits_.numberOf(reflected);
  while (known_.size() <= number)
    known_.push_back(fitted(limits_.reflectedLimits(static_cast<std::uint32_t>(known_.size()))));
  Octagon octagon;
  for (int k = 0; k < 8; ++k) octagon[static_cast<std::size_t>(k)] = known_[number][reflected.heading(k, 8)];
  return octagon;
}

Octagon FittedOctagons::fitted(const DirectionalCostBounds::Limits& limits) {
  Octagon wanted;
  wanted.fill(std::numeric_limits<float>::infinity());
  if (limits.front() < 0.0F) return wanted;
  // Refused headings have high limits, which must not lower their neighbours.
  for (std::size_t k = 0; k < 8; ++k) {
    wanted[k] = limits[k * kParts];
    for (std::size_t j = 1; j < kParts; ++j)
      for (const std::size_t i : {k * kParts + j, k * kParts + limits.size() - j})
        wanted[k] = std::min(wanted[k], kEven * limits[i % limits.size()]);
  }
  return fittedOctagon(limits, wanted);
}

}  // namespace talus::planner
