#include "bad_input.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

namespace talus::cli {
namespace {

double hills(int column, int row) {
  return 0.3 * std::sin(column / 5.0) + 0.2 * std::cos(row / 6.0);
}

/// Flat terrain with a ring of walls, too steep for any rover, around the cells 30..33 of both axes.
double fortress(int column, int row) {
  const int ring = std::max(std::abs(column - 31), std::abs(row - 31));
  return ring >= 4 && ring <= 6 ? 8.0 : 0.0;
}

double nothing(int, int) {
  return -9999.0;
}

/// Reproducible pseudo-random bytes that match no file format.
std::string garbage() {
  std::string bytes;
  unsigned state = 12345;
  for (int i = 0; i < 4096; ++i) {
    state = state * 1664525U + 1013904223U;
    bytes += static_cast<char>(state >> 24);
  }
  return bytes;
}

}  // namespace

std::string asciiGrid(int columns, int rows, const std::function<double(int, int)>& height_m) {
  std::string text = fmt::format(
      "ncols {}\nnrows {}\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9999\n", columns, rows);
  for (int row = rows - 1; row >= 0; --row) {
    for (int column = 0; column < columns; ++column) text += fmt::format("{:.3f} ", height_m(column, row));
    text += '\n';
  }
  return text;
}

BadFiles::BadFiles() {
  const std::string good = asciiGrid(64, 64, hills);
  folder_.write("good.asc", good);
  folder_.write("cut.asc", good.substr(0, good.size() / 2));
  folder_.write("fortress.asc", asciiGrid(64, 64, fortress));
  folder_.write("nodata.asc", asciiGrid(20, 20, nothing));
  folder_.write("one.asc", asciiGrid(1, 1, hills));
  folder_.write("huge.asc", "ncols 90000000\nnrows 90000000\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3\n");
  folder_.write("far.asc", asciiGrid(8, 8, [](int column, int) { return 6378137.0 + column; }));
  folder_.write("empty", "");
  folder_.write("garbage.tif", garbage());
  folder_.write("tiff_head.tif", std::string("II*\0\x08\0\0\0", 8));
  folder_.write("garbage.ot", garbage());
  folder_.write("head.ot",
                "# Octomap OcTree file\nid TraversabilityTree\nsize 99999999999\nres 1\ndata\n" + garbage());
  folder_.write("garbage.yaml", garbage());
  folder_.write("nan.yaml", "name: x\ncohesion_Pa: .nan\nfriction_angle_rad: 0.5\n");
  folder_.write("unknown_key.yaml", "name: x\ncohesoin_Pa: 100\nfriction_angle_rad: 0.5\n");
  folder_.write("open.yaml", "name: [x\ncohesion_Pa: 1\n");
  folder_.write("list.yaml", "- 1\n- 2\n");
  folder_.write("text.json", "{\"type\": \"FeatureCollection\", \"features\": [");
  folder_.write("point_less.json", R"({"type": "FeatureCollection", "features": []})");
  folder_.write("no_route.geojson",
                R"({"type": "FeatureCollection", "features": [{"type": "Feature", "properties":
    {"x_m": [1, 2], "y_m": [1]}, "geometry": null}]})");
  folder_.write("empty.csv", "");
  folder_.write("head_only.csv", "x_m,y_m,load_N,slip,torque_Nm,sinkage_m\n");
  folder_.write("wrong_columns.csv", "a,b\n1,2\n");
  folder_.write("words.csv", "x_m,y_m,load_N,slip,torque_Nm,sinkage_m\nten,north,heavy,some,much,deep\n");
  folder_.write("garbage.csv", garbage());
  std::filesystem::create_directory(folder_.path() / "folder");
  std::filesystem::create_symlink("nowhere", folder_.path() / "dangling.tif");
}

void expectRefused(const BadFiles& files, const std::vector<BadCall>& calls) {
  const std::vector<std::string> before = files.folder().names();
  for (const BadCall& call : calls) {
    std::vector<std::string> words = call.words;
    words.emplace_back("--quiet");
    const Ran ran = runTalus(words, files.folder().path());
    SCOPED_TRACE(fmt::format("talus {}\n{}", fmt::join(call.words, " "), ran.err));
    EXPECT_EQ(ran.code, call.code);
    EXPECT_THAT(ran.err, testing::StartsWith("talus: "));
    EXPECT_THAT(ran.err, testing::HasSubstr(call.says));
    EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1);
    EXPECT_EQ(ran.out, "");
    EXPECT_EQ(files.folder().names(), before);
  }
}

}  // namespace talus::cli
