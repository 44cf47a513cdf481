#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <talus/cli/draw/plot.hpp>

namespace talus::reproduce {

/// A reproduced figure of the thesis: its claim and the result.
struct ThesisFigure {
  std::string number;  ///< "2.5"
  std::string title;
  std::string claim;    ///< the statement of the thesis
  std::string found;    ///< what we get, with its numbers
  std::string verdict;  ///< "reproduced", "in part: why", "not reproduced: why"
  std::vector<cli::Plot> plots;
};

/// A verdict that follows from what was found: "reproduced" and what else is to be said of it, or the other.
inline std::string verdictOf(bool holds, const std::string& otherwise, const std::string& remark = "") {
  return holds ? "reproduced" + remark : otherwise;
}

/// Figures of chapter 2 (2.3, 2.5, 2.6, 2.7, 2.9).
std::vector<ThesisFigure> estimationFigures(std::uint64_t seed);

/// Figures of appendices A, C and D (A.4, C.1, C.4, D.1, D.2, D.3).
std::vector<ThesisFigure> appendixFigures(std::uint64_t seed);

/// Figures of chapter 3 (3.5, 3.6, 3.7, 3.8, 3.12).
std::vector<ThesisFigure> traversabilityFigures(std::uint64_t seed);

/// Writes charts as one PNG picture, two in a row; dashed lines are drawn thin. @throws InputError
void saveFigure(const std::filesystem::path& path, const std::vector<cli::Plot>& plots);

}  // namespace talus::reproduce
