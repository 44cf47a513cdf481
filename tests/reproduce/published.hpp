#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <talus/cli/draw/plot.hpp>
#include <talus/common/common.hpp>
#include <talus/costmap/ground/ground_model.hpp>
#include <talus/maps/maps.hpp>
#include <talus/planner/route/problem.hpp>

namespace talus::reproduce {

/// A published number and ours.
struct PublishedLine {
  std::string quantity;  ///< with its unit
  double theirs = std::numeric_limits<double>::quiet_NaN();
  double ours = std::numeric_limits<double>::quiet_NaN();  ///< NaN: no result
  bool relative = false;  ///< true: the error is a share of `theirs`; false: a difference

  double error() const { return relative ? ours / theirs - 1.0 : ours - theirs; }
};

/// A published result whose inputs can be rebuilt, and what we get; without lines the remark has the reason.
struct PublishedCase {
  std::string name;    ///< word of `--published NAME`
  std::string source;  ///< key in REFERENCES.bib, or the publication
  std::string remark;  ///< inputs that are ours, and what the difference means
  std::vector<PublishedLine> lines{};
  std::vector<cli::Plot> plots{};
};

/// Rebuilds the published results about wheels, those about routes, or those whose name is `name`; empty: all.
/// Inputs of measured data and real maps come from the folders of TALUS_MEASURED_DATA and TALUS_REAL_MAPS; a case
/// without its folder has a remark.
std::vector<PublishedCase> publishedWheels(const std::string& name, const ProgressMonitor& watch);
std::vector<PublishedCase> publishedRoutes(const std::string& name, const ProgressMonitor& watch);

/// The file in the folder that an environment variable states; if there is none, empty, and the remark of the case says
/// what is needed.
std::string sharedFile(const char* variable, const std::string& file, PublishedCase& made);

}  // namespace talus::reproduce
