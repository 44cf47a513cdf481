#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <istream>
#include <ostream>
#include <stdexcept>
#include <utility>

#include <unistd.h>

#include <costmap/map_file.hpp>
#include <costmap/map_text.hpp>

namespace talus::costmap {
namespace {

static_assert(std::endian::native == std::endian::little,
              "the rasters of a map file are written as they lie in memory");

constexpr std::array<char, 8> kMagic{'T', 'A', 'L', 'U', 'S', 'M', 'A', 'P'};
constexpr std::uint32_t kVersion = 1;
constexpr std::uint64_t kMostText = 1U << 24;

// FNV-1a over 8-byte words, then over the bytes left: guards against damage, not malice.
class Checksum {
 public:
  void add(const void* data, std::size_t size) noexcept {
    const auto* bytes = static_cast<const char*>(data);
    for (; size >= 8; bytes += 8, size -= 8) {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes, 8);
      mix(word);
    }
    for (; size > 0; ++bytes, --size) mix(static_cast<unsigned char>(*bytes));
  }
  std::uint64_t value() const noexcept { return value_; }

 private:
  void mix(std::uint64_t word) noexcept { value_ = (value_ ^ word) * 0x100000001b3ULL; }
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

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
  void finish() {
    const std::uint64_t sum = checksum_.value();
    stream_.write("SUM ", 4);
    stream_.write(reinterpret_cast<const char*>(&sum), sizeof sum);
  }

 private:
  void raw(const void* data, std::size_t size) {
    stream_.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
    checksum_.add(data, size);
  }

  std::ostream& stream_;
  Checksum checksum_;
};

class TrailerReader {
 public:
  TrailerReader(std::istream& stream, std::string name) : stream_(stream), name_(std::move(name)) {
    std::array<char, 8> magic{};
    std::uint32_t version = 0;
    raw(magic.data(), magic.size());
    if (magic != kMagic) fail("an octree without the trailer of a map");
    raw(&version, sizeof version);
    if (version != kVersion)
      fail("version " + std::to_string(version) + " of the format, this program reads 1");
  }

  std::string text(const char (&tag)[5]) {
    const std::uint64_t size = open(tag);
    if (size > kMostText) fail("damaged section");
    std::string bytes(size, '\0');
    raw(bytes.data(), bytes.size());
    return bytes;
  }

  // A raster over the grid, or none when the section is empty.
  template <typename T>
  maps::Raster<T> raster(const char (&tag)[5], const maps::Grid& grid) {
    const std::uint64_t size = open(tag);
    if (size == 0) return {};
    if (size != grid.size() * sizeof(T)) fail("damaged section");
    maps::Raster<T> raster(grid);
    raw(raster.values().data(), size);
    return raster;
  }

  void finish() {
    const std::uint64_t expected = checksum_.value();
    std::array<char, 4> tag{};
    std::uint64_t sum = 0;
    raw(tag.data(), tag.size());
    raw(&sum, sizeof sum);
    if (std::memcmp(tag.data(), "SUM ", 4) != 0 || sum != expected)
      fail("damaged: its checksum does not fit");
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
  // Asked before memory is taken for a section, so that a damaged size cannot exhaust it.
  std::uint64_t bytesLeft() {
    const auto here = stream_.tellg();
    const auto end = stream_.seekg(0, std::ios::end).tellg();
    stream_.seekg(here);
    return static_cast<std::uint64_t>(end - here);
  }
  void raw(void* data, std::size_t size) {
    if (!stream_.read(static_cast<char*>(data), static_cast<std::streamsize>(size))) fail("truncated");
    checksum_.add(data, size);
  }
  [[noreturn]] void fail(const std::string& reason) const {
    throw InputError({name_, reason, "write the map again with talus costmap"});
  }

  std::istream& stream_;
  std::string name_;
  Checksum checksum_;
};

maps::Raster<Hazard> declared(const TraversabilityMap& map) {
  maps::Raster<Hazard> hazards(map.grid());
  constexpr auto kept = static_cast<std::uint8_t>(Hazard::Rocks | Hazard::KeepOut);
  for (std::size_t i = 0; i < hazards.values().size(); ++i)
    hazards.values()[i] = static_cast<Hazard>(static_cast<std::uint8_t>(map.hazards().values()[i]) & kept);
  return hazards;
}

MapText textOf(const TraversabilityMap& map) {
  MapText text{.grid = map.grid(),
               .coordinate_system = {},
               .source = map.elevation().source,
               .footprint_radius_m = map.footprintRadius_m(),
               .ground = map.model().parts()};
  if (map.elevation().georeference) text.coordinate_system = map.elevation().georeference->system();
  return text;
}

void requireSane(const maps::Grid& grid, const std::string& name) {
  if (grid.width < 1 || grid.height < 1 || grid.width > 65536 || grid.height > 65536 ||
      !(grid.resolution_m > 0.0))
    throw InputError({name, "damaged: its grid is impossible", "write the map again with talus costmap"});
}

}  // namespace

void writeMap(const TraversabilityMap& map, std::ostream& stream) {
  writeTree(map.tree(), stream);
  TrailerWriter trailer(stream);
  const std::string text = written(textOf(map));
  trailer.section("TEXT", text.data(), text.size());
  const auto& elevation = map.elevation().elevation_m.values();
  trailer.section("ELEV", elevation.data(), elevation.size() * sizeof(float));
  trailer.section("CLAS", map.classes().values().data(), map.classes().values().size());
  const maps::Raster<Hazard> hazards = declared(map);
  trailer.section("HAZD", hazards.values().data(), hazards.values().size());
  trailer.finish();
}

void writeMap(const TraversabilityMap& map, const std::string& path) {
  const std::string beside = path + ".tmp" + std::to_string(::getpid());
  std::error_code failed;
  {
    std::ofstream stream(beside, std::ios::binary);
    writeMap(map, stream);
    stream.close();
    if (!stream) failed = std::make_error_code(std::errc::io_error);
  }
  if (!failed) std::filesystem::rename(beside, path, failed);
  if (!failed) return;
  std::filesystem::remove(beside, failed);
  throw InputError({path, "cannot be written", "check that the folder exists and has room"});
}

// Leaves that wheels spoke for carry their block's evidence; cell by cell, so that the order is the writer's.
void restoreEvidence(const TraversabilityTree& tree, TraversabilityMap& map) {
  bool any = false;
  for (int row = 0; row < map.grid().height; ++row)
    for (int column = 0; column < map.grid().width; ++column) {
      const float elevation = map.elevation().elevation_m[{column, row}];
      if (std::isnan(elevation)) continue;
      const CellBelief* saved = tree.find(map.keys().key({column, row}, static_cast<double>(elevation)));
      if (!saved || saved->evidence <= 0.0F) continue;
      map.restore({column, row}, *saved);
      any = true;
    }
  if (any) map.publishAll();
}

TraversabilityMap readMap(std::istream& stream, const MapReading& reading, const Watch& watch) {
  const TraversabilityTree tree = readTree(stream, reading.name);
  TrailerReader trailer(stream, reading.name);
  MapText text = parsed(trailer.text("TEXT"), reading.name);
  requireSane(text.grid, reading.name);
  MapLayers layers;
  layers.elevation.source = text.source;
  layers.elevation.elevation_m = trailer.raster<float>("ELEV", text.grid);
  layers.classes = trailer.raster<std::uint8_t>("CLAS", text.grid);
  layers.declared = trailer.raster<Hazard>("HAZD", text.grid);
  trailer.finish();
  if (layers.elevation.elevation_m.empty())
    throw InputError(
        {reading.name, "damaged: it holds no elevation", "write the map again with talus costmap"});
  try {
    if (text.coordinate_system) layers.elevation.georeference.emplace(*text.coordinate_system);
    auto model = std::make_shared<GroundModel>(std::move(text.ground));
    TraversabilityMap map(std::move(layers), std::move(model),
                          {.footprint_radius_m = text.footprint_radius_m, .threads = reading.threads}, watch);
    restoreEvidence(tree, map);
    return map;
  } catch (const std::invalid_argument& error) {
    throw InputError(
        {reading.name, std::string("damaged: ") + error.what(), "write the map again with talus costmap"});
  }
}

TraversabilityMap readMap(const std::string& path, int threads, const Watch& watch) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw InputError({path, "cannot be opened", "check the path"});
  return readMap(stream, {.name = path, .threads = threads}, watch);
}

}  // namespace talus::costmap
