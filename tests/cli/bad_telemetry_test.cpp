// Tables of measurements, models and maps of beliefs that cannot be used, told in one line by every command
// that reads them.
#include "bad_input.hpp"

namespace talus::cli {
namespace {

TEST(BadInput, Telemetry) {
  std::vector<BadCall> calls{
      {{"estimate"}, 2, "talus estimate --help"},
      {{"estimate", "words.csv", "--method", "foo"}, 2, "foo not in"},
      {{"assess", "words.csv", "--slope", "9"}, 2, ""},
      {{"trace", "words.csv", "--base", "list.yaml"}, 2, ".yaml"},
      {{"predict", "words.csv", "--model", "missing.yaml", "-o", "out.csv"}, 2, "missing.yaml"},
      {{"predict", "words.csv", "--model", "nan.yaml", "-o", "out.csv"}, 2, "nan.yaml"},
  };
  for (const char* file : {"missing.csv", "folder", "empty.csv", "head_only.csv", "wrong_columns.csv",
                           "words.csv", "garbage.csv"}) {
    calls.push_back({{"estimate", file, "--method", "iagnemma"}, 2, file});
    calls.push_back({{"assess", file}, 2, file});
    calls.push_back({{"trace", file}, 2, file});
  }
  expectRefused(BadFiles(), calls);
}

TEST(BadInput, MapsOfBeliefs) {
  const std::vector<std::string> site{"good.asc",   "--resolution", "1",   "--soil",
                                      "sandy_loam", "--rover",      "fido"};
  const auto with = [&site](const char* command, const std::vector<std::string>& more) {
    std::vector<std::string> words{command};
    words.insert(words.end(), site.begin(), site.end());
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  expectRefused(BadFiles(), {
                                {{"costmap"}, 2, "DEM"},
                                {{"costmap", "missing.tif", "-o", "m.ot"}, 2, "missing.tif"},
                                {{"costmap", "one.asc", "--resolution", "1", "-o", "m.ot"}, 2, "one.asc"},
                                {{"costmap", "head.ot", "-o", "m.ot"}, 2, "head.ot"},
                                {with("costmap", {"-o", "no/m.ot"}), 2, "no/m.ot"},
                                {with("costmap", {"--png", "no/p.png"}), 2, "no/p.png"},
                                {with("costmap", {"--geotiff", "no/l.tif"}), 2, "no/l.tif"},
                                {with("costmap", {"--octovis", "folder"}), 2, "is a directory"},
                                {with("costmap", {"--footprint", "nan"}), 2, "--footprint"},
                                {with("explain", {}), 2, "--at"},
                                {with("explain", {"--at", "5"}), 2, "--at 5"},
                                {with("explain", {"--at", "500,5"}), 2, "outside"},
                                {with("explain", {"--at", "5,5", "--heading", "nan"}), 2, "--heading"},
                                {{"update"}, 2, "MAP"},
                                {{"update", "missing.ot", "words.csv", "-o", "m.ot"}, 2, "missing.ot"},
                                {{"update", "garbage.ot", "words.csv", "-o", "m.ot"}, 2, "garbage.ot"},
                                {{"update", "head.ot", "words.csv", "-o", "m.ot"}, 2, "head.ot"},
                            });
}

TEST(BadInput, SitesAndPlugins) {
  expectRefused(BadFiles(),
                {
                    {{"generate"}, 2, "KIND"},
                    {{"generate", "craters", "-o", "no/s.tif"}, 2, "no does not exist"},
                    {{"generate", "craters", "-o", "folder"}, 2, "is a directory"},
                    {{"generate", "craters", "--size", "5", "-o", "s.tif"}, 2, "--size 5"},
                    {{"generate", "craters", "--resolution", "nan", "-o", "s.tif"}, 2, "resolution"},
                    {{"plugins", "missing.so"}, 2, "missing.so"},
                    {{"plugins", "garbage.tif"}, 2, "garbage.tif"},
                    {{"plugins", "folder"}, 2, "folder"},
                });
}

}  // namespace
}  // namespace talus::cli
