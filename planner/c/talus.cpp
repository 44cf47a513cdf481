#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <talus.h>

#include <talus/costmap/ground/ground_model.hpp>
#include <talus/costmap/map/ground_curves.hpp>
#include <talus/planner/c/border.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>

namespace {

using namespace talus::border;

// Limits that also apply to values read from files.
constexpr double kFarthest_m = 1e9, kFinest_m = 1e-3, kCoarsest_m = 1e6;
constexpr std::int64_t kMostCells = 400'000'000;

std::string shown(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

void requirePlace(double metres, const std::string& name) {
  require(std::abs(metres) <= kFarthest_m, name + " = " + shown(metres) + ", must be -1e9 to 1e9");
}

talus::maps::Grid gridOf(const talus_grid* given) {
  const talus_grid& grid = read(given, "grid");
  require(grid.width > 0 && grid.height > 0, "grid: width and height must be > 0");
  require(grid.width <= kMostCells / grid.height,
          "grid: " + std::to_string(grid.width) + " x " + std::to_string(grid.height) +
              " cells, must be at most " + std::to_string(kMostCells));
  require(grid.resolution_m >= kFinest_m && grid.resolution_m <= kCoarsest_m,
          "grid: resolution_m = " + shown(grid.resolution_m) + ", must be 0.001 to 1e6");
  requirePlace(grid.x_m, "grid: x_m");
  requirePlace(grid.y_m, "grid: y_m");
  return {.width = grid.width,
          .height = grid.height,
          .resolution_m = grid.resolution_m,
          .south_west = {grid.x_m, grid.y_m}};
}

template <typename T>
talus::maps::Raster<T> rasterOf(const T* values, const talus::maps::Grid& grid) {
  if (values == nullptr) return {};
  return talus::maps::Raster<T>(grid, std::vector<T>(values, values + grid.size()));
}

const talus_layers& layersOf(const talus_layers* given, const talus::maps::Grid& grid) {
  const talus_layers& layers = read(given, "layers");
  require(layers.cells == grid.size(), "layers.cells = " + std::to_string(layers.cells) +
                                           ", must be width * height = " + std::to_string(grid.size()));
  return layers;
}

talus::terramech::Rover roverOf(const talus_rover* given) {
  const talus_rover& r = read(given, "rover");
  talus::terramech::Rover rover;
  rover.name = "rover";
  rover.mass_kg = r.mass_kg;
  rover.gravity_m_s2 = r.gravity_m_s2;
  rover.wheel_count = r.wheel_count;
  rover.wheel.radius_m = r.wheel_radius_m;
  rover.wheel.width_m = r.wheel_width_m;
  rover.wheelbase_m = r.wheelbase_m;
  rover.track_m = r.track_m;
  rover.clearance_m = r.clearance_m;
  rover.centre_of_mass_height_m = r.centre_of_mass_height_m;
  rover.max_pitch_rad = r.max_pitch_rad;
  rover.max_roll_rad = r.max_roll_rad;
  rover.max_torque_Nm = r.max_torque_Nm;
  rover.max_speed_mps = r.max_speed_mps;
  rover.hotel_power_W = r.hotel_power_W;
  return rover;
}

talus::costmap::GroundClass classOf(const talus_soil& given, const talus::terramech::Rover& rover) {
  const talus_soil& s = read(&given, "soil");
  require(s.class_number >= 0 && s.class_number < 255,
          "soil: class_number = " + std::to_string(s.class_number) + ", must be 0 to 254");
  const talus::terramech::Soil soil{.name = "soil of class " + std::to_string(s.class_number),
                                    .cohesion_Pa = s.cohesion_Pa,
                                    .friction_angle_rad = s.friction_angle_rad,
                                    .sinkage_exponent = s.sinkage_exponent,
                                    .cohesive_modulus = s.cohesive_modulus,
                                    .frictional_modulus = s.frictional_modulus,
                                    .shear_modulus_m = s.shear_modulus_m,
                                    .slip_sinkage_exponent = s.slip_sinkage_exponent,
                                    .test_gravity_m_s2 = s.test_gravity_m_s2};
  return talus::costmap::groundClass(s.class_number, {.mean = soil, .deviation = {}}, rover);
}

talus::PlannerSettings settingsOf(const talus_options& options) {
  require(options.threads >= 1, "options: threads = " + std::to_string(options.threads) + ", must be >= 1");
  require(options.time_limit_s >= 0.0, "options: time_limit_s must be >= 0");
  talus::PlannerSettings settings{.planner = options.planner == nullptr ? "" : options.planner,
                                  .seed = options.seed,
                                  .threads = options.threads};
  if (options.time_limit_s > 0.0) settings.time_limit_s = options.time_limit_s;
  return settings;
}

// A missing or impossible value does not remove the row: the other values of the moment are still checked for
// danger.
talus::terramech::Telemetry telemetryOf(const talus_wheel* rows, std::size_t count) {
  talus::terramech::Telemetry t;
  t.source = "talus_learn";
  t.words = {{"wheel", {}}};
  const std::pair<const char*, double talus_wheel::*> columns[] = {{"time_s", &talus_wheel::time_s},
                                                                   {"x_m", &talus_wheel::x_m},
                                                                   {"y_m", &talus_wheel::y_m},
                                                                   {"load_N", &talus_wheel::load_N},
                                                                   {"slip", &talus_wheel::slip},
                                                                   {"torque_Nm", &talus_wheel::torque_Nm},
                                                                   {"sinkage_m", &talus_wheel::sinkage_m},
                                                                   {"slope_rad", &talus_wheel::slope_rad},
                                                                   {"heading_rad", &talus_wheel::heading_rad},
                                                                   {"pose_std_m", &talus_wheel::pose_std_m}};
  for (const auto& [name, field] : columns) t.numbers.push_back({name, {}});
  for (std::size_t i = 0; i < count; ++i) {
    const talus_wheel& row = read(&rows[i], "row");
    for (std::size_t k = 0; k < t.numbers.size(); ++k)
      t.numbers[k].values.push_back(row.*(columns[k].second));
    t.words[0].values.push_back(std::to_string(row.wheel));
    t.lines.push_back(i + 1);
  }
  return t;
}

// Unknown cells of a layer have the highest finite cost of the layer.
talus::costmap::CostLayer costOf(const talus_cost_layer& given, const talus::maps::Grid& grid) {
  const talus_cost_layer& layer = read(&given, "cost layer");
  requirePointer(layer.name, "cost layer: name");
  requirePointer(layer.added_J_per_m, "cost layer: added_J_per_m");
  talus::costmap::CostLayer cost{.name = layer.name, .added_J_per_m = rasterOf(layer.added_J_per_m, grid)};
  for (const float added : cost.added_J_per_m.values())
    if (std::isfinite(added)) cost.unseen_J_per_m = std::max(cost.unseen_J_per_m, added);
  return cost;
}

talus_code codeOf(talus::planner::RouteStatus status) noexcept {
  using talus::planner::RouteStatus;
  if (status == RouteStatus::Found) return TALUS_OK;
  if (status == RouteStatus::Cancelled) return TALUS_CANCELLED;
  return status == RouteStatus::StartInvalid || status == RouteStatus::GoalInvalid ? TALUS_BAD_INPUT
                                                                                   : TALUS_NO_ROUTE;
}

}  // namespace

talus_code talus_create(const talus_rover* rover, const talus_soil* soils, size_t soil_count,
                        const talus_grid* grid, const talus_layers* layers, const talus_options* options,
                        talus_session* session, talus_error* error) {
  return talus_create_with_costs(rover, soils, soil_count, grid, layers, nullptr, 0, options, session, error);
}

talus_code talus_create_with_costs(const talus_rover* rover, const talus_soil* soils, size_t soil_count,
                                   const talus_grid* grid, const talus_layers* layers,
                                   const talus_cost_layer* costs, size_t cost_count,
                                   const talus_options* options, talus_session* session, talus_error* error) {
  return guarded(error, [&] {
    requirePointer(session, "session");
    requirePointer(soils, "soils");
    require(soil_count > 0 && soil_count < 255,
            "soil_count = " + std::to_string(soil_count) + ", must be 1 to 254");
    const talus_options& how = read(options, "options");
    const talus::PlannerSettings settings = settingsOf(how);
    talus::costmap::GroundModel::Parts parts{.rover = roverOf(rover), .classes = {}, .policy = {}};
    for (std::size_t i = 0; i < soil_count; ++i) parts.classes.push_back(classOf(soils[i], parts.rover));
    parts.policy.allow_unknown = how.allow_unknown != 0;
    const talus::maps::Grid cells = gridOf(grid);
    const talus_layers& given = layersOf(layers, cells);
    requirePointer(given.elevation_m, "layers.elevation_m");
    talus::Planner planner(settings);
    talus::Site site{.layers = {},
                     .ground = talus::costmap::GroundModel(std::move(parts)),
                     .options = {.threads = how.threads}};
    talus::costmap::MapLayers& built = site.layers;
    built.elevation.elevation_m = rasterOf(given.elevation_m, cells);
    built.classes = rasterOf(given.classes, cells);
    built.rock_abundance = rasterOf(given.rock_abundance, cells);
    built.keep_out = rasterOf(given.keep_out, cells);
    if (cost_count > 0) requirePointer(costs, "costs");
    require(cost_count <= talus::costmap::CostLayer::kMostLayers,
            "cost_count = " + std::to_string(cost_count) +
                ", must be <= " + std::to_string(talus::costmap::CostLayer::kMostLayers));
    for (std::size_t i = 0; i < cost_count; ++i) built.costs.push_back(costOf(costs[i], cells));
    *session = sessions().add(std::make_shared<Session>(talus::Map(std::move(site)), std::move(planner)));
    return TALUS_OK;
  });
}

talus_code talus_open(const char* path, const talus_options* options, talus_session* session,
                      talus_error* error) {
  return guarded(error, [&] {
    requirePointer(path, "path");
    requirePointer(session, "session");
    const talus_options& how = read(options, "options");
    require(how.allow_unknown == 0, "options: allow_unknown is the map file's own here; set it to 0");
    talus::Planner planner(settingsOf(how));
    *session =
        sessions().add(std::make_shared<Session>(talus::Map::read(path, how.threads), std::move(planner)));
    return TALUS_OK;
  });
}

talus_code talus_save(talus_session session, const char* path, talus_error* error) {
  return guarded(error, [&] {
    const Held held(session);
    requirePointer(path, "path");
    held->map.save(path);
    return TALUS_OK;
  });
}

talus_code talus_patch(talus_session session, const talus_grid* grid, const talus_layers* layers,
                       talus_error* error) {
  return guarded(error, [&] {
    const Held held(session);
    const talus::maps::Grid cells = gridOf(grid);
    const talus_layers& given = layersOf(layers, cells);
    const talus::maps::Grid& map = held->map.ground().grid();
    require(cells.width <= map.width && cells.height <= map.height,
            "a patch of " + std::to_string(cells.width) + " x " + std::to_string(cells.height) +
                " cells reaches off the map of " + std::to_string(map.width) + " x " +
                std::to_string(map.height) + "; cut it to the map");
    held->map.patch({.elevation_m = rasterOf(given.elevation_m, cells),
                     .rock_abundance = rasterOf(given.rock_abundance, cells),
                     .classes = rasterOf(given.classes, cells),
                     .keep_out = rasterOf(given.keep_out, cells)});
    return TALUS_OK;
  });
}

talus_code talus_move(talus_session session, int east_tiles, int north_tiles, talus_error* error) {
  return guarded(error, [&] {
    const Held held(session);
    held->map.move({east_tiles, north_tiles});
    held->route = {};
    return TALUS_OK;
  });
}

talus_code talus_read_grid(talus_session session, talus_grid* grid, talus_error* error) {
  return guarded(error, [&] {
    const Held held(session);
    read(grid, "grid");
    const talus::maps::Grid& cells = held->map.ground().grid();
    *grid = {sizeof *grid,       cells.width,          cells.height,
             cells.resolution_m, cells.south_west.x_m, cells.south_west.y_m};
    return TALUS_OK;
  });
}

talus_code talus_learn(talus_session session, const talus_wheel* rows, size_t count, size_t* used,
                       talus_error* error) {
  return guarded(error, [&] {
    const Held held(session);
    requirePointer(rows, "rows");
    require(count > 0, "count = 0, must be > 0");
    const talus::terramech::Telemetry telemetry = telemetryOf(rows, count);
    const std::size_t more = held->map.learnPart(telemetry);
    if (used != nullptr) *used = more;
    return TALUS_OK;
  });
}

talus_code talus_settle(talus_session session, talus_error* error) {
  return guarded(error, [&] {
    const Held held(session);
    held->map.settle();
    return TALUS_OK;
  });
}

talus_code talus_plan(talus_session session, const talus_request* request, talus_summary* summary,
                      talus_error* error) {
  return guarded(error, [&] {
    const Held held(session);
    const talus_request& asked = read(request, "request");
    if (summary != nullptr) read(summary, "summary");
    requirePlace(asked.start_x_m, "request: start_x_m");
    requirePlace(asked.start_y_m, "request: start_y_m");
    requirePlace(asked.goal_x_m, "request: goal_x_m");
    requirePlace(asked.goal_y_m, "request: goal_y_m");
    talus::PlanRequest wanted{.start = {asked.start_x_m, asked.start_y_m},
                              .goal = {asked.goal_x_m, asked.goal_y_m},
                              .tolerance_m = asked.tolerance_m};
    wanted.watch.stop = held->begin();
    held->route = {};
    held->route = held->planner.plan(held->map, wanted);
    const talus::Route& route = held->route;
    if (summary != nullptr) {
      *summary = talus_summary{};
      summary->size = sizeof *summary;
      summary->vertices = route.vertices.size();
      summary->cost_J = route.cost;
      summary->lower_bound_J = route.lower_bound;
      summary->energy_J = route.energy_J;
      summary->time_s = route.time_s;
      summary->energy_p90_J = route.energy_p90_J;
      summary->time_p90_s = route.time_p90_s;
      summary->length_m = route.length_m;
      summary->max_slip = route.max_slip;
      summary->max_slope_rad = route.max_slope_rad;
      if (!route.vertices.empty()) summary->immobilisation_risk = route.vertices.back().immobilisation_risk;
    }
    setError(error, route.reason);
    return codeOf(route.status);
  });
}

talus_code talus_cancel(talus_session session, talus_error* error) {
  return guarded(error, [&] {
    open(session)->cancel();
    return TALUS_OK;
  });
}

talus_code talus_read_route(talus_session session, size_t first, talus_vertex* buffer, size_t capacity,
                            size_t* written, talus_error* error) {
  return guarded(error, [&] {
    const Held held(session);
    requirePointer(buffer, "buffer");
    requirePointer(written, "written");
    const auto& vertices = held->route.vertices;
    *written = first < vertices.size() ? std::min(capacity, vertices.size() - first) : 0;
    for (std::size_t i = 0; i < *written; ++i) {
      const talus::planner::RouteVertex& v = vertices[first + i];
      buffer[i] = {v.x_m,       v.y_m,      v.heading_rad, v.slope_along_rad,     v.slip,       v.sinkage_m,
                   v.torque_Nm, v.energy_J, v.time_s,      v.immobilisation_risk, v.elevation_m};
    }
    return TALUS_OK;
  });
}

talus_code talus_read_cells(talus_session session, int column, int row, int width, int height,
                            talus_cell* buffer, size_t capacity, talus_error* error) {
  return guarded(error, [&] {
    const Held held(session);
    requirePointer(buffer, "buffer");
    const talus::maps::Grid& grid = held->map.ground().grid();
    require(column >= 0 && row >= 0 && width > 0 && height > 0 && width <= grid.width - column &&
                height <= grid.height - row,
            "the box reaches off the map of " + std::to_string(grid.width) + " x " +
                std::to_string(grid.height) + " cells; cut it to the map");
    const std::size_t cells = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    require(capacity >= cells,
            "capacity = " + std::to_string(capacity) + ", must be >= " + std::to_string(cells));
    talus::costmap::PlaceBeliefs beliefs(held->map.ground());
    for (int r = 0; r < height; ++r)
      for (int c = 0; c < width; ++c) {
        const talus::costmap::CellBelief b = beliefs.at({column + c, row + r});
        *buffer++ = {b.pull_mean,   b.pull_std, b.sinkage_mean,
                     b.sinkage_std, b.category, static_cast<uint8_t>(b.hazards)};
      }
    return TALUS_OK;
  });
}

talus_code talus_destroy(talus_session session, talus_error* error) {
  return guarded(error, [&] {
    const auto gone = sessions().remove(session);
    require(gone != nullptr, "session " + std::to_string(session) + " is not open; call talus_create()");
    gone->end();
    return TALUS_OK;
  });
}

void talus_default_rover(talus_rover* rover) {
  if (rover == nullptr) return;
  const talus::terramech::Rover usual;
  *rover = talus_rover{};
  rover->size = sizeof *rover;
  rover->wheel_count = usual.wheel_count;
  rover->gravity_m_s2 = usual.gravity_m_s2;
  rover->max_pitch_rad = usual.max_pitch_rad;
  rover->max_roll_rad = usual.max_roll_rad;
  rover->max_speed_mps = usual.max_speed_mps;
}

void talus_default_soil(talus_soil* soil) {
  if (soil == nullptr) return;
  const talus::terramech::Soil usual;
  *soil = talus_soil{};
  soil->size = sizeof *soil;
  soil->sinkage_exponent = usual.sinkage_exponent;
  soil->shear_modulus_m = usual.shear_modulus_m;
}

void talus_default_options(talus_options* options) {
  if (options == nullptr) return;
  *options = talus_options{};
  options->size = sizeof *options;
  options->threads = 1;
  options->seed = 1;
}
