#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <talus/terramech/calibration/trace/residual_trace.hpp>

#include "blind_worlds.hpp"

namespace talus::terramech {

/// Telemetry of the training rows or of the held-out rows of a world; only the former have runs and sites.
inline Telemetry telemetryOf(const blind::World& world, const std::vector<std::vector<double>>& rows) {
  Telemetry t;
  t.source = "world";
  for (std::size_t k = 0; k < world.columns.size(); ++k) {
    t.numbers.push_back({world.columns[k], {}});
    for (const auto& row : rows) t.numbers.back().values.push_back(row[k]);
  }
  if (world.run.size() == rows.size()) {
    t.words.push_back({"run", {}});
    for (int run : world.run) t.words.back().values.push_back("run" + std::to_string(run));
  }
  if (world.site.size() == rows.size()) t.words.push_back({"site", world.site});
  for (std::size_t row = 0; row < rows.size(); ++row) t.lines.push_back(row + 2);
  return t;
}

inline RefinedModel baseOf(const blind::Ground& g) {
  RefinedModel m;
  m.soil = {.name = "hidden",
            .cohesion_Pa = g.cohesion,
            .friction_angle_rad = g.phi,
            .sinkage_exponent = g.n,
            .cohesive_modulus = 0.0,
            .frictional_modulus = g.k,
            .shear_modulus_m = g.shear_k,
            .c1 = g.c1,
            .c2 = g.c2,
            .density_kg_m3 = g.density};
  return m;
}

inline TraceResult traced(const blind::World& world) {
  const RefinedModel base = baseOf(world.ground);
  TraceOptions options;
  return traceResiduals(base, makeTrial(telemetryOf(world, world.rows), base), options);
}

inline std::vector<blind::Claim> claims(const TraceResult& result) {
  std::vector<blind::Claim> all;
  for (const TracedEffect& e : result.effects)
    all.push_back({e.chosen.candidate.parts.front().name, e.chosen.candidate.covariate(), name(e.channel)});
  return all;
}

}  // namespace talus::terramech
