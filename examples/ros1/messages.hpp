#pragma once

#include <vector>

#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Path.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>

#include "navigator.hpp"

/// Conversion between ROS messages and the types of navigator.hpp. A malformed message throws
/// std::runtime_error with one line.
namespace rover_ros {

/// Rigid transform from the frame of a message to the map frame.
class RigidTransform {
 public:
  explicit RigidTransform(const geometry_msgs::Transform& T_map_frame);
  CloudPoint operator()(const CloudPoint& p_frame) const;
  /// Returns the direction of the frame's x axis in the map plane, counter-clockwise from the map's x axis.
  double heading_rad() const;

 private:
  double r_[3][3];
  CloudPoint t_;
};

/// Returns the finite points of a cloud with fields x, y and z. Throws if no point is finite.
std::vector<CloudPoint> pointsOf(const sensor_msgs::PointCloud2& cloud, const RigidTransform& T_map_frame);

/// Returns the pixels of a height image (32FC1, metres above the origin of the frame, NaN: not observed). The
/// centre of the image is at the origin, columns run along x, rows against y, and a pixel is pixel_m wide.
std::vector<CloudPoint> pointsOf(const sensor_msgs::Image& image, double pixel_m,
                                 const RigidTransform& T_map_frame);

/// Returns wheel telemetry from a cloud with one point per wheel: position (x, y, z), and fields named as
/// columns of a telemetry file (at least load_N and slip). Time, map position and, without a field
/// heading_rad, the heading come from the message and the transform.
Wheels wheelsOf(const sensor_msgs::PointCloud2& cloud, const RigidTransform& T_map_frame);

/// Returns a path in the map frame.
nav_msgs::Path pathOf(const std::vector<Pose>& poses, const std_msgs::Header& header);

}  // namespace rover_ros
