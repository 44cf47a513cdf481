#include "noise_table.hpp"

namespace talus::terramech {
namespace {

TEST(CovariateTests, OffsetsOfAFewRunsRaiseNoAlarm) {
  // Property: p <= 0.05 in about one of twenty tables of four runs each; five or more of forty has
  // probability 0.05.
  int alarms = 0;
  for (std::uint64_t seed = 100; seed < 140; ++seed)
    alarms += NoiseTable(80, 4, seed).addOffsets(2.0).pValue("") <= 0.05;
  EXPECT_LE(alarms, 5);
}

TEST(CovariateTests, WhatVariesWithinRunsIsFoundInFourOfThem) {
  NoiseTable table(80, 4, 6);
  table.addOffsets(2.0);
  for (int row = 0; row < 80; ++row)
    table.residual(row, 0) += 6.0 * (table.trial.slip[static_cast<std::size_t>(row)] - 0.3);
  EXPECT_TRUE(table.units().runs);
  EXPECT_LE(table.pValue("slip"), 0.01);
  EXPECT_GT(table.pValue("time_s"), 0.05);
}

}  // namespace
}  // namespace talus::terramech
