#include "targets.hpp"

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <utility>

#include <nlohmann/json.hpp>
#include <site_map.hpp>
#include <unistd.h>
#include <yaml-cpp/exceptions.h>

#include <talus/costmap/checksum.hpp>
#include <talus/costmap/drive_evidence.hpp>
#include <talus/costmap/map_file.hpp>
#include <talus/costmap/octomap_surface.hpp>
#include <talus/maps/elevation_reader.hpp>
#include <talus/maps/geojson.hpp>
#include <talus/maps/layer_reader.hpp>
#include <talus/maps/memory_budget.hpp>
#include <talus/maps/numpy_array.hpp>
#include <talus/planner/bench/moving_ai.hpp>
#include <talus/talus.hpp>
#include <talus/terramech/io/model_file.hpp>
#include <talus/terramech/io/soil_library.hpp>
#include <talus/terramech/io/telemetry_reader.hpp>

namespace talus::fuzz {
namespace {

namespace fs = std::filesystem;

// One file of this process, whatever its ending; in memory where the machine has such a folder.
std::string fileOf(const std::string& bytes, const std::string& ending) {
  static const fs::path folder = [] {
    std::string name = (fs::is_directory("/dev/shm") ? "/dev/shm" : fs::temp_directory_path().string()) +
                       "/talus-fuzz-XXXXXX";
    return fs::path(::mkdtemp(name.data()));
  }();
  const fs::path path = folder / ("input" + ending);
  for (const char* more : {"-wal", "-shm"}) fs::remove(path.string() + more);
  std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
  return path.string();
}

std::string numpy(const std::string& shape, std::size_t numbers) {
  const std::string header = "{'descr': '<f8', 'fortran_order': False, 'shape': (" + shape + "), }\n";
  return std::string("\x93NUMPY\x01\x00", 8) + static_cast<char>(header.size()) + '\0' + header +
         std::string(8 * numbers, '\0');
}

maps::ElevationMap flat() {
  maps::ElevationMap map;
  map.elevation_m =
      maps::Raster<float>({.width = 20, .height = 20, .resolution_m = 1.0, .south_west = {0, 0}}, 0.0F);
  return map;
}

void readTelemetry(const std::string& bytes) {
  terramech::readTelemetry(fileOf(bytes, ".csv"), {.required = {"load_N", "slip"}, .wheel_radius_m = 0.1});
}

void readYaml(const std::string& bytes) {
  const std::string path = fileOf(bytes, ".yaml");
  std::size_t refused = 0;
  for (const auto& read : {std::function<void()>([&] { terramech::loadSoil(path); }),
                           std::function<void()>([&] { terramech::loadRover(path); }),
                           std::function<void()>([&] { terramech::loadModel(path); })})
    try {
      read();
    } catch (const InputError&) {
      ++refused;
    }
  if (refused == 3) throw InputError({"yaml", "is neither soil, rover nor model", ""});
}

void readGeoJson(const std::string& bytes) {
  const std::string path = fileOf(bytes, ".geojson");
  maps::readKeepOut(path, flat());
}

void readNumpyArchive(const std::string& bytes) {
  maps::readElevation(fileOf(bytes, ".npz"), {.resolution_m = 1.0, .max_cells = 10'000});
}

costmap::TraversabilityMap smallMap() {
  return costmap::mapOf({"1122", "1?22", "11#2", "1111"}, 0.05);
}

std::string mapBytes() {
  std::stringstream stream;
  costmap::writeMap(smallMap(), stream);
  return stream.str();
}

// With the checksum put right, which would else refuse every change.
void readMap(const std::string& bytes) {
  std::string whole = bytes;
  if (whole.size() > 16) {
    costmap::Checksum sum;
    sum.add(whole.data(), whole.size() - 16);
    const std::uint64_t value = sum.value();
    std::memcpy(whole.data() + whole.size() - 8, &value, 8);
  }
  std::istringstream stream(whole);
  costmap::readMap(stream, {.name = "map.ot", .threads = 1});
}

void readOctree(const std::string& bytes) {
  std::istringstream stream(bytes);
  costmap::octomapGround(stream, "octree", 1e9);
}

std::string journalBytes() {
  const std::string path = fileOf("", ".db");
  fs::remove(path);
  {
    costmap::EvidenceJournal journal(path);
    costmap::JournalRow row{.source = "a.csv", .line = 2, .accepted = true};
    row.observation.place = {1.0, 1.0};
    row.observation.pull = {0.1, 0.05};
    row.observation.sinkage = {0.1, 0.02};
    journal.append("a", {row, row});
  }
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void readJournal(const std::string& bytes) {
  costmap::TraversabilityMap map = smallMap();
  costmap::replay(map, costmap::EvidenceJournal(fileOf(bytes, ".db")));
}

void readMovingAi(const std::string& bytes) {
  const auto split = bytes.find('\f');
  fileOf(bytes.substr(0, split), ".map");
  planner::readMovingAi(fileOf(split == bytes.npos ? "" : bytes.substr(split + 1), ".scen"), 5);
}

std::vector<Target> all() {
  maps::setMemoryBudget(std::uint64_t{1} << 30U);
  // One voxel below a chain of sixteen nodes.
  std::string octree = "# Octomap OcTree file\nid OcTree\nsize 17\nres 0.1\ndata\n";
  for (int depth = 0; depth < 16; ++depth) octree += std::string("\0\0\0\0\x01", 5);
  octree += std::string("\0\0\x80\x3f\0", 5);
  return {
      {"telemetry",
       {"load_N,slip,sinkage_m,run\n10,0.2,0.01,a\n20,0.3,,b\n", "slip,load_N\n0.1,5\n"},
       readTelemetry},
      {"yaml",
       {"name: s\ncohesion_Pa: 500\nfriction_angle_deg: 30\nsinkage_exponent: 1\ncohesive_modulus: 1400\n"
        "frictional_modulus: 820000\nshear_modulus_m: 0.02\nc1: 0.3\nc2: 0\n",
        "name: w\nmass_kg: 10\ngravity_m_s2: 3.7\nwheels: {count: 6, radius_m: 0.065, width_m: 0.08}\n"
        "wheelbase_m: 0.5\ntrack_m: 0.4\nclearance_m: 0.2\ncentre_of_mass_height_m: 0.2\nmax_pitch_rad: 0.5\n"
        "max_roll_rad: 0.5\nmax_torque_Nm: 5\nmax_speed_mps: 0.1\nturning_radius_m: 1\nhotel_power_W: 10\n"
        "steering: skid\n"},
       readYaml},
      {"geojson",
       {R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{},"geometry":{"type":"Polygon",)"
        R"("coordinates":[[[1,1],[5,1],[5,5],[1,1]]]}}]})",
        R"({"type":"GeometryCollection","geometries":[{"type":"MultiPolygon","coordinates":[[[[1,1],[9,1],[9,9],[1,1]]]]}]})"},
       readGeoJson},
      {"npy",
       {numpy("2, 3", 6), numpy("", 1)},
       [](const std::string& bytes) { maps::parseNumpy(bytes, "npy"); }},
      {"npz", {}, readNumpyArchive},
      {"map", {mapBytes()}, readMap},
      {"octree", {octree}, readOctree},
      {"journal", {journalBytes()}, readJournal},
      {"moving_ai",
       {"type octile\nheight 2\nwidth 3\nmap\n...\n.@.\n\fversion 1\n0\tinput.map\t3\t2\t0\t0\t2\t0\t2\n"},
       readMovingAi},
  };
}

}  // namespace

const std::vector<Target>& targets() {
  static const std::vector<Target> list = all();
  return list;
}

bool accepts(const Target& target, const std::string& bytes) {
  try {
    target.read(bytes);
    return true;
  } catch (const InputError&) {
  } catch (const std::invalid_argument&) {
  } catch (const std::domain_error&) {
  } catch (const nlohmann::json::exception&) {
  } catch (const YAML::Exception&) {
  }
  return false;
}

}  // namespace talus::fuzz
