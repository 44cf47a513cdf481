#pragma once

#include <string>
#include <vector>

#include "raster.hpp"

namespace safety {

/// What a wheel read, as EVIDENCE.db keeps it; NaN where it read nothing.
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

/// Every row in order. Throws std::runtime_error.
std::vector<JournalRow> readJournal(const std::string& path);

}  // namespace safety
