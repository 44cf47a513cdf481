#include <cmath>
#include <cstdio>

#include <talus/planner/simulation/drive/loss_report.hpp>
#include <talus/terramech/mobility/category.hpp>

namespace talus::planner {
namespace {

std::string rounded(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", value);
  return text;
}

// Map properties of the wheel position with the weakest estimated ground.
std::string estimateThere(const LossScene& scene) {
  std::optional<costmap::GroundBelief> weakest;
  std::uint8_t category = 0;
  for (const costmap::TelemetryReading& wheel : scene.seen.wheels) {
    const auto cell = scene.map.grid().cellAt(wheel.place);
    const auto ground = cell ? scene.map.ground(*cell) : std::nullopt;
    if (!ground || (weakest && ground->pull.value >= weakest->pull.value)) continue;
    weakest = ground;
    category = scene.map.costs().category(*cell);
  }
  if (!weakest) return "no ground on the map there";
  return std::string("category on the map: ") + terramech::name(static_cast<terramech::Category>(category)) +
         ", DP/W " + rounded(weakest->pull.value) + " +- " + rounded(weakest->pull.std);
}

std::string readings(const LossScene& scene) {
  const double radius_m = scene.map.model().rover().wheel.radius_m;
  double slip = std::nan(""), sinkage = std::nan("");
  for (const costmap::TelemetryReading& wheel : scene.seen.wheels) {
    slip = std::fmax(slip, wheel.slip);
    sinkage = std::fmax(sinkage, wheel.sinkage_m / radius_m);
  }
  return "wheels read slip up to " + rounded(slip) + ", sinkage over radius up to " + rounded(sinkage);
}

}  // namespace

std::string causeOfLoss(const LossScene& scene) {
  int undeclared = 0;
  for (const TrueWorld::SimulatedWheel& wheel : scene.step.wheels)
    undeclared += scene.world.inPatch(wheel.place) ? 1 : 0;
  const std::string stop = scene.why_it_stopped.empty()
                               ? scene.step.slides ? "slid without an alarm" : "spun without an alarm"
                               : "held when it reversed after '" + scene.why_it_stopped + "'";
  return stop + "; " + std::to_string(undeclared) + " of " + std::to_string(scene.step.wheels.size()) +
         " wheels on undeclared ground; " + estimateThere(scene) + "; " + readings(scene);
}

}  // namespace talus::planner
