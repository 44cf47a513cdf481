#pragma once

#include <functional>
#include <string>
#include <vector>

#include "run_program.hpp"

namespace talus::cli {

/// A program call that must fail with one line on stderr.
struct BadCall {
  std::vector<std::string> words;
  int code;          ///< exit code
  std::string says;  ///< part of the line
};

/// Files that every subcommand must refuse: maps and tables that are empty, random, truncated, without data,
/// or whose header states a huge size.
class BadFiles {
 public:
  BadFiles();

  const Folder& folder() const noexcept { return folder_; }

 private:
  Folder folder_;
};

/// Runs each call in the folder; expects its exit code, one line on stderr that contains `says`, no output on
/// stdout, and no file added or removed.
void expectRefused(const BadFiles& files, const std::vector<BadCall>& calls);

/// An ESRI ASCII grid of 1 m cells with the lower left corner at (0, 0).
std::string asciiGrid(int columns, int rows, const std::function<double(int column, int row)>& height_m);

}  // namespace talus::cli
