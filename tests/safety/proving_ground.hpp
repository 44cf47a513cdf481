#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "ground.hpp"
#include "journal.hpp"
#include "route.hpp"

namespace safety {

/// Paths that the campaign needs.
struct Places {
  std::string program;           ///< path of the program talus
  std::string library;           ///< folder with soils/ and rovers/
  std::string maps;              ///< folder of real maps; empty: generated and drawn sites only
  std::filesystem::path folder;  ///< folder for the files of sites and routes
};

/// Kind of a site, determined by its number.
enum class SiteKind { Rocks, Dunes, Craters, Drawn, Real };

/// A site on disk: DEM, classes, soils, keep-out areas, and a map with or without updates from drives.
struct ProvingGround {
  std::uint64_t number = 0;
  SiteKind kind = SiteKind::Rocks;
  std::string rover;
  bool learned = false;  ///< whether the map is updated with the telemetry of two drives
  std::filesystem::path folder;
  Site site;
  std::vector<JournalRow> journal;
  std::vector<std::pair<Place, Place>> pairs;  ///< start and goal of the site's errands
};

/// Makes site number n. The files depend only on the number, the program and the maps. Throws
/// std::runtime_error if the program fails.
ProvingGround provingGround(const Places& places, std::uint64_t number);

/// Names of the planners in the order of a site's routes.
const std::vector<std::string>& planners();

/// A planning task: start, goal and planner.
struct Errand {
  Place start, goal;
  std::string planner;
};

/// Number of start-goal pairs of a site. Each pair is the first of 16 draws for which the field planner finds
/// a route, or else the last draw. More pairs share the cost of making the site.
inline constexpr std::size_t kPairs = 4;

/// Errand number k of a site: all planners for the first pair, then for the next pair.
Errand errand(const ProvingGround& ground, std::uint64_t k);

/// A call of the program in a folder; the output is kept in log.txt of that folder.
struct Call {
  std::string words;
  int run(const Places& places, const std::filesystem::path& folder) const;
};

/// The call that plans an errand.
Call planCall(const ProvingGround& ground, const Errand& errand, const std::string& output);

/// "rocks", "dunes", "craters", "drawn", "real".
const char* name(SiteKind kind);

}  // namespace safety
