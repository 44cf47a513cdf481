#pragma once

#include <string>

namespace talus::cli {

/// Values of a new mission file (input of `talus plan`); all other keys are written as comments.
struct MissionDraft {
  std::string dem{"dem.tif"};
  double resolution_m = 0.0;  ///< cell size for a map without a coordinate system; 0: not stated
  bool ignore_crs = false;
  std::string rover{"mer"}, soil{"mars_blocky"};
  std::string start{"100,100"}, goal{"900,900"};  ///< map coordinates [m]
  std::string output{"route.geojson"};            ///< relative to the mission
};

/// Returns the text of a mission file with all keys that the reader accepts. Keys without a value in the
/// draft are comments with their meaning.
std::string missionText(const MissionDraft& draft);

}  // namespace talus::cli
