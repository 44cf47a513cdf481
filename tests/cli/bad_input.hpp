#pragma once

#include <functional>
#include <string>
#include <vector>

#include "run_program.hpp"

namespace talus::cli {

/// A call of the program that must end with one line on stderr.
struct BadCall {
  std::vector<std::string> words;
  int code;          ///< exit code
  std::string says;  ///< part of the line
};

/// Files that no command should stand: maps and tables that are empty, garbage, cut, without data, huge by
/// their word.
class BadFiles {
 public:
  BadFiles();

  const Folder& folder() const noexcept { return folder_; }

 private:
  Folder folder_;
};

/// Runs each call in the folder and expects its code, one line that says it, nothing on stdout and no file
/// more or less.
void expectRefused(const BadFiles& files, const std::vector<BadCall>& calls);

/// An ESRI ASCII grid of one metre cells with the lower left corner at 0,0.
std::string asciiGrid(int columns, int rows, const std::function<double(int column, int row)>& height_m);

}  // namespace talus::cli
