#pragma once

#include <string>
#include <vector>

#include <talus/terramech/calibration/table/trial.hpp>

namespace talus::terramech {

/// Folds: a partition of the rows into groups. The rows of a fold are held out together.
struct Folds {
  std::string scheme;       ///< description, for example "whole runs, five folds"
  std::vector<int> of_row;  ///< fold number of each row, from 0
  int count = 0;            ///< number of folds; 0: no partition
};

/// Returns five folds of whole runs. If the rows have no runs, the folds consist of whole levels (rows of one
/// value) or bands of slip, or of load if slip is constant. Rows of one run are never in different folds.
Folds foldsOf(const Trial& trial);

/// Returns folds of whole levels (rows with the same value) of a numeric column. There is one fold per level
/// for at most eight levels, otherwise ten bands in five folds. Returns no folds if there are fewer than
/// three levels of four rows.
Folds levelFolds(const Trial& trial, const std::string& column);

/// Marks the rows of a fold if `held` is true, otherwise the rows of all other folds.
std::vector<char> rowsOf(const Folds& folds, int fold, bool held);

}  // namespace talus::terramech
