#pragma once

/// Constants of OctoMap's voxel addresses.
namespace talus::costmap {

inline constexpr unsigned kOctreeDepth = 16;  ///< levels below the root
inline constexpr int kCentreKey = 32768;      ///< key of the voxel whose lower corner is the origin

}  // namespace talus::costmap
