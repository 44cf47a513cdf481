#pragma once

#include <string>
#include <vector>

#include <talus/terramech/calibration/table/trial.hpp>

namespace talus::terramech {

/// Rows that are held out together.
struct Folds {
  std::string scheme;       ///< "whole runs, five folds"
  std::vector<int> of_row;  ///< number of the fold
  int count = 0;
};

/// Whole runs where the rows have runs, else whole levels or bands of slip, or of load where slip is
/// constant: never rows of the same run on both sides. Five folds.
Folds foldsOf(const Trial& trial);

/// Whole levels of a numeric column, each a fold of its own where there are at most eight, else ten bands in
/// five folds; empty (count 0) where the column has fewer than three levels of four rows.
Folds levelFolds(const Trial& trial, const std::string& column);

/// Rows of a fold, or all others.
std::vector<char> rowsOf(const Folds& folds, int fold, bool held);

}  // namespace talus::terramech
