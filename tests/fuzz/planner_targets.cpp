#include <fstream>
#include <iterator>

#include <talus/planner/bench/grid_suite.hpp>
#include <talus/planner/plugin/global_planner.hpp>

#include "targets.hpp"

namespace talus::fuzz {
namespace {

void readMovingAi(const std::string& bytes) {
  const auto split = bytes.find('\f');
  fileOf(bytes.substr(0, split), ".map");
  planner::readMovingAi(fileOf(split == bytes.npos ? "" : bytes.substr(split + 1), ".scen"), 5);
}

void readPlugin(const std::string& bytes) {
  planner::loadPlugin(fileOf(bytes, ".so"));
}

std::string pluginBytes() {
  std::ifstream file(TALUS_OTHER_PLUGIN, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

std::vector<Target> plannerTargets() {
  return {
      {"moving_ai",
       {"type octile\nheight 2\nwidth 3\nmap\n...\n.@.\n\fversion 1\n0\tinput.map\t3\t2\t0\t0\t2\t0\t2\n"},
       readMovingAi},
      {"plugin", {}, readPlugin, {pluginBytes()}}};
}

}  // namespace talus::fuzz
