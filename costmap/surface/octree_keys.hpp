#pragma once

/// Constants of OctoMap's keys, i.e. of the integer positions of voxels along one axis.
namespace talus::costmap {

inline constexpr unsigned kOctreeDepth = 16;  ///< number of levels below the root
inline constexpr int kCentreKey = 32768;      ///< key of the voxel whose lower corner is at the coordinate 0

}  // namespace talus::costmap
