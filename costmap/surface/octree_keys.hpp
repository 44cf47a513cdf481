#pragma once

/// How OctoMap addresses a voxel.
namespace talus::costmap {

inline constexpr unsigned kOctreeDepth = 16;  ///< levels below the root
inline constexpr int kCentreKey = 32768;      ///< of the voxel just beyond the origin

}  // namespace talus::costmap
