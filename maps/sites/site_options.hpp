#pragma once

#include <cstdint>

namespace talus::maps {

/// What kind of ground is made.
enum class SiteKind {
  Craters,  ///< lunar: power-law crater field, fresh to worn, on regolith
  Dunes,    ///< martian: transverse dunes with slip faces at the angle of repose over bedrock
  Rocks,    ///< martian plain: rocks of a size-frequency law on rolling duricrust
};

/// How large and which one.
struct SiteOptions {
  SiteKind kind = SiteKind::Craters;
  int width = 512;            ///< cells, 8 to 20000
  int height = 512;           ///< cells, 8 to 20000
  double resolution_m = 1.0;  ///< 0.01 to 1000
  std::uint64_t seed = 1;     ///< same seed, same bytes, on any machine and with any number of threads
  int threads = 1;
};

/// Class numbers of generated sites.
enum class SiteClass : std::uint8_t { Firm = 1, Loose = 2, VeryLoose = 3, Rock = 4 };

}  // namespace talus::maps
