#pragma once

#include <vector>

#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Path.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>

#include "navigator.hpp"

/// Between messages of ROS and what the navigator takes. What is malformed throws std::runtime_error, in one line.
namespace rover_ros {

/// A rigid motion from the frame of a message into the map's.
class Motion {
 public:
  explicit Motion(const geometry_msgs::Transform& transform);
  CloudPoint operator()(const CloudPoint& p) const;
  /// Of the frame's x axis, in the map plane, counter-clockwise from the map's x.
  double heading_rad() const;

 private:
  double r_[3][3];
  CloudPoint t_;
};

/// The finite points of a cloud, fields x, y and z.
std::vector<CloudPoint> pointsOf(const sensor_msgs::PointCloud2& cloud, const Motion& motion);

/// The pixels of a height image (32FC1, metres above the frame's origin, NaN: not observed): the middle of the image lies at
/// the origin, its columns run along x, its rows against y, a pixel is pixel_m wide.
std::vector<CloudPoint> pointsOf(const sensor_msgs::Image& image, double pixel_m, const Motion& motion);

/// Telemetry of wheels, a point a wheel: where it stands (x, y, z), and fields named as columns of a telemetry file (load_N
/// and slip at least). The time, the place on the map and, where it is no field, the heading come from message and motion.
Wheels wheelsOf(const sensor_msgs::PointCloud2& cloud, const Motion& motion);

/// A path in the map's frame.
nav_msgs::Path pathOf(const std::vector<Pose>& poses, const std_msgs::Header& header);

}  // namespace rover_ros
