// Shows   conversion of ROS 1 messages to points and telemetry, and of routes to paths.
#include "messages.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>

namespace rover_ros {
namespace {

using sensor_msgs::PointField;

// Numeric access to one field of a point cloud, for any data type.
class Field {
 public:
  Field(const sensor_msgs::PointCloud2& cloud, const PointField& field) : cloud_(cloud), field_(field) {
    if (field.offset + size() > cloud.point_step)
      throw std::runtime_error("field '" + field.name + "' reaches beyond point_step");
  }
  double operator()(std::size_t point) const {
    const std::size_t row = point / cloud_.width, column = point % cloud_.width;
    const unsigned char* at =
        cloud_.data.data() + row * cloud_.row_step + column * cloud_.point_step + field_.offset;
    switch (field_.datatype) {
      case PointField::FLOAT32:
        return as<float>(at);
      case PointField::FLOAT64:
        return as<double>(at);
      case PointField::INT8:
        return as<std::int8_t>(at);
      case PointField::UINT8:
        return as<std::uint8_t>(at);
      case PointField::INT16:
        return as<std::int16_t>(at);
      case PointField::UINT16:
        return as<std::uint16_t>(at);
      case PointField::INT32:
        return as<std::int32_t>(at);
      default:
        return as<std::uint32_t>(at);
    }
  }

 private:
  template <typename T>
  static double as(const unsigned char* at) {
    T value;
    std::memcpy(&value, at, sizeof value);
    return static_cast<double>(value);
  }
  std::size_t size() const {
    switch (field_.datatype) {
      case PointField::INT8:
      case PointField::UINT8:
        return 1;
      case PointField::INT16:
      case PointField::UINT16:
        return 2;
      case PointField::INT32:
      case PointField::UINT32:
      case PointField::FLOAT32:
        return 4;
      case PointField::FLOAT64:
        return 8;
      default:
        throw std::runtime_error("field '" + field_.name + "' has the unknown type " +
                                 std::to_string(field_.datatype));
    }
  }
  const sensor_msgs::PointCloud2& cloud_;
  const PointField& field_;
};

std::size_t countOf(const sensor_msgs::PointCloud2& cloud) {
  if (cloud.is_bigendian) throw std::runtime_error("is big-endian; send little-endian");
  if (cloud.width == 0 || cloud.height == 0) throw std::runtime_error("is empty; send points");
  const std::size_t row = std::size_t{cloud.width} * cloud.point_step;
  if (cloud.point_step == 0 || cloud.row_step < row ||
      cloud.data.size() < std::size_t{cloud.height - 1} * cloud.row_step + row)
    throw std::runtime_error("holds " + std::to_string(cloud.data.size()) + " bytes, fewer than its " +
                             std::to_string(cloud.height) + " x " + std::to_string(cloud.width) +
                             " points take");
  return std::size_t{cloud.width} * cloud.height;
}

Field fieldOf(const sensor_msgs::PointCloud2& cloud, const char* name) {
  for (const PointField& field : cloud.fields)
    if (field.name == name) return Field(cloud, field);
  throw std::runtime_error("has no field '" + std::string(name) + "'");
}

bool has(const sensor_msgs::PointCloud2& cloud, const char* name) {
  return std::any_of(cloud.fields.begin(), cloud.fields.end(),
                     [&](const PointField& field) { return field.name == name; });
}

}  // namespace

RigidTransform::RigidTransform(const geometry_msgs::Transform& T_map_frame)
    : t_{T_map_frame.translation.x, T_map_frame.translation.y, T_map_frame.translation.z} {
  const auto& q = T_map_frame.rotation;
  const double n = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
  if (!(std::abs(n - 1.0) < 1e-3) || !std::isfinite(t_.x_m + t_.y_m + t_.z_m))
    throw std::runtime_error("its transform is not rigid");
  const double s = 2.0 / n;
  r_[0][0] = 1.0 - s * (q.y * q.y + q.z * q.z);
  r_[0][1] = s * (q.x * q.y - q.z * q.w);
  r_[0][2] = s * (q.x * q.z + q.y * q.w);
  r_[1][0] = s * (q.x * q.y + q.z * q.w);
  r_[1][1] = 1.0 - s * (q.x * q.x + q.z * q.z);
  r_[1][2] = s * (q.y * q.z - q.x * q.w);
  r_[2][0] = s * (q.x * q.z - q.y * q.w);
  r_[2][1] = s * (q.y * q.z + q.x * q.w);
  r_[2][2] = 1.0 - s * (q.x * q.x + q.y * q.y);
}

CloudPoint RigidTransform::operator()(const CloudPoint& p_frame) const {
  return {r_[0][0] * p_frame.x_m + r_[0][1] * p_frame.y_m + r_[0][2] * p_frame.z_m + t_.x_m,
          r_[1][0] * p_frame.x_m + r_[1][1] * p_frame.y_m + r_[1][2] * p_frame.z_m + t_.y_m,
          r_[2][0] * p_frame.x_m + r_[2][1] * p_frame.y_m + r_[2][2] * p_frame.z_m + t_.z_m};
}

double RigidTransform::heading_rad() const {
  return std::atan2(r_[1][0], r_[0][0]);
}

std::vector<CloudPoint> pointsOf(const sensor_msgs::PointCloud2& cloud, const RigidTransform& T_map_frame) {
  const std::size_t count = countOf(cloud);
  const Field x = fieldOf(cloud, "x"), y = fieldOf(cloud, "y"), z = fieldOf(cloud, "z");
  std::vector<CloudPoint> points;
  for (std::size_t i = 0; i < count; ++i) {
    const CloudPoint p{x(i), y(i), z(i)};
    if (std::isfinite(p.x_m) && std::isfinite(p.y_m) && std::isfinite(p.z_m))
      points.push_back(T_map_frame(p));
  }
  if (points.empty()) throw std::runtime_error("has no finite point");
  return points;
}

std::vector<CloudPoint> pointsOf(const sensor_msgs::Image& image, double pixel_m,
                                 const RigidTransform& T_map_frame) {
  if (image.encoding != "32FC1")
    throw std::runtime_error("has encoding '" + image.encoding + "', must be 32FC1");
  if (image.is_bigendian) throw std::runtime_error("is big-endian; send little-endian");
  const std::size_t row = std::size_t{image.width} * sizeof(float);
  if (row == 0 || image.height == 0) throw std::runtime_error("is empty; send pixels");
  if (image.step < row || image.data.size() < std::size_t{image.height - 1} * image.step + row)
    throw std::runtime_error("holds " + std::to_string(image.data.size()) + " bytes, fewer than its " +
                             std::to_string(image.height) + " x " + std::to_string(image.width) +
                             " pixels take");
  std::vector<CloudPoint> points;
  for (std::size_t r = 0; r < image.height; ++r)
    for (std::size_t c = 0; c < image.width; ++c) {
      float height_m = 0.0F;
      std::memcpy(&height_m, image.data.data() + r * image.step + c * sizeof(float), sizeof height_m);
      if (!std::isfinite(height_m)) continue;
      points.push_back(T_map_frame({(static_cast<double>(c) - 0.5 * (image.width - 1.0)) * pixel_m,
                                    (0.5 * (image.height - 1.0) - static_cast<double>(r)) * pixel_m,
                                    static_cast<double>(height_m)}));
    }
  if (points.empty()) throw std::runtime_error("has no finite pixel");
  return points;
}

Wheels wheelsOf(const sensor_msgs::PointCloud2& cloud, const RigidTransform& T_map_frame) {
  const std::size_t count = countOf(cloud);
  const Field x = fieldOf(cloud, "x"), y = fieldOf(cloud, "y"), z = fieldOf(cloud, "z");
  fieldOf(cloud, "load_N");
  fieldOf(cloud, "slip");
  Wheels wheels{{"time_s", "x_m", "y_m", "z_m"}, {}};
  std::vector<Field> others;
  for (const PointField& field : cloud.fields) {
    const std::vector<std::string> own{"x", "y", "z", "time_s", "x_m", "y_m", "z_m"};
    if (std::find(own.begin(), own.end(), field.name) != own.end()) continue;
    wheels.columns.push_back(field.name);
    others.emplace_back(cloud, field);
  }
  const bool heading = !has(cloud, "heading_rad");
  if (heading) wheels.columns.push_back("heading_rad");
  for (std::size_t i = 0; i < count; ++i) {
    const CloudPoint at = T_map_frame({x(i), y(i), z(i)});
    wheels.values.insert(wheels.values.end(), {cloud.header.stamp.toSec(), at.x_m, at.y_m, at.z_m});
    for (const Field& other : others) wheels.values.push_back(other(i));
    if (heading) wheels.values.push_back(T_map_frame.heading_rad());
  }
  return wheels;
}

nav_msgs::Path pathOf(const std::vector<Pose>& poses, const std_msgs::Header& header) {
  nav_msgs::Path path;
  path.header = header;
  for (const Pose& pose : poses) {
    geometry_msgs::PoseStamped stamped;
    stamped.header = header;
    stamped.pose.position.x = pose.x_m;
    stamped.pose.position.y = pose.y_m;
    stamped.pose.position.z = pose.z_m;
    stamped.pose.orientation.z = std::sin(0.5 * pose.heading_rad);
    stamped.pose.orientation.w = std::cos(0.5 * pose.heading_rad);
    path.poses.push_back(stamped);
  }
  return path;
}

}  // namespace rover_ros
