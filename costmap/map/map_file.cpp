#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <istream>
#include <ostream>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <talus/common/checksum.hpp>
#include <talus/common/common.hpp>
#include <talus/common/limits.hpp>
#include <talus/common/output_file.hpp>
#include <talus/costmap/costmap.hpp>
#include <talus/costmap/map/ground_curves.hpp>
#include <talus/costmap/map/map_file.hpp>
#include <talus/costmap/surface/surface_tree.hpp>

namespace talus::costmap {

namespace {

Surface surfaceOf(const TraversabilityMap& map) {
  return {map.elevation().elevation_m, map.surface().keys()};
}

static_assert(std::endian::native == std::endian::little, "map files require a little-endian machine");

constexpr std::array<char, 8> kMagic{'T', 'A', 'L', 'U', 'S', 'M', 'A', 'P'};
constexpr std::uint32_t kVersion = 10;
constexpr std::array<char, 4> kEnd{'E', 'N', 'D', ' '};

std::string versionFault(std::uint32_t version) {
  return "a map of version " + std::to_string(version) + "; this program reads version " +
         std::to_string(kVersion);
}

class TrailerWriter {
 public:
  explicit TrailerWriter(std::ostream& stream) : stream_(stream) {
    raw(kMagic.data(), kMagic.size());
    raw(&kVersion, sizeof kVersion);
  }
  void section(const char (&tag)[5], const void* data, std::uint64_t size) {
    raw(tag, 4);
    raw(&size, sizeof size);
    raw(data, size);
  }

 private:
  void raw(const void* data, std::size_t size) {
    stream_.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
  }

  std::ostream& stream_;
};

// The last 16 bytes of a map file: "END ", version and checksum.
struct End {
  std::array<char, 4> tag = kEnd;
  std::uint32_t version = kVersion;
  std::uint64_t checksum = 0;
};
static_assert(sizeof(End) == 16);

std::uint64_t sizeOf(std::istream& stream) {
  stream.clear();
  const auto end = stream.seekg(0, std::ios::end).tellg();
  return end < 0 ? 0 : static_cast<std::uint64_t>(end);
}

// Checksum of the first `size` bytes of a seekable stream.
std::uint64_t checksumOf(std::istream& stream, std::uint64_t size) {
  std::vector<char> piece(std::size_t{1} << 20U);
  Checksum checksum;
  stream.seekg(0);
  while (size > 0 && stream) {
    const auto count = std::min<std::uint64_t>(size, piece.size());
    stream.read(piece.data(), static_cast<std::streamsize>(count));
    checksum.add(piece.data(), count);
    size -= count;
  }
  return checksum.value();
}

// Verifies the checksum before any byte is interpreted.
void requireWhole(std::istream& stream, const std::string& name) {
  const std::uint64_t size = sizeOf(stream);
  End end{.tag = {}, .version = 0};
  if (size > sizeof end) {
    stream.seekg(static_cast<std::streamoff>(size - sizeof end));
    stream.read(reinterpret_cast<char*>(&end), sizeof end);
  }
  const auto refuse = [&](const std::string& reason) {
    throw InputError({name, reason, "write the map again with talus costmap"});
  };
  if (end.tag != kEnd) refuse("no traversability map, truncated, or of a version before 4");
  if (end.version != kVersion) refuse(versionFault(end.version));
  if (checksumOf(stream, size - sizeof end) != end.checksum) refuse("damaged: checksum mismatch");
  stream.seekg(0);
}

class TrailerReader {
 public:
  TrailerReader(std::istream& stream, std::string name) : stream_(stream), name_(std::move(name)) {
    std::array<char, 8> magic{};
    raw(magic.data(), magic.size());
    if (magic != kMagic) fail("an octree without the trailer of a map");
    std::uint32_t version = 0;
    raw(&version, sizeof version);
    if (version != kVersion) fail(versionFault(version));
  }

  std::string bytes(const char (&tag)[5]) {
    std::string bytes(open(tag), '\0');
    raw(bytes.data(), bytes.size());
    return bytes;
  }

  // Reads a raster of the grid; an empty raster for an empty section.
  template <typename T>
  maps::Raster<T> raster(const char (&tag)[5], const maps::Grid& grid) {
    const std::uint64_t size = open(tag);
    if (size == 0) return {};
    if (size != grid.size() * sizeof(T)) fail("damaged section");
    maps::Raster<T> raster(grid);
    raw(raster.values().data(), size);
    return raster;
  }

  bool more() { return bytesLeft() > sizeof(End); }

  /// Verifies that the checksum follows directly.
  void finish() {
    if (bytesLeft() != sizeof(End)) fail("damaged section");
  }

 private:
  std::uint64_t open(const char (&tag)[5]) {
    std::array<char, 4> found{};
    std::uint64_t size = 0;
    raw(found.data(), found.size());
    if (std::memcmp(found.data(), tag, 4) != 0) fail("damaged section");
    raw(&size, sizeof size);
    if (size > bytesLeft()) fail("truncated");
    return size;
  }
  // Returns the number of bytes to the end. Checked before the allocation of a section, so that a damaged
  // size cannot exhaust the memory.
  std::uint64_t bytesLeft() {
    const auto here = stream_.tellg();
    const auto end = stream_.seekg(0, std::ios::end).tellg();
    stream_.seekg(here);
    return static_cast<std::uint64_t>(end - here);
  }
  void raw(void* data, std::size_t size) {
    if (!stream_.read(static_cast<char*>(data), static_cast<std::streamsize>(size))) fail("truncated");
  }
  [[noreturn]] void fail(const std::string& reason) const {
    throw InputError({name_, reason, "write the map again with talus costmap"});
  }

  std::istream& stream_;
  std::string name_;
};

maps::Raster<Hazard> declared(const TraversabilityMap& map) {
  maps::Raster<Hazard> hazards(map.grid());
  constexpr auto kept = static_cast<std::uint8_t>(Hazard::Rocks | Hazard::KeepOut);
  for (std::size_t i = 0; i < hazards.values().size(); ++i)
    hazards.values()[i] =
        static_cast<Hazard>(static_cast<std::uint8_t>(map.surface().hazards().values()[i]) & kept);
  return hazards;
}

// Section of a cost layer: name, newline, cost of unseen cells, raster.
std::string bytesOf(const CostLayer& layer) {
  const auto& values = layer.added_J_per_m.values();
  std::string bytes = layer.name + '\n';
  bytes.append(reinterpret_cast<const char*>(&layer.unseen_J_per_m), sizeof(float));
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
  return bytes;
}

CostLayer costLayerOf(const std::string& bytes, const maps::Grid& grid) {
  const std::size_t name = bytes.find('\n');
  if (name == std::string::npos || bytes.size() - name - 1 != (grid.size() + 1) * sizeof(float))
    throw std::invalid_argument("a cost layer of another size");
  CostLayer layer{.name = bytes.substr(0, name), .added_J_per_m = maps::Raster<float>(grid)};
  std::memcpy(&layer.unseen_J_per_m, bytes.data() + name + 1, sizeof(float));
  std::memcpy(layer.added_J_per_m.values().data(), bytes.data() + name + 1 + sizeof(float),
              grid.size() * sizeof(float));
  return layer;
}

MapText textOf(const TraversabilityMap& map) {
  MapText text{.grid = map.grid(),
               .coordinate_system = {},
               .source = map.elevation().source,
               .reading = map.elevation().reading,
               .files = map.elevation().files,
               .footprint_radius_m = map.surface().footprintRadius_m(),
               .ground = map.model().parts(),
               .refused = map.surface().refused(),
               .drives = map.drives()};
  map.evidence().visit([&](const SavedBlock& saved) { text.evidence.push_back(saved); });
  if (map.elevation().georeference) text.coordinate_system = map.elevation().georeference->system();
  return text;
}

void requireSane(const MapText& text, const std::string& name) {
  const maps::Grid& grid = text.grid;
  if (grid.width < 1 || grid.height < 1 || grid.width > 65536 || grid.height > 65536 ||
      !(grid.resolution_m > 0.0) || text.ground.classes.size() > 254)
    throw InputError({name, "damaged: invalid grid or classes", "write the map again with talus costmap"});
}

}  // namespace

TraversabilityTree treeOf(const TraversabilityMap& map) {
  PlaceBeliefs beliefs(map);
  return surfaceTree(surfaceOf(map), [&](maps::Cell cell) { return beliefs.at(cell); });
}

void writeTree(const TraversabilityMap& map, std::ostream& stream) {
  PlaceBeliefs beliefs(map);
  writeSurfaceTree(
      surfaceOf(map), [&](maps::Cell cell) { return beliefs.at(cell); }, stream);
}

void writeMap(const TraversabilityMap& map, std::iostream& stream) {
  writeTree(map, stream);
  TrailerWriter trailer(stream);
  const std::string text = written(textOf(map));
  trailer.section("TEXT", text.data(), text.size());
  const auto& elevation = map.elevation().elevation_m.values();
  trailer.section("ELEV", elevation.data(), elevation.size() * sizeof(float));
  trailer.section("CLAS", map.surface().classes().values().data(), map.surface().classes().values().size());
  const maps::Raster<Hazard> hazards = declared(map);
  trailer.section("HAZD", hazards.values().data(), hazards.values().size());
  for (const CostLayer& layer : map.surface().costLayers()) {
    const std::string bytes = bytesOf(layer);
    trailer.section("COST", bytes.data(), bytes.size());
  }
  // The checksum is computed by reading back, because the octree writer updates its header at the end.
  const End end{.checksum = checksumOf(stream, static_cast<std::uint64_t>(stream.tellp()))};
  stream.seekp(0, std::ios::end);
  stream.write(reinterpret_cast<const char*>(&end), sizeof end);
}

void writeMap(const TraversabilityMap& map, const std::string& path) {
  OutputFile file(path);
  writeMap(map, file.stream());
  file.commit();
}

TraversabilityMap readMap(std::istream& stream, const MapReading& reading, const ProgressMonitor& watch) {
  requireWhole(stream, reading.name);
  readLeaves(stream, reading.name, [](const TreeLeaf&) {});  // the nodes are skipped, because the trailer
                                                             // contains the same information
  TrailerReader trailer(stream, reading.name);
  MapText text = parsed(trailer.bytes("TEXT"), reading.name);
  requireSane(text, reading.name);
  requireMemory(40.0 * static_cast<double>(text.grid.size()), reading.name);
  MapLayers layers;
  layers.elevation.source = text.source;
  layers.elevation.reading = text.reading;
  layers.elevation.files = text.files;
  layers.elevation.elevation_m = trailer.raster<float>("ELEV", text.grid);
  layers.classes = trailer.raster<std::uint8_t>("CLAS", text.grid);
  layers.declared = trailer.raster<Hazard>("HAZD", text.grid);
  std::vector<std::string> costs;
  while (trailer.more()) costs.push_back(trailer.bytes("COST"));
  trailer.finish();
  if (layers.elevation.elevation_m.empty())
    throw InputError(
        {reading.name, "damaged: it holds no elevation", "write the map again with talus costmap"});
  try {
    for (const std::string& bytes : costs) layers.costs.push_back(costLayerOf(bytes, text.grid));
    if (text.coordinate_system)
      layers.elevation.georeference = reading.georeference
                                          ? reading.georeference(*text.coordinate_system, text.grid)
                                          : maps::Georeference(*text.coordinate_system);
    auto model = std::make_shared<GroundModel>(std::move(text.ground));
    TraversabilityMap map(std::move(layers), std::move(model),
                          {.footprint_radius_m = text.footprint_radius_m, .threads = reading.threads}, watch);
    for (const SavedBlock& saved : text.evidence)
      if (!map.restore(saved)) throw std::invalid_argument("its evidence is impossible");
    for (const RefusedPlace& refused : text.refused)
      map.refuse(refused.place, refused.radius_m, refused.drive);
    if (!text.evidence.empty())
      map.publishAll();
    else if (!text.refused.empty())
      map.publish();
    for (const auto& [id, drive] : text.drives) map.noteDrive(id, drive);
    return map;
  } catch (const std::invalid_argument& error) {
    throw InputError(
        {reading.name, std::string("damaged: ") + error.what(), "write the map again with talus costmap"});
  }
}

TraversabilityMap readMap(const std::string& path, int threads, const ProgressMonitor& watch) {
  return readMap({.name = path, .threads = threads}, watch);
}

TraversabilityMap readMap(const MapReading& reading, const ProgressMonitor& watch) {
  const std::string& path = reading.name;
  std::error_code error;
  if (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error))
    throw InputError({path, "is a folder, a device, a FIFO or a socket", "give a file"});
  checkInput(path);
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw InputError({path, "cannot be opened", "check the path"});
  return readMap(stream, reading, watch);
}

}  // namespace talus::costmap
