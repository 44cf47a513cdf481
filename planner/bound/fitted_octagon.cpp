#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <talus/planner/bound/fitted_octagon.hpp>

namespace talus::planner {
namespace {

constexpr std::size_t kParts = DirectionalCostBounds::kHeadings / 8;  // limits of one sector of the octagon
constexpr int kProjections = 2, kRaises = 4, kFullRaises = 3;
constexpr double kDiagonal = std::numbers::sqrt2 / 2;
constexpr double kEven = 0.92387;  // cos(pi/8): equal weights of this share of a limit are below the limit
constexpr double kLeastOfEven = 0.25;     // smallest weight as a share of these equal weights
constexpr double kRounding = 1.0 - 1e-6;  // weights are floats

using Weights = std::array<double, 8>;

// Heading j of a sector is p[j] e + q[j] f, where e and f are the headings at the ends of the sector.
struct Mix {
  std::array<double, kParts + 1> p{}, q{}, inverse_p{};
  Mix() noexcept {
    constexpr double part = std::numbers::pi / 4 / kParts;
    for (std::size_t j = 0; j <= kParts; ++j) {
      p[j] = std::sin(static_cast<double>(kParts - j) * part) / kDiagonal;
      q[j] = std::sin(static_cast<double>(j) * part) / kDiagonal;
      inverse_p[j] = 1.0 / p[j];
    }
  }
};

const Mix& mix() noexcept {
  static const Mix made;
  return made;
}

// Limits of the sectors, with those at both ends.
using Sectors = std::array<std::array<double, kParts + 1>, 8>;

Sectors sectorsOf(const DirectionalCostBounds::Limits& limits) noexcept {
  Sectors sectors;
  for (std::size_t k = 0; k < 8; ++k)
    for (std::size_t j = 0; j <= kParts; ++j)
      sectors[k][j] = static_cast<double>(limits[(k * kParts + j) % limits.size()]);
  return sectors;
}

// Moves the weights of a sector towards the nearest ones below each of its limits in turn.
void project(const std::array<double, kParts + 1>& limits, double& left, double& right) noexcept {
  for (std::size_t j = 0; j <= kParts; ++j) {
    const double p = mix().p[j], q = mix().q[j];
    const double over = std::max(0.0, p * left + q * right - limits[j]) / (p * p + q * q);
    left = std::max(0.0, left - p * over);
    right = std::max(0.0, right - q * over);
  }
}

// Largest factor, at most 1, of the weights of a sector for which they are below its limits.
double ratioOf(const std::array<double, kParts + 1>& limits, double left, double right) noexcept {
  double most = 1.0;
  for (std::size_t j = 0; j <= kParts; ++j)
    most = std::max(most, (mix().p[j] * left + mix().q[j] * right) / limits[j]);
  return 1.0 / most;
}

// Largest weight of heading k that the limits, its neighbours and convexity permit.
double mostAt(std::size_t k, const Sectors& sectors, const Weights& weights) noexcept {
  const double left = weights[(k + 1) % 8], right = weights[(k + 7) % 8];
  double most = (left + right) * kDiagonal;
  for (std::size_t j = 0; j < kParts; ++j)
    most = std::min({most, (sectors[k][j] - mix().q[j] * left) * mix().inverse_p[j],
                     (sectors[(k + 7) % 8][kParts - j] - mix().q[j] * right) * mix().inverse_p[j]});
  return most;
}

// Raises each weight by half of the increase permitted, all at once, then one after the other by all of it.
void raise(const Sectors& sectors, Weights& weights) noexcept {
  for (int round = 0; round < kRaises; ++round) {
    const Weights before = weights;
    for (std::size_t k = 0; k < 8; ++k)
      weights[k] += 0.5 * std::max(0.0, mostAt(k, sectors, before) - before[k]);
  }
  for (int round = 0; round < kFullRaises; ++round)
    for (std::size_t k = 0; k < 8; ++k) weights[k] = std::max(weights[k], mostAt(k, sectors, weights));
}

// Lowers weights above (sum of the neighbours) / sqrt(2) until none is left; equal weights are convex, too.
void makeConvex(Weights& weights) noexcept {
  for (int pass = 0; pass < 16; ++pass) {
    bool lowered = false;
    for (std::size_t k = 0; k < 8; ++k) {
      const double most = (weights[(k + 7) % 8] + weights[(k + 1) % 8]) * kDiagonal;
      if (!(weights[k] > most * (1.0 + 1e-7))) continue;
      weights[k] = most;
      lowered = true;
    }
    if (!lowered) return;
  }
  weights.fill(*std::ranges::min_element(weights));
}

}  // namespace

Octagon fittedOctagon(const DirectionalCostBounds::Limits& limits, const Octagon& wanted) {
  const double even = kEven * static_cast<double>(*std::ranges::min_element(limits));
  const Sectors sectors = sectorsOf(limits);
  Weights weights, ratio;
  for (std::size_t k = 0; k < 8; ++k)
    weights[k] = std::max(static_cast<double>(wanted[k]), kLeastOfEven * even);
  for (int sweep = 0; sweep < kProjections; ++sweep)
    for (std::size_t k = 0; k < 8; ++k)
      if (ratioOf(sectors[k], weights[k], weights[(k + 1) % 8]) < 1.0)
        project(sectors[k], weights[k], weights[(k + 1) % 8]);
  for (std::size_t k = 0; k < 8; ++k) ratio[k] = ratioOf(sectors[k], weights[k], weights[(k + 1) % 8]);
  for (std::size_t k = 0; k < 8; ++k) weights[k] *= std::min(ratio[k], ratio[(k + 7) % 8]);
  raise(sectors, weights);
  makeConvex(weights);
  // Octagons below the limits can be mixed; the share of equal weights keeps every weight positive.
  const double least = *std::ranges::min_element(weights), missing = kLeastOfEven * even - least,
               share = missing > 0.0 ? missing / (even - least) : 0.0;
  Octagon octagon;
  for (std::size_t k = 0; k < 8; ++k)
    octagon[k] = static_cast<float>((weights[k] + share * (even - weights[k])) * kRounding);
  return octagon;
}

Octagon FittedOctagons::of(costmap::CellCode cell) {
  const auto reflected = DirectionalCostBounds::reflected(cell);
  const auto [at, fresh] = known_.try_emplace(reflected.cell.bits());
  if (fresh) at->second = fitted(reflected.cell);
  Octagon octagon;
  for (int k = 0; k < 8; ++k) octagon[static_cast<std::size_t>(k)] = at->second[reflected.heading(k, 8)];
  return octagon;
}

Octagon FittedOctagons::fitted(costmap::CellCode cell) {
  Octagon wanted;
  wanted.fill(std::numeric_limits<float>::infinity());
  DirectionalCostBounds::Limits limits;
  if (!limits_.of(cell, limits)) return wanted;
  // Refused headings have high limits, which must not lower their neighbours.
  for (std::size_t k = 0; k < 8; ++k) {
    wanted[k] = limits[k * kParts];
    for (std::size_t j = 1; j < kParts; ++j)
      for (const std::size_t i : {k * kParts + j, k * kParts + limits.size() - j})
        wanted[k] = std::min(wanted[k], static_cast<float>(kEven) * limits[i % limits.size()]);
  }
  return fittedOctagon(limits, wanted);
}

}  // namespace talus::planner
