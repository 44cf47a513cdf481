#include <cmath>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>
#include <pybind11/stl/filesystem.h>
#include <sys/mman.h>
#include <unistd.h>

#include <talus/common/common.hpp>
#include <talus/common/output_file.hpp>
#include <talus/costmap/ground/ground_model.hpp>
#include <talus/planner/python/arrays.hpp>
#include <talus/planner/python/python_map.hpp>
#include <talus/terramech/io/terramech_io.hpp>

namespace py = pybind11;

namespace talus::planner {
namespace {

// Exclusive access to a session for one call; does not wait, because the GIL is held.
std::unique_lock<std::mutex> held(Session& session) {
  std::unique_lock lock(session.work, std::try_to_lock);
  if (!lock.owns_lock())
    throw std::runtime_error("another thread works on this map; wait for it, or give each thread its own");
  return lock;
}

costmap::GroundClass classOf(int number, const py::handle& soil, const terramech::Rover& rover) {
  if (number < 0 || number > 254)
    throw py::value_error("soils: class " + std::to_string(number) + ", must be 0 to 254");
  if (py::isinstance<py::str>(soil))
    return costmap::groundClass(number, terramech::loadSoilPrior(soil.cast<std::string>()), rover);
  if (py::isinstance<terramech::Soil>(soil)) return {.number = number, .soil = soil.cast<terramech::Soil>()};
  throw py::type_error("soils: a soil must be a name or a talus.Soil");
}

std::vector<costmap::GroundClass> classesOf(const py::object& soils, const terramech::Rover& rover) {
  if (!py::isinstance<py::dict>(soils)) return {classOf(0, soils, rover)};
  std::vector<costmap::GroundClass> classes;
  for (const auto& [number, soil] : soils.cast<py::dict>()) {
    if (!py::isinstance<py::int_>(number)) throw py::type_error("soils: the keys must be class numbers");
    classes.push_back(classOf(number.cast<int>(), soil, rover));
  }
  return classes;
}

std::vector<costmap::CostLayer> costsOf(const py::dict& given, const maps::Grid& grid) {
  std::vector<costmap::CostLayer> layers;
  for (const auto& [name, values] : given) {
    if (!py::isinstance<py::str>(name)) throw py::type_error("layers: the keys must be names");
    costmap::CostLayer layer{.name = name.cast<std::string>()};
    layer.added_J_per_m =
        floatsOf(py::reinterpret_borrow<py::object>(values), "layers['" + layer.name + "']", grid, false);
    for (const float v : layer.added_J_per_m.values())
      if (std::isfinite(v)) layer.unseen_J_per_m = std::max(layer.unseen_J_per_m, v);
    layers.push_back(std::move(layer));
  }
  return layers;
}

Map built(const PythonMap::Layers& layers, const PythonMap::Ground& ground) {
  const maps::Grid grid = gridOf(layers.heights, "heights",
                                 {.resolution_m = ground.resolution_m, .south_west = ground.south_west});
  if (ground.threads < 1)
    throw py::value_error("threads = " + std::to_string(ground.threads) + ", must be >= 1");
  costmap::MapLayers made;
  made.elevation = {.elevation_m = floatsOf(layers.heights, "heights", grid), .source = "heights"};
  made.classes = bytesOf(layers.classes, "classes", grid);
  if (made.classes.empty() && py::isinstance<py::dict>(ground.soils) &&
      ground.soils.cast<py::dict>().size() > 1)
    throw py::value_error("classes: needed where soils has more than one class");
  made.rock_abundance = floatsOf(layers.rocks, "rocks", grid);
  made.keep_out = bytesOf(layers.keep_out, "keep_out", grid);
  made.costs = costsOf(layers.costs, grid);
  costmap::GroundModel::Parts parts{
      .rover = ground.rover, .classes = classesOf(ground.soils, ground.rover), .policy = ground.policy};
  const py::gil_scoped_release released;
  return Map({.layers = std::move(made),
              .ground = costmap::GroundModel(std::move(parts)),
              .options = {.threads = ground.threads}});
}

// Columns as a file in memory, so that rows are checked in the same way as rows of a telemetry file.
class ColumnFile {
 public:
  ColumnFile() : descriptor_(::memfd_create("columns", MFD_CLOEXEC)) {}
  explicit ColumnFile(const py::dict& columns) : ColumnFile() {  // a throw runs the destructor
    std::vector<py::array> arrays;
    std::ofstream out(path());
    out << std::setprecision(17);
    for (const auto& [name, values] : columns) {
      const std::string column = py::str(name);
      if (!py::isinstance<py::array>(values) || values.cast<py::array>().ndim() != 1)
        throw py::type_error("column '" + column + "' must be a numpy array of one dimension");
      const auto array = values.cast<py::array>();
      const char kind = array.dtype().kind();
      if (kind != 'f' && kind != 'i' && kind != 'u')
        throw py::type_error("column '" + column + "': dtype " + std::string(py::str(array.dtype())) +
                             ", must be a float or whole number");
      out << (arrays.empty() ? "" : ",") << '"' << column << '"';
      arrays.push_back(py::array_t<double>(array));
      if (arrays.back().size() != arrays.front().size())
        throw py::value_error("column '" + column + "' has " + std::to_string(arrays.back().size()) +
                              " values, must be " + std::to_string(arrays.front().size()) + " as the first");
    }
    for (py::ssize_t row = 0; !arrays.empty() && row < arrays.front().size(); ++row)
      for (std::size_t k = 0; k < arrays.size(); ++k) {
        out << (k == 0 ? '\n' : ',');
        const double value = arrays[k].unchecked<double, 1>()(row);
        if (!std::isnan(value)) out << value;  // NaN: not measured
      }
    out << '\n';
    out.close();
    if (!out) throw std::runtime_error("no memory for the columns");
  }
  ColumnFile(const ColumnFile&) = delete;
  ColumnFile& operator=(const ColumnFile&) = delete;
  ~ColumnFile() { ::close(descriptor_); }
  std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

terramech::Telemetry telemetryOf(const py::object& given) {
  if (!py::isinstance<py::dict>(given)) return terramech::readTelemetry(given.cast<std::filesystem::path>());
  const ColumnFile file(given.cast<py::dict>());
  try {
    terramech::Telemetry telemetry = terramech::readTelemetry(file.path());
    telemetry.source = "columns";
    return telemetry;
  } catch (const InputError& error) {
    std::string where = error.parts().where;
    if (const auto at = where.find(file.path()); at != std::string::npos)
      where.replace(at, file.path().size(), "columns");
    throw InputError({where, error.parts().reason, error.parts().remedy});
  }
}

}  // namespace

PythonMap::PythonMap(const Layers& layers, const Ground& ground) : PythonMap(built(layers, ground)) {}

void PythonMap::patch(const Layers& layers, maps::Point south_west) {
  const auto lock = held(*session_);
  const py::object* first = nullptr;
  for (const py::object* each : {&layers.heights, &layers.classes, &layers.rocks, &layers.keep_out})
    if (!each->is_none() && first == nullptr) first = each;
  if (first == nullptr) throw py::value_error("patch: give heights, classes, rocks or keep_out");
  const maps::Grid grid =
      gridOf(*first, "patch", {.resolution_m = map().grid().resolution_m, .south_west = south_west});
  const costmap::SurfacePatch patch{.elevation_m = floatsOf(layers.heights, "heights", grid),
                                    .rock_abundance = floatsOf(layers.rocks, "rocks", grid),
                                    .classes = bytesOf(layers.classes, "classes", grid),
                                    .keep_out = bytesOf(layers.keep_out, "keep_out", grid)};
  const py::gil_scoped_release released;
  session_->map.patch(patch);
}

std::size_t PythonMap::learn(const py::object& given) {
  const auto lock = held(*session_);
  const terramech::Telemetry telemetry = telemetryOf(given);
  const py::gil_scoped_release released;
  return session_->map.learnPart(telemetry);
}

void PythonMap::settle() {
  const auto lock = held(*session_);
  const py::gil_scoped_release released;
  session_->map.settle();
}

std::unique_ptr<PythonMap> PythonMap::read(const std::string& path, int threads) {
  if (threads < 1) throw py::value_error("threads = " + std::to_string(threads) + ", must be >= 1");
  std::unique_ptr<PythonMap> map;
  {
    const py::gil_scoped_release released;
    map = std::make_unique<PythonMap>(Map::read(path, threads));
  }
  const py::object file = py::module_::import("builtins").attr("open")(path, "rb");
  const py::object digest = py::module_::import("hashlib").attr("file_digest")(file, "sha256");
  file.attr("close")();
  map->files_ = map->map().elevation().files;
  map->files_.insert(map->files_.begin(), {path, "map", std::filesystem::file_size(path),
                                           digest.attr("hexdigest")().cast<std::string>()});
  return map;
}

void PythonMap::save(const std::string& path) const {
  const auto lock = held(*session_);
  const py::gil_scoped_release released;
  session_->map.save(path);
}

void PythonMap::writeRoute(const Route& route, const std::string& path) const {
  if (route.status != RouteStatus::Found)
    throw py::value_error("route: its status is " + std::string(name(route.status)) + ", must be found");
  const auto document =
      routeGeoJson(route, map().elevation(),
                   {.files = files_, .seed = settings_.seed, .reading = map().elevation().reading});
  writeFile(path, document.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
}

Route PythonMap::plan(const PlannerSettings& settings, const PlanRequest& request,
                      const py::object& progress) {
  const auto lock = held(*session_);
  if (!(settings == settings_)) session_->planner = Planner(settings);
  settings_ = settings;
  Route route;
  inBackground(
      [&](const ProgressMonitor& watch) {
        PlanRequest asked = request;
        asked.watch = watch;
        route = session_->planner.plan(session_->map, asked);
      },
      progress);
  return route;
}

PythonMap PythonMap::moved(maps::Cell tiles) const {
  const auto lock = held(*session_);
  const py::gil_scoped_release released;
  PythonMap next(session_->map.moved(tiles));
  next.files_ = files_;
  return next;
}

}  // namespace talus::planner
