#pragma once

#include <string>

namespace talus::cli {

/// What a new mission knows: the rest of its keys are remarks.
struct MissionDraft {
  std::string dem{"dem.tif"};
  double resolution_m = 0.0;  ///< of a map without a coordinate system; 0: not stated
  bool ignore_crs = false;
  std::string rover{"mer"}, soil{"mars_blocky"};
  std::string start{"100,100"}, goal{"900,900"};  ///< in map metres
};

/// A mission file with every key that its reader takes, those that the draft does not know as remarks with their meaning.
std::string missionText(const MissionDraft& draft);

}  // namespace talus::cli
