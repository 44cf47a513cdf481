// Energy, slip and refusals of the cost table on planes against SlopeEquilibrium: slope_costs prints a row
// for each rover and soil of the library. Evaluates every degree of heading on planes 0.017 of gradient
// apart, within the limits of pitch and roll; energies only with a reserve of pull and side force above
// 0.03.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include <talus/common/constants.hpp>
#include <talus/costmap/ground/ground_model.hpp>
#include <talus/terramech/io/soil_library.hpp>
#include <talus/terramech/mobility/slope_equilibrium.hpp>

namespace talus {
namespace {

using costmap::Refusal;

constexpr double kAway = 0.03, kSpare = 0.02;

struct Compared {
  std::vector<double> ratios;
  double step = 0.0, exact_step = 0.0, slip = 0.0;
  int refused_good = 0, allowed_bad = 0;
};

Compared compared(const terramech::Soil& soil, const terramech::Rover& rover) {
  const costmap::GroundModel model(
      {.rover = rover, .classes = {{.number = 0, .soil = soil}}, .policy = {.allow_dangerous = true}});
  costmap::GroundBelief belief = model.prior(0);
  belief.pull.std = 0.0;
  const costmap::TravelCost cost(model.limits(), std::vector<costmap::GroundCost>{model.ground(0, belief)});
  const terramech::SlopeEquilibrium exact(soil, rover);
  Compared out;
  for (double steep = 0.02; steep < std::min(model.limits().max_along, model.limits().max_across);
       steep += 0.017) {
    const costmap::CellCode cell({.dz_dx = steep, .dz_dy = 0.0, .curve = 0});
    double before_J = 0.0, exact_before_J = 0.0;
    for (int degree = 0; degree <= 180; ++degree) {
      const costmap::Direction towards{std::cos(degree * kDegree), std::sin(degree * kDegree)};
      const double along = cell.dzDx() * towards.x, across = -cell.dzDx() * towards.y;
      const costmap::TravelState said = cost.detail(cell, towards);
      const terramech::SlopeState want = exact.at({along, across});
      const bool allowed = said.refusal == Refusal::None;
      const double spare = want.holds() ? 1.0 - exact.leastStrength({along, across}) : 0.0;
      out.allowed_bad += allowed && !want.holds() ? 1 : 0;
      out.refused_good += !allowed && spare > kSpare ? 1 : 0;
      if (!allowed || spare < kAway) {
        before_J = 0.0;
        continue;
      }
      const double said_J = static_cast<double>(said.energy_J_per_m),
                   want_J = want.energy_J_per_m * std::hypot(1.0, along);
      out.ratios.push_back(said_J / want_J);
      out.slip = std::max(out.slip, std::abs(static_cast<double>(said.slip) - want.slip));
      if (before_J > 0.0) {
        out.step = std::max(out.step, std::abs(said_J / before_J - 1.0));
        out.exact_step = std::max(out.exact_step, std::abs(want_J / exact_before_J - 1.0));
      }
      before_J = said_J;
      exact_before_J = want_J;
    }
  }
  std::ranges::sort(out.ratios);
  return out;
}

}  // namespace
}  // namespace talus

int main() {
  std::printf("%-12s %-14s %6s %25s %22s %6s %8s %8s\n", "rover", "soil", "n", "energy: least median most",
              "most a degree (exact)", "slip", "refused", "allowed");
  for (const char* rover : {"lunar_micro", "mer", "fido"})
    for (const char* soil : {"lunar_nominal", "mars_crusty", "sandy_loam", "dry_sand"}) {
      const auto c = talus::compared(talus::terramech::loadSoil(soil), talus::terramech::loadRover(rover));
      if (c.ratios.empty()) continue;
      std::printf("%-12s %-14s %6zu %11.3f %6.3f %6.3f %12.3f %9.3f %6.3f %8d %8d\n", rover, soil,
                  c.ratios.size(), c.ratios.front(), c.ratios[c.ratios.size() / 2], c.ratios.back(), c.step,
                  c.exact_step, c.slip, c.refused_good, c.allowed_bad);
    }
}
