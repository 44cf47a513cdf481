#pragma once

#include <string>

#include <talus/terramech/calibration.hpp>

#include "made_rows.hpp"

namespace talus::terramech {

inline RefinedModel sand() {
  RefinedModel model;
  model.soil = madeSand();
  return model;
}

/// Rows of the synthetic sand with the relative error `noise` of each reading, and a pull offset of each run
/// with the standard deviation `run_offset`.
inline Trial noisyTrial(const RefinedModel& model, double noise, double run_offset = 0.0) {
  MadeRows rows(wheelColumns());
  std::mt19937_64 random(4);
  std::normal_distribution<double> offset(0.0, run_offset + 1e-12);
  double off = 0.0;
  for (int k = 0; k < 160; ++k) {
    if (k % 16 == 0) off = offset(random);
    std::vector<double> row =
        wheelRow(model.soil, 50.0 + (k * 7) % 60, 0.05 + 0.05 * ((k * 11) % 16), noise, random);
    row[4] += off * row[0];
    rows.add(row, "run" + std::to_string(k / 16));
  }
  return makeTrial(rows.telemetry("run"), model);
}

}  // namespace talus::terramech
