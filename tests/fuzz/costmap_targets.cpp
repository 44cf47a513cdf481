#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <sstream>

#include <site_map.hpp>

#include <talus/common/checksum.hpp>
#include <talus/common/limits.hpp>
#include <talus/costmap/costmap.hpp>
#include <talus/costmap/surface/surface_tree.hpp>

#include "targets.hpp"

namespace talus::fuzz {
namespace {

// Its ground takes a tenth of a second to price, and is the same each time.
costmap::TraversabilityMap smallMap() {
  static const std::shared_ptr<const costmap::GroundModel> ground = costmap::testGround();
  return {costmap::drawn({"1122", "1?22", "11#2", "1111"}, 0.05), ground, {}};
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
    Checksum sum;
    sum.add(whole.data(), whole.size() - 16);
    const std::uint64_t value = sum.value();
    std::memcpy(whole.data() + whole.size() - 8, &value, 8);
  }
  std::istringstream stream(whole);
  costmap::readMap(stream, {.name = "map.ot", .threads = 1});
}

// A hundred bytes may state columns for all of the budget, which takes seconds: octrees that need more than the megabyte that is
// always allowed are refused here.
struct SmallBudget {
  SmallBudget() { setMemoryBudget(1); }
  ~SmallBudget() { limitMemory(); }
  SmallBudget(const SmallBudget&) = delete;
  SmallBudget& operator=(const SmallBudget&) = delete;
};

void readOctree(const std::string& bytes) {
  const SmallBudget budget;
  std::istringstream stream(bytes);
  costmap::octomapGround(stream, "octree", 1e9);
}

std::string journalBytes() {
  const std::string path = fileOf("", ".db");
  std::filesystem::remove(path);
  {
    costmap::EvidenceJournal journal(path);
    costmap::JournalRow row{.source = "a.csv", .line = 2, .accepted = true};
    row.observation.place = {1.0, 1.0};
    row.observation.pull = {0.1, 0.05};
    row.observation.sinkage = {0.1, 0.02};
    journal.append("000000000000000a", {row, row});
  }
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void readJournal(const std::string& bytes) {
  costmap::TraversabilityMap map = smallMap();
  costmap::replay(map, costmap::EvidenceJournal(fileOf(bytes, ".db")));
}

// One voxel below a chain of sixteen nodes.
std::string octreeBytes() {
  std::string octree = "# Octomap OcTree file\nid OcTree\nsize 17\nres 0.1\ndata\n";
  for (int depth = 0; depth < 16; ++depth) octree += std::string("\0\0\0\0\x01", 5);
  return octree + std::string("\0\0\x80\x3f\0", 5);
}

}  // namespace

std::vector<Target> costmapTargets() {
  return {{"map", {mapBytes()}, readMap},
          {"octree", {octreeBytes()}, readOctree},
          {"journal", {journalBytes()}, readJournal}};
}

}  // namespace talus::fuzz
