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

/// Where the campaign finds what it needs.
struct Places {
  std::string program;           ///< talus
  std::string library;           ///< folder with soils/ and rovers/
  std::string maps;              ///< folder of real maps; empty: generated and drawn sites alone
  std::filesystem::path folder;  ///< for the files of sites and routes
};

/// What a site is made of, by its number alone.
enum class SiteKind { Rocks, Dunes, Craters, Drawn, Real };

/// A site on disk: DEM, classes, soils, keep-out areas, a map with or without what drives taught it.
struct ProvingGround {
  std::uint64_t number = 0;
  SiteKind kind = SiteKind::Rocks;
  std::string rover;
  bool learned = false;  ///< telemetry of two drives was put in
  std::filesystem::path folder;
  Site site;
  std::vector<JournalRow> journal;
  std::vector<std::pair<Place, Place>> pairs;  ///< start and goal of its errands
};

/// Makes site number n: the same files for the same number, program and maps. Throws std::runtime_error where
/// the program fails.
ProvingGround provingGround(const Places& places, std::uint64_t number);

/// Planners in the order of a site's routes.
const std::vector<std::string>& planners();

/// Two places that a route is sought between.
struct Errand {
  Place start, goal;
  std::string planner;
};

/// Pairs of places of a site: each the first of six draws between which the field planner finds a route, or
/// the last of them.
inline constexpr std::size_t kPairs = 2;

/// Errand number k of a site: all planners, then the next pair of places.
Errand errand(const ProvingGround& ground, std::uint64_t k);

/// A call of the program in a folder, its output kept in log.txt there.
struct Call {
  std::string words;
  int run(const Places& places, const std::filesystem::path& folder) const;
};

/// The call that plans an errand.
Call planCall(const ProvingGround& ground, const Errand& errand, const std::string& output);

/// "rocks", "dunes", "craters", "drawn", "real".
const char* name(SiteKind kind);

}  // namespace safety
