#pragma once

#include <string>
#include <vector>

#include "raster.hpp"

namespace safety {

/// One row of the evidence journal (EVIDENCE.db): readings of one wheel; NaN for a missing reading.
struct JournalRow {
  std::string source;
  bool accepted = false;
  double time_s = 0.0;
  Place place;
  double load_N = 0.0;
  double slip = 0.0;
  double torque_Nm = 0.0;
  double sinkage_m = 0.0;
  double gradient = 0.0;
  int pass = 1;
};

/// Reads all rows in order. Throws std::runtime_error.
std::vector<JournalRow> readJournal(const std::string& path);

}  // namespace safety
