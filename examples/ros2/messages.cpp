#include "messages.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

namespace talus_ros2 {
namespace {

using talus::maps::Cell;
using talus::maps::Grid;
using talus::maps::Point;
using talus::maps::Raster;
using talus::planner::CellJudgement;

constexpr double kMostCells = 1 << 24;  // 64 MB of heights
constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

// Returns the height between the cells of a message, at a place in units of its cells; nullopt: not seen. Within a
// hundredth of a cell, the height is that of the cell.
std::optional<double> heightAt(const Raster<float>& z_m, double x, double y, double steepest_m) {
  const auto snapped = [](double at) { return std::abs(at - std::round(at)) < 0.01 ? std::round(at) : at; };
  const Point at{snapped(x), snapped(y)};
  float low = std::numeric_limits<float>::infinity(), high = -low;
  for (const double column : {std::floor(at.x_m), std::ceil(at.x_m)})
    for (const double row : {std::floor(at.y_m), std::ceil(at.y_m)}) {
      const Cell cell{static_cast<int>(column), static_cast<int>(row)};
      if (!z_m.grid().contains(cell)) continue;
      low = std::fmin(low, z_m[cell]);
      high = std::fmax(high, z_m[cell]);
    }
  const bool step = static_cast<double>(high - low) > steepest_m;
  return talus::maps::elevationAt(z_m, step ? Point{std::round(at.x_m), std::round(at.y_m)} : at);
}

// The ground of a message in the frame of the map.
struct Ground {
  const Heights& seen;
  Eigen::Isometry3d T_map_cells, T_cells_map;
  double middle_m;    // a height of the ground
  double steepest_m;  // greatest difference of the heights of four cells that is a slope and no step

  // Returns the height at a place; NaN: not seen. In a tilted message, the place in the message depends on the height.
  float at(Point place) const {
    double z = middle_m, before = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 8 && std::abs(z - before) > 1e-6; ++k) {
      const Eigen::Vector3d p = T_cells_map * Eigen::Vector3d(place.x_m, place.y_m, z);
      const auto height =
          heightAt(seen.z_m, p.x() / seen.resolution_m, p.y() / seen.resolution_m, steepest_m);
      if (!height) return kUnknown;
      before = z;
      z = (T_map_cells * Eigen::Vector3d(p.x(), p.y(), *height)).z();
    }
    return static_cast<float>(z);
  }
};

// Returns the cells of the map below the rectangle of the message; width or height is 0 or less if there are none.
Grid windowOf(const Ground& ground, const Grid& map) {
  Eigen::Array2d low = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  const Grid& cells = ground.seen.z_m.grid();
  const double level_m = (ground.T_cells_map * Eigen::Vector3d(0.0, 0.0, ground.middle_m)).z();
  for (const double x : {-0.5, cells.width - 0.5})
    for (const double y : {-0.5, cells.height - 0.5}) {
      const Eigen::Vector3d corner =
          ground.T_map_cells *
          Eigen::Vector3d(x * ground.seen.resolution_m, y * ground.seen.resolution_m, level_m);
      low = low.min(corner.head<2>().array());
      high = high.max(corner.head<2>().array());
    }
  const Eigen::Array2d origin(map.south_west.x_m, map.south_west.y_m), size(map.width, map.height);
  const Eigen::Array2d first = ((low - origin) / map.resolution_m + 1e-6).floor().max(0.0).min(size),
                       last = ((high - origin) / map.resolution_m - 1e-6).ceil().max(0.0).min(size);
  Grid window = map;
  window.width = static_cast<int>(last.x() - first.x());
  window.height = static_cast<int>(last.y() - first.y());
  window.south_west = {map.south_west.x_m + first.x() * map.resolution_m,
                       map.south_west.y_m + first.y() * map.resolution_m};
  return window;
}

std::vector<double>* columnOf(talus::Telemetry& table, const std::string& name) {
  for (auto& each : table.numbers)
    if (each.name == name) return &each.values;
  return nullptr;
}

// Transforms places and headings.
void transform(talus::Telemetry& table, const Eigen::Isometry3d& T) {
  auto *x = columnOf(table, "x_m"), *y = columnOf(table, "y_m"), *z = columnOf(table, "z_m"),
       *heading = columnOf(table, "heading_rad");
  for (std::size_t row = 0; row < table.size(); ++row) {
    if (x != nullptr && y != nullptr) {
      const Eigen::Vector3d p = T * Eigen::Vector3d((*x)[row], (*y)[row], z != nullptr ? (*z)[row] : 0.0);
      (*x)[row] = p.x();
      (*y)[row] = p.y();
      if (z != nullptr) (*z)[row] = p.z();
    }
    if (heading != nullptr) {
      const Eigen::Vector3d ahead =
          T.linear() * Eigen::Vector3d(std::cos((*heading)[row]), std::sin((*heading)[row]), 0.0);
      (*heading)[row] = std::atan2(ahead.y(), ahead.x());
    }
  }
}

}  // namespace

Heights heightsOf(const grid_map_msgs::msg::GridMap& message, const std::string& layer) {
  const auto& info = message.info;
  const double columns = std::round(info.length_x / info.resolution),
               rows = std::round(info.length_y / info.resolution);
  require(info.resolution > 0.0 && columns >= 1.0 && rows >= 1.0,
          "grid map: empty: " + std::to_string(info.length_x) + " m x " + std::to_string(info.length_y) +
              " m in cells of " + std::to_string(info.resolution) + " m");
  require(columns * rows <= kMostCells, "grid map: more than 16777216 cells; send a window of it");
  const auto found = std::find(message.layers.begin(), message.layers.end(), layer);
  require(found != message.layers.end(), "grid map: no layer '" + layer + "'");
  const auto at = static_cast<std::size_t>(found - message.layers.begin());
  require(at < message.data.size(), "grid map: layer '" + layer + "' has no data");
  const auto& [layout, data] = message.data[at];
  const auto width = static_cast<std::size_t>(columns), height = static_cast<std::size_t>(rows);
  require(layout.dim.size() == 2 && layout.dim[0].label == "column_index" && layout.dim[0].size == height &&
              layout.dim[1].size == width && data.size() >= layout.data_offset &&
              data.size() - layout.data_offset >= width * height,
          "grid map: layer '" + layer + "' is not " + std::to_string(width) + " x " + std::to_string(height) +
              " values in columns");
  Heights heights{.z_m = Raster<float>({.width = static_cast<int>(width),
                                        .height = static_cast<int>(height),
                                        .resolution_m = 1.0,
                                        .south_west = {-0.5, -0.5}}),
                  .resolution_m = info.resolution,
                  .T_frame_cells = isometryOf(info.pose.position, info.pose.orientation)};
  require(heights.T_frame_cells.matrix().allFinite(), "grid map: its pose is not finite");
  heights.T_frame_cells.translation().z() = 0.0;  // as in grid_map, heights are those of the frame
  heights.T_frame_cells.translate(
      Eigen::Vector3d(-0.5 * (columns - 1.0) * info.resolution, -0.5 * (rows - 1.0) * info.resolution, 0.0));
  // Index (0, 0) is the cell with the largest x and y, stored at the start index of a ring.
  for (std::size_t j = 0; j < height; ++j)
    for (std::size_t i = 0; i < width; ++i)
      heights.z_m[{static_cast<int>(width - 1 - i), static_cast<int>(height - 1 - j)}] =
          data[layout.data_offset + (j + message.inner_start_index) % height * width +
               (i + message.outer_start_index) % width];
  return heights;
}

std::optional<talus::costmap::SurfacePatch> patchOf(const Heights& seen, const Eigen::Isometry3d& T_map_frame,
                                                    const talus::costmap::TraversabilityMap& map) {
  const auto known = std::find_if(seen.z_m.values().begin(), seen.z_m.values().end(),
                                  [](float z) { return std::isfinite(z); });
  if (known == seen.z_m.values().end()) return std::nullopt;
  Ground ground{.seen = seen, .T_map_cells = T_map_frame * seen.T_frame_cells};
  require(ground.T_map_cells.linear()(2, 2) > std::cos(20.0 * talus::kDegree),
          "grid map: tilted by more than 20 degrees against the map");
  ground.T_cells_map = ground.T_map_cells.inverse();
  ground.middle_m = ground.T_map_cells.translation().z() + static_cast<double>(*known);
  ground.steepest_m = std::sqrt(2.0) * map.surface().limits().max_gradient * seen.resolution_m;
  const Grid window = windowOf(ground, map.grid());
  if (window.width < 1 || window.height < 1) return std::nullopt;
  talus::costmap::SurfacePatch patch;
  patch.elevation_m = Raster<float>(window, kUnknown);
  const int samples =
      std::max(1, static_cast<int>(std::ceil(window.resolution_m / seen.resolution_m - 0.01)));
  const double apart_m = window.resolution_m / samples;
  bool any = false;
  for (int row = 0; row < window.height; ++row)
    for (int column = 0; column < window.width; ++column) {
      float& highest = patch.elevation_m[{column, row}];
      const Point centre = window.centre({column, row});
      for (int k = 0; k < samples * samples; ++k)
        highest = std::fmax(highest, ground.at({centre.x_m + (k % samples - 0.5 * (samples - 1)) * apart_m,
                                                centre.y_m + (k / samples - 0.5 * (samples - 1)) * apart_m}));
      any = any || !std::isnan(highest);
    }
  if (!any) return std::nullopt;
  return patch;
}

talus::Telemetry wheelsOf(const sensor_msgs::msg::PointCloud2& message,
                          const Eigen::Isometry3d& T_map_frame) {
  using Field = sensor_msgs::msg::PointField;
  const std::size_t count = std::size_t{message.width} * message.height;
  require(count > 0 && !message.is_bigendian && message.row_step == message.point_step * message.width &&
              message.data.size() >= count * message.point_step,
          "wheels: not rows of " + std::to_string(message.point_step) + " bytes without gaps");
  talus::Telemetry table;
  table.source = "wheels";
  table.words = {{"wheel", {}}};
  for (std::size_t row = 0; row < count; ++row) {
    table.lines.push_back(row + 1);
    table.words[0].values.push_back(std::to_string(row));
  }
  for (const Field& field : message.fields) {
    const std::size_t size = field.datatype == Field::FLOAT64 ? sizeof(double) : sizeof(float);
    require((field.datatype == Field::FLOAT32 || field.datatype == Field::FLOAT64) && field.count == 1 &&
                field.offset + size <= message.point_step,
            "wheels: field '" + field.name + "' must be one FLOAT32 or FLOAT64 within the point");
    auto& values = table.numbers.emplace_back(talus::Telemetry::Numbers{field.name, {}}).values;
    for (std::size_t row = 0; row < count; ++row) {
      const unsigned char* at = message.data.data() + row * message.point_step + field.offset;
      float single = 0.0F;
      double value = 0.0;
      std::memcpy(field.datatype == Field::FLOAT64 ? static_cast<void*>(&value) : &single, at, size);
      values.push_back(field.datatype == Field::FLOAT64 ? value : static_cast<double>(single));
    }
  }
  if (const auto* wheel = columnOf(table, "wheel")) {
    for (std::size_t row = 0; row < count; ++row)
      table.words[0].values[row] = std::to_string(std::lround((*wheel)[row]));
    std::erase_if(table.numbers, [](const auto& each) { return each.name == "wheel"; });
  }
  if (columnOf(table, "time_s") == nullptr)
    table.numbers.push_back({"time_s", std::vector<double>(count, message.header.stamp.sec +
                                                                      1e-9 * message.header.stamp.nanosec)});
  transform(table, T_map_frame);
  return table;
}

std::vector<talus::maps::CellBox> JudgedCells::show(Version version) {
  constexpr int kSide = talus::costmap::CostTile::kSide;
  const Version before = std::exchange(version_, std::move(version));
  const Grid& grid = version_->grid();
  if (!before || before->content().cost != version_->content().cost || before->grid() != grid) {
    judge_.emplace(version_->content().cost);
    cells_.assign(grid.size(), {});
    return {{{0, 0}, {grid.width - 1, grid.height - 1}}};
  }
  // Unchanged tiles are shared between versions.
  std::vector<talus::maps::CellBox> changed;
  for (std::size_t i = 0; i < version_->content().tiles.size(); ++i) {
    if (version_->content().tiles[i] == before->content().tiles[i]) continue;
    const int column = static_cast<int>(i) % version_->tileColumns() * kSide,
              row = static_cast<int>(i) / version_->tileColumns() * kSide;
    changed.push_back({{column, row}, {column + kSide - 1, row + kSide - 1}});
  }
  return changed;
}

CellJudgement JudgedCells::at(Cell cell) {
  Judged& known = cells_[version_->grid().index(cell)];
  const talus::costmap::CellCode code = version_->at(cell);
  if (known.code != code) known = {code, judge_->of(code)};
  return known.judgement;
}

grid_map_msgs::msg::GridMap gridMapOf(const talus::costmap::TraversabilityMap& map, JudgedCells& cells,
                                      const std_msgs::msg::Header& header) {
  const Grid& grid = map.grid();
  grid_map_msgs::msg::GridMap message;
  message.header = header;
  message.info.resolution = grid.resolution_m;
  message.info.length_x = grid.width * grid.resolution_m;
  message.info.length_y = grid.height * grid.resolution_m;
  message.info.pose.position.x = grid.south_west.x_m + 0.5 * message.info.length_x;
  message.info.pose.position.y = grid.south_west.y_m + 0.5 * message.info.length_y;
  message.info.pose.orientation.w = 1.0;
  message.layers = {"elevation", "category", "cost", "drawbar_pull"};
  message.basic_layers = {"elevation"};
  message.data.resize(message.layers.size());
  const auto width = static_cast<std::uint32_t>(grid.width), height = static_cast<std::uint32_t>(grid.height);
  for (auto& layer : message.data) {
    layer.layout.dim.resize(2);
    layer.layout.dim[0].label = "column_index";
    layer.layout.dim[0].size = height;
    layer.layout.dim[0].stride = width * height;
    layer.layout.dim[1].label = "row_index";
    layer.layout.dim[1].size = layer.layout.dim[1].stride = width;
    layer.data.reserve(grid.size());
  }
  for (int row = grid.height - 1; row >= 0; --row)
    for (int column = grid.width - 1; column >= 0; --column) {
      const talus::costmap::CellBelief belief = map.belief({column, row});
      const CellJudgement judged = cells.at({column, row});
      message.data[0].data.push_back(map.elevation().elevation_m[{column, row}]);
      message.data[1].data.push_back(belief.category > 2 ? kUnknown : static_cast<float>(belief.category));
      message.data[2].data.push_back(judged.kind == CellJudgement::Kind::Unknown ? kUnknown
                                                                                 : judged.highest_J_per_m);
      message.data[3].data.push_back(belief.pull_mean);
    }
  return message;
}

nav_msgs::msg::Path pathOf(const talus::planner::Route& route, const std_msgs::msg::Header& header,
                           double spacing_m) {
  nav_msgs::msg::Path path;
  path.header = header;
  geometry_msgs::msg::PoseStamped stamped;
  stamped.header = header;
  auto& pose = stamped.pose;
  for (std::size_t i = 0; i < route.vertices.size(); ++i) {
    const talus::RouteVertex& from = route.vertices[i];
    const talus::RouteVertex& to = i + 1 < route.vertices.size() ? route.vertices[i + 1] : from;
    if (std::isfinite(from.elevation_m)) pose.position.z = from.elevation_m;
    pose.orientation.z = std::sin(0.5 * from.heading_rad);
    pose.orientation.w = std::cos(0.5 * from.heading_rad);
    const double length_m = std::hypot(to.x_m - from.x_m, to.y_m - from.y_m);
    const int pieces = std::max(1, static_cast<int>(std::ceil(length_m / spacing_m)));
    for (int k = 0; k < pieces; ++k) {
      pose.position.x = from.x_m + k * (to.x_m - from.x_m) / pieces;
      pose.position.y = from.y_m + k * (to.y_m - from.y_m) / pieces;
      path.poses.push_back(stamped);
    }
  }
  return path;
}

}  // namespace talus_ros2
