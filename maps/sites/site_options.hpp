#pragma once

#include <cstdint>

namespace talus::maps {

/// Kinds of generated terrain.
enum class SiteKind {
  Craters,  ///< lunar terrain: craters with a power-law size distribution, fresh to degraded, on regolith
  Dunes,    ///< Martian terrain: transverse dunes with slip faces at the angle of repose, over bedrock
  Rocks,    ///< Martian plain: rocks with an exponential size-frequency distribution on rolling duricrust
};

/// Kind, size and seed of a generated site.
struct SiteOptions {
  SiteKind kind = SiteKind::Craters;
  int width = 512;            ///< number of columns, 8 to 20000
  int height = 512;           ///< number of rows, 8 to 20000
  double resolution_m = 1.0;  ///< side length of a cell, 0.01 to 1000
  /// Seed of all random numbers. Equal seeds give bit-identical sites on any machine and for any number of
  /// threads.
  std::uint64_t seed = 1;
  /// Number of threads, >= 1.
  int threads = 1;
};

/// Terrain classes of generated sites, by increasing weakness of the soil; Rock marks cells of bedrock or
/// rocks.
enum class SiteClass : std::uint8_t { Firm = 1, Loose = 2, VeryLoose = 3, Rock = 4 };

}  // namespace talus::maps
