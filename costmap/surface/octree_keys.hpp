#pragma once

/// Constants of OctoMap's keys. A key is the integer position of a voxel along one axis.
namespace talus::costmap {

inline constexpr unsigned kOctreeDepth = 16;  ///< number of octree levels below the root
inline constexpr int kCentreKey = 32768;      ///< key of the voxel whose lower corner is at the coordinate 0

}  // namespace talus::costmap
