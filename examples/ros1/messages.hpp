#pragma once

#include <vector>

#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Path.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>

#include "navigator.hpp"

/// Conversion between ROS messages and the types of navigator.hpp. The functions throw std::runtime_error
/// with a text of one line for a malformed message.
namespace rover_ros {

/// Rigid transform from the coordinate frame of a message to the map frame.
class RigidTransform {
 public:
  /// `T_map_frame` is the transform of the message frame in the map frame.
  explicit RigidTransform(const geometry_msgs::Transform& T_map_frame);
  /// Returns the point `p_frame`, given in the message frame, in the map frame.
  CloudPoint operator()(const CloudPoint& p_frame) const;
  /// Returns the heading of the x axis of the message frame in the map plane, counter-clockwise from the x
  /// axis of the map.
  double heading_rad() const;

 private:
  double r_[3][3];
  CloudPoint t_;
};

/// Returns the finite points of a point cloud with the fields x, y and z, in the map frame. Throws if no
/// point is finite.
std::vector<CloudPoint> pointsOf(const sensor_msgs::PointCloud2& cloud, const RigidTransform& T_map_frame);

/// Returns the pixels of a height image as points in the map frame. The image has the encoding 32FC1: height
/// above the origin of the message frame [m], NaN if not observed. The centre of the image is at the origin
/// of the frame; columns run in the direction of x, rows against y. `pixel_m` is the side length of a pixel.
std::vector<CloudPoint> pointsOf(const sensor_msgs::Image& image, double pixel_m,
                                 const RigidTransform& T_map_frame);

/// Returns wheel telemetry from a point cloud with one point per wheel. The position of a point (x, y, z) is
/// that of the wheel. The other fields have the names of columns of a telemetry file; load_N and slip are
/// required. Time and map position come from the message and the transform, and so does the heading if the
/// cloud has no field heading_rad.
Wheels wheelsOf(const sensor_msgs::PointCloud2& cloud, const RigidTransform& T_map_frame);

/// Returns the poses as a path message in the map frame.
nav_msgs::Path pathOf(const std::vector<Pose>& poses, const std_msgs::Header& header);

}  // namespace rover_ros
