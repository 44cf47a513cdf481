// The rooms stand on each other in one direction only; an include that points the other way fails here by
// name.
#include <algorithm>
#include <map>
#include <regex>
#include <set>

#include "source_files.hpp"

namespace talus::house {
namespace {

using Rooms = std::map<std::string, std::set<std::string>>;

const Rooms& roomsBelow() {
  static const Rooms below{{"terramech", {}},
                           {"maps", {}},
                           {"costmap", {"terramech", "maps"}},
                           {"planner", {"terramech", "maps", "costmap"}},
                           {"cli", {"terramech", "maps", "costmap", "planner"}}};
  return below;
}

TEST(House, NoRoomIncludesOneAboveIt) {
  const std::regex include(R"(#include <(terramech|maps|costmap|planner|cli)/)");
  for (const auto& [room, below] : roomsBelow())
    for (const auto& file : files(room, {".hpp", ".cpp"})) {
      const std::string source = text(file);
      for (std::sregex_iterator i(source.begin(), source.end(), include), end; i != end; ++i) {
        const std::string other = (*i)[1];
        EXPECT_TRUE(other == room || below.contains(other)) << file << " includes <" << other << "/...>";
      }
    }
}

TEST(House, RoomsAreFlat) {
  for (const auto& [room, below] : roomsBelow())
    for (const auto& file : files(room, {".hpp", ".cpp"}))
      EXPECT_EQ(file.parent_path().filename(), room) << file << " lies in a folder of its own";
}

TEST(House, FilesHaveOneIdea) {
  for (const auto& [room, below] : roomsBelow())
    for (const auto& file : files(room, {".hpp", ".cpp"})) {
      const std::string source = text(file);
      EXPECT_LE(std::count(source.begin(), source.end(), '\n'), 400) << file;
    }
}

}  // namespace
}  // namespace talus::house
