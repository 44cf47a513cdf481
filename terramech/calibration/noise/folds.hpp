#pragma once

#include <string>
#include <vector>

#include <talus/terramech/calibration/table/trial.hpp>

namespace talus::terramech {

/// Partition of the rows into groups that are held out together.
struct Folds {
  std::string scheme;       ///< "whole runs, five folds"
  std::vector<int> of_row;  ///< fold number
  int count = 0;
};

/// Five folds. Holds out whole runs if the rows have runs, otherwise whole levels or bands of slip, or of
/// load if slip is constant. Rows of one run are never in different folds.
Folds foldsOf(const Trial& trial);

/// Whole levels of a numeric column: one fold per level for at most eight levels, otherwise ten bands in five
/// folds; empty (count 0) for fewer than three levels of four rows.
Folds levelFolds(const Trial& trial, const std::string& column);

/// Marks the rows of a fold, or all other rows.
std::vector<char> rowsOf(const Folds& folds, int fold, bool held);

}  // namespace talus::terramech
