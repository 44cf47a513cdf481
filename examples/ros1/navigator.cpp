// Shows   Talus behind a C++17 header, with a state that survives a restart of the process.
// Needs   talus::planner, talus::terramech_io. Used by talus_node.cpp.
#include "navigator.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <stop_token>
#include <utility>

#include <talus/maps/maps.hpp>
#include <talus/planner/planner.hpp>
#include <talus/terramech/terramech_io.hpp>

namespace rover_ros {
namespace {

namespace fs = std::filesystem;
using talus::costmap::TraversabilityMap;
using talus::planner::RouteStatus;

talus::maps::Grid gridOf(const Settings& s) {
  if (s.width < 1 || s.height < 1 || s.width > 65536 || s.height > 65536)
    throw std::runtime_error("width and height must be 1 to 65536 cells");
  if (!(s.resolution_m > 0.0) || !std::isfinite(s.resolution_m))
    throw std::runtime_error("resolution_m must be > 0");
  if (!std::isfinite(s.south_west.x_m) || !std::isfinite(s.south_west.y_m))
    throw std::runtime_error("origin_x_m and origin_y_m must be finite");
  return {.width = s.width,
          .height = s.height,
          .resolution_m = s.resolution_m,
          .south_west = {s.south_west.x_m, s.south_west.y_m}};
}

std::shared_ptr<const talus::costmap::GroundModel> modelOf(const Settings& s) {
  const talus::terramech::Rover rover = talus::terramech::loadRover(s.rover);
  return std::make_shared<const talus::costmap::GroundModel>(talus::costmap::GroundModel::Parts{
      .rover = rover,
      .classes = {talus::costmap::groundClass(0, talus::terramech::loadSoilPrior(s.soil), rover)},
      .policy = {.allow_unknown = s.allow_unknown}});
}

std::string inFolder(const Settings& s, const char* name) {
  return s.state_folder.empty() ? std::string() : (fs::path(s.state_folder) / name).string();
}

// Returns the heights stored in the state folder. Without such a file every cell is unobserved.
talus::costmap::MapLayers keptHeights(const Settings& s, std::string& restored) {
  const talus::maps::Grid grid = gridOf(s);
  talus::costmap::MapLayers layers;
  layers.elevation.elevation_m = talus::maps::Raster<float>(grid, std::numeric_limits<float>::quiet_NaN());
  const std::string file = inFolder(s, "heights.ot");
  if (file.empty() || !fs::exists(file)) return layers;
  const TraversabilityMap kept = talus::costmap::readMap(file);
  if (!(kept.grid() == grid))
    throw std::runtime_error(file +
                             ": holds a map of another grid; remove it, or set width, height, resolution_m, "
                             "origin_x_m and origin_y_m as it was");
  layers.elevation = kept.elevation();
  const auto& heights = layers.elevation.elevation_m.values();
  const auto seen = std::count_if(heights.begin(), heights.end(), [](float h) { return !std::isnan(h); });
  restored = std::to_string(seen) + " cells of heights";
  return layers;
}

// Returns the window of the map that contains the points; empty if no point is on the map.
std::optional<talus::maps::Grid> windowOf(const std::vector<talus::maps::CloudPoint>& points,
                                          const talus::maps::Grid& map) {
  talus::maps::CellBox box{{map.width, map.height}, {-1, -1}};
  for (const auto& point : points)
    if (const auto cell = map.cellAt({point.x_m, point.y_m}); cell && std::isfinite(point.z_m)) {
      box.first = {std::min(box.first.column, cell->column), std::min(box.first.row, cell->row)};
      box.last = {std::max(box.last.column, cell->column), std::max(box.last.row, cell->row)};
    }
  if (box.last.column < 0) return std::nullopt;
  return talus::maps::Grid{.width = box.width(),
                           .height = box.height(),
                           .resolution_m = map.resolution_m,
                           .south_west = {map.south_west.x_m + box.first.column * map.resolution_m,
                                          map.south_west.y_m + box.first.row * map.resolution_m}};
}

// Rows with missing or impossible numbers are kept, because they may indicate danger.
talus::terramech::Telemetry telemetryOf(const Wheels& wheels) {
  const std::size_t width = wheels.columns.size();
  if (width == 0 || wheels.values.empty() || wheels.values.size() % width != 0)
    throw std::runtime_error("no wheel in it; give one row a wheel");
  talus::terramech::Telemetry t;
  t.source = "wheels";
  t.words = {{"wheel", {}}};
  for (const std::string& name : wheels.columns) t.numbers.push_back({name, {}});
  for (std::size_t row = 0; row < wheels.values.size() / width; ++row) {
    for (std::size_t k = 0; k < width; ++k) t.numbers[k].values.push_back(wheels.values[row * width + k]);
    t.words[0].values.push_back(std::to_string(row));
    t.lines.push_back(row + 1);
  }
  return t;
}

// Returns the poses along a route: its vertices, and intermediate poses at most spacing_m apart. At
// unobserved ground the height is that of the previous pose.
std::vector<Pose> posesOf(const std::vector<talus::planner::RouteVertex>& route, double spacing_m) {
  std::vector<Pose> poses;
  double z_m = 0.0;
  for (const auto& v : route)
    if (std::isfinite(v.elevation_m)) {
      z_m = v.elevation_m;
      break;
    }
  for (std::size_t i = 0; i < route.size(); ++i) {
    const auto& v = route[i];
    const double before_m = z_m;
    if (std::isfinite(v.elevation_m)) z_m = v.elevation_m;
    if (i > 0) {
      const auto& from = route[i - 1];
      const double leg_m = std::hypot(v.x_m - from.x_m, v.y_m - from.y_m);
      const int pieces = static_cast<int>(std::ceil(leg_m / spacing_m));
      for (int k = 1; k < pieces; ++k) {
        const double t = static_cast<double>(k) / pieces;
        poses.push_back({from.x_m + t * (v.x_m - from.x_m), from.y_m + t * (v.y_m - from.y_m),
                         before_m + t * (z_m - before_m), from.heading_rad});
      }
    }
    poses.push_back({v.x_m, v.y_m, z_m, v.heading_rad});
  }
  return poses;
}

}  // namespace

struct Navigator::State {
  explicit State(const Settings& given)
      : settings(given),
        map(keptHeights(settings, restored), modelOf(settings), {}),
        planner(talus::planner::makePlanner(settings.planner)) {}

  Settings settings;
  std::string restored;
  TraversabilityMap map;
  std::optional<talus::costmap::EvidenceJournal> journal;
  std::optional<talus::costmap::DriveIntake> intake;
  std::unique_ptr<talus::GlobalPlanner> planner;
  bool changed = false;      // heights changed since the last save
  mutable std::mutex mutex;  // guards the members below
  std::stop_source stop;
  std::optional<Place> goal;
};

// Converts all exceptions to std::runtime_error; the texts of Talus are one line already.
Navigator::Navigator(const Settings& settings) {
  if (!(settings.path_spacing_m > 0.0)) throw std::runtime_error("path_spacing_m must be > 0");
  if (!(settings.tolerance_m >= 0.0)) throw std::runtime_error("tolerance_m must be >= 0");
  if (settings.least_points < 1) throw std::runtime_error("least_points must be >= 1");
  if (!(settings.percentile > 0.0 && settings.percentile <= 1.0))
    throw std::runtime_error("percentile must be above 0 and at most 1");
  try {
    if (!settings.state_folder.empty()) fs::create_directories(settings.state_folder);
    state_ = std::make_unique<State>(settings);
    State& s = *state_;
    if (!settings.state_folder.empty()) {
      s.journal.emplace(inFolder(settings, "evidence.db"));
      if (const auto report = talus::costmap::replay(s.map, *s.journal); report.used > 0)
        s.restored += (s.restored.empty() ? "" : ", ") + std::to_string(report.used) + " rows of telemetry";
      if (std::ifstream in(inFolder(settings, "goal.txt")); in) {
        Place place;
        if (in >> place.x_m >> place.y_m) s.goal = place;
      }
    }
    s.intake.emplace(s.map, s.journal ? &*s.journal : nullptr,
                     talus::costmap::IntakeOptions{.pose_std_m = settings.pose_std_m});
    s.planner->configure({.planner = settings.planner, .time_limit_s = settings.time_limit_s});
    s.planner->set_map(s.map.published());
  } catch (const std::exception& error) {
    throw std::runtime_error(error.what());
  }
}

Navigator::~Navigator() = default;

std::size_t Navigator::see(const std::vector<CloudPoint>& points) {
  std::vector<talus::maps::CloudPoint> cloud;
  for (const CloudPoint& p : points) cloud.push_back({p.x_m, p.y_m, p.z_m});
  const auto window = windowOf(cloud, state_->map.grid());
  if (!window) throw std::runtime_error("no point on the map");
  talus::costmap::SurfacePatch patch;
  patch.elevation_m =
      talus::maps::heightsOf(cloud, *window,
                             {.percentile = state_->settings.percentile,
                              .least_points = static_cast<std::size_t>(state_->settings.least_points)});
  state_->map.patch(patch);
  state_->changed = true;
  return static_cast<std::size_t>(std::count_if(cloud.begin(), cloud.end(), [&](const auto& p) {
    return state_->map.grid().cellAt({p.x_m, p.y_m}).has_value();
  }));
}

std::size_t Navigator::learn(const Wheels& wheels) {
  const auto telemetry = telemetryOf(wheels);
  const std::size_t before = state_->intake->report().used;
  state_->intake->add(telemetry);
  state_->map.publish();
  return state_->intake->report().used - before;
}

void Navigator::save() {
  if (!state_->changed || state_->settings.state_folder.empty()) return;
  talus::costmap::writeMap(state_->map, inFolder(state_->settings, "heights.ot"));
  state_->changed = false;
}

void Navigator::setGoal(const std::optional<Place>& goal) {
  const std::lock_guard lock(state_->mutex);
  state_->goal = goal;
  const std::string file = inFolder(state_->settings, "goal.txt");
  if (file.empty()) return;
  if (!goal) {
    fs::remove(file);
    return;
  }
  std::ofstream out(file + ".new");
  out.precision(17);
  out << goal->x_m << ' ' << goal->y_m << '\n';
  out.close();
  if (!out) throw std::runtime_error(file + ": cannot be written; free some space");
  fs::rename(file + ".new", file);
}

std::optional<Place> Navigator::goal() const {
  const std::lock_guard lock(state_->mutex);
  return state_->goal;
}

Outcome Navigator::plan(const Place& start, const Place& goal) {
  talus::PlanRequest request;
  request.start = {start.x_m, start.y_m};
  request.goal = {goal.x_m, goal.y_m};
  request.tolerance_m = state_->settings.tolerance_m;
  {
    const std::lock_guard lock(state_->mutex);
    state_->stop = std::stop_source();
    request.watch.stop = state_->stop.get_token();
  }
  state_->planner->update(state_->map.published());
  const talus::planner::Route route = state_->planner->plan(request);
  Outcome outcome;
  outcome.found = route.status == RouteStatus::Found;
  outcome.cancelled = route.status == RouteStatus::Cancelled || route.interrupted;
  outcome.status = name(route.status);
  outcome.reason = route.reason;
  if (!outcome.found) return outcome;
  outcome.path = posesOf(route.vertices, state_->settings.path_spacing_m);
  outcome.length_m = route.summary.length_m;
  outcome.energy_J = route.summary.energy_J;
  outcome.risk = route.vertices.back().immobilisation_risk;
  return outcome;
}

void Navigator::cancel() {
  const std::lock_guard lock(state_->mutex);
  state_->stop.request_stop();
}

unsigned long Navigator::version() const {
  return state_->map.published()->version();
}

std::vector<signed char> Navigator::occupancy() const {
  const talus::maps::Raster<float>& heights = state_->map.elevation().elevation_m;
  const talus::maps::Grid& grid = heights.grid();
  std::vector<signed char> cells;
  cells.reserve(grid.size());
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column) {
      const int category = state_->map.costs().category({column, row});
      const bool unknown = category == 3 || std::isnan(heights[{column, row}]);
      cells.push_back(static_cast<signed char>(category == 2 ? 100 : unknown ? -1 : 50 * category));
    }
  return cells;
}

const std::string& Navigator::restored() const {
  return state_->restored;
}

std::string nearestName(const std::string& word, const std::vector<std::string>& known) {
  return talus::nearestName(word, known);
}

}  // namespace rover_ros
