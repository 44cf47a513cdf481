#include "proving_ground.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>
#include <stdexcept>

namespace safety {
namespace {

namespace fs = std::filesystem;
using Random = std::mt19937_64;

constexpr double kTrapShare = 0.06;

// Half of the drawn sites' ground is weak, so that routes must avoid the weak areas.
constexpr const char* kDrawnSoils = R"(terrain_classes:
  1: dry_sand
  2: bedrock
  3: {name: trap, cohesion_Pa: 0, friction_angle_deg: 24, sinkage_exponent: 1.0, cohesive_modulus: 1400,
      frictional_modulus: 300000, shear_modulus_mm: 15}
  4: {name: firm, cohesion_Pa: {mean: 2000, std: 600}, friction_angle_deg: {mean: 30, std: 3}, sinkage_exponent: 0.9,
      cohesive_modulus: 5000, frictional_modulus: 1500000, shear_modulus_mm: 18}
)";

constexpr const char* kTruth = R"(random: {spread: 0.1, patches: 8, patch_radius_m: 2.5, patch_soil: trap}
soils:
  - {name: trap, cohesion_kPa: 0, friction_angle_deg: 24, sinkage_exponent: 1, cohesive_modulus: 1400,
     frictional_modulus: 300000, shear_modulus_mm: 15}
)";

constexpr const char* kRealMaps[] = {"mars_gale_hirise_1m.tif", "moon_lola_npc_2km_5m.tif",
                                     "mars_ctx_gale_square_20m.tif", "earth_uma_rescue_area_1m.tif",
                                     "earth_erc_marsyard2021_9cm.tif"};

double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

template <typename T>
const T& any(Random& random, const std::vector<T>& of) {
  return of[static_cast<std::size_t>(random() % of.size())];
}

void write(const fs::path& path, const std::string& text) {
  std::ofstream(path) << text;
}

std::string text(double value) {
  std::ostringstream out;
  out.precision(9);
  out << value;
  return out.str();
}

std::string text(Place p) {
  return text(p.x_m) + "," + text(p.y_m);
}

// Draws waves and a hill, with holes in the data. Classes form stripes and patches whose edges cross cells.
void draw(Random& random, const fs::path& folder) {
  const int side = 64;
  const double cell_m = any(random, std::vector{0.3, 0.5, 1.0});
  Raster heights{.width = side, .height = side, .cell_m = cell_m, .values = {}}, classes = heights;
  const double steep = uniform(random, 0.05, 0.3), wave_m = uniform(random, 8.0, 25.0) * cell_m / 0.5;
  const double turn = uniform(random, 0.0, 3.14), hole_x = uniform(random, 10, 54),
               hole_y = uniform(random, 10, 54);
  std::vector<Place> traps;
  for (int k = 0; k < 14; ++k) traps.push_back({uniform(random, 0, side), uniform(random, 0, side)});
  const double radius = std::sqrt(kTrapShare * side * side / 14 * 3);
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column) {
      const double x = column * cell_m, y = row * cell_m;
      const double u = x * std::cos(turn) + y * std::sin(turn), v = y * std::cos(turn) - x * std::sin(turn);
      const bool hole = std::hypot(column - hole_x, row - hole_y) < 4.0;
      const double k = 6.283 / wave_m;
      heights.values.push_back(hole ? std::numeric_limits<double>::quiet_NaN()
                                    : steep / k * std::sin(k * u) + 0.5 * steep / k * std::cos(1.7 * k * v));
      int number = static_cast<int>(std::floor((column + 2 * row) / 24.0)) % 2 == 0 ? 1 : 4;
      if (std::hypot(column - 32, row - 32) < 7) number = 2;
      for (const Place& trap : traps)
        if (std::hypot(column - trap.x_m, row - trap.y_m) < radius) number = 3;
      classes.values.push_back(number);
    }
  writeAscii(heights, folder / "site.asc");
  writeAscii(classes, folder / "classes.asc");
  write(folder / "soils.yaml", kDrawnSoils);
}

// Cuts a square from a real map, in local coordinates, and draws its classes.
void cut(Random& random, const Places& places, const fs::path& folder) {
  const std::string file = kRealMaps[random() % std::size(kRealMaps)];
  const Raster whole = readRaster(places.maps + "/" + file);
  const int side = std::min({80, whole.width, whole.height});
  const Cell corner{static_cast<int>(random() % static_cast<std::uint64_t>(whole.width - side + 1)),
                    static_cast<int>(random() % static_cast<std::uint64_t>(whole.height - side + 1))};
  const Raster heights = part(whole, corner, side, side);
  Raster classes = heights;
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column)
      classes.values[static_cast<std::size_t>(row * side + column)] =
          1 + (std::sin(column / 7.0) + std::cos(row / 9.0) > 0.9 ? 2 : 0);
  writeAscii(heights, folder / "site.asc");
  writeAscii(classes, folder / "classes.asc");
  write(folder / "soils.yaml", "terrain_classes:\n  1: mars_crusty\n  3: mars_drift\n");
}

// Adds three triangular keep-out areas in map coordinates.
void fence(Random& random, ProvingGround& ground) {
  const double side_m = ground.site.elevation_m.cell_m * ground.site.elevation_m.width;
  std::string features;
  for (int k = 0; k < 3; ++k) {
    const Place p{ground.site.elevation_m.west_m + uniform(random, 0.2, 0.8) * side_m,
                  ground.site.elevation_m.south_m + uniform(random, 0.2, 0.8) * side_m};
    Polygon ring;
    for (const double angle : {0.3, 2.4, 4.5}) {
      const double reach_m = uniform(random, 0.02, 0.08) * side_m;
      ring.push_back({p.x_m + reach_m * std::cos(angle), p.y_m + reach_m * std::sin(angle)});
    }
    ring.push_back(ring.front());
    std::string positions;
    for (const Place& corner : ring) positions += (positions.empty() ? "[" : ",[") + text(corner) + "]";
    features += (k ? "," : "") +
                std::string(R"({"type":"Feature","properties":{},"geometry":{"type":"Polygon",)") +
                "\"coordinates\":[[" + positions + "]]}}";
    ground.site.keep_out.push_back(ring);
  }
  write(ground.folder / "keep_out.geojson",
        R"({"type":"FeatureCollection","crs":"local","features":[)" + features + "]}");
}

std::string demWords(const ProvingGround& ground) {
  return ground.kind >= SiteKind::Drawn
             ? "site.asc --ignore-crs --resolution " + text(ground.site.elevation_m.cell_m)
             : "site.tif";
}

std::string soilWords(const ProvingGround& ground) {
  const bool drawn = ground.kind >= SiteKind::Drawn;
  return std::string(" --terrain ") +
         (drawn ? "classes.asc --soils soils.yaml" : "site_classes.tif --soils site_soils.yaml") +
         " --rover " + ground.rover + (ground.site.keep_out.empty() ? "" : " --keep-out keep_out.geojson");
}

void require(int code, const ProvingGround& ground, const char* what) {
  if (code != 0)
    throw std::runtime_error("site " + std::to_string(ground.number) + ": " + what + " failed, see " +
                             (ground.folder / "log.txt").string());
}

Place somewhere(const ProvingGround& ground, Random& random) {
  const Raster& z = ground.site.elevation_m;
  for (int attempt = 0;; ++attempt) {
    const Place p{z.west_m + uniform(random, 0.06, 0.94) * z.width * z.cell_m,
                  z.south_m + uniform(random, 0.06, 0.94) * z.height * z.cell_m};
    if (attempt > 100 || (ground.site.classAt(p) && !ground.site.keptOut(p))) return p;
  }
}

// Updates the map with the telemetry of two drives across the site. A drive that cannot start is skipped.
void teach(const Places& places, ProvingGround& ground, Random& random) {
  write(ground.folder / "truth.yaml", kTruth);
  for (int drive = 0; drive < 2; ++drive) {
    const std::string seed = std::to_string(1000 * ground.number + static_cast<std::uint64_t>(drive));
    const Call go{"drive " + demWords(ground) + soilWords(ground) + " --truth truth.yaml --start " +
                  text(somewhere(ground, random)) + " --goal " + text(somewhere(ground, random)) +
                  " --telemetry drive.csv --seed " + seed};
    fs::remove(ground.folder / "drive.csv");
    go.run(places, ground.folder);
    if (!fs::exists(ground.folder / "drive.csv")) continue;
    const Call learn{"update map.ot drive.csv -o next.ot --journal evidence.db"};
    if (learn.run(places, ground.folder) != 0) continue;
    fs::rename(ground.folder / "next.ot", ground.folder / "map.ot");
    ground.learned = true;
  }
  if (fs::exists(ground.folder / "evidence.db")) ground.journal = readJournal(ground.folder / "evidence.db");
}

void choosePairs(const Places& places, ProvingGround& ground, Random& random) {
  constexpr int kDraws = 16;
  for (std::size_t pair = 0; pair < kPairs; ++pair)
    for (int draw = 1; draw <= kDraws; ++draw) {
      const Place start = somewhere(ground, random), goal = somewhere(ground, random);
      Call first = planCall(ground, {start, goal, "field"}, "first.geojson");
      first.words += " --no-proof";
      if (draw < kDraws && first.run(places, ground.folder) != 0) continue;
      ground.pairs.emplace_back(start, goal);
      break;
    }
}

}  // namespace

const char* name(SiteKind kind) {
  constexpr const char* kNames[] = {"rocks", "dunes", "craters", "drawn", "real"};
  return kNames[static_cast<int>(kind)];
}

const std::vector<std::string>& planners() {
  static const std::vector<std::string> names{"field",   "hybrid",   "RRTstar", "InformedRRTstar",
                                              "BITstar", "ABITstar", "SST",     "FMT"};
  return names;
}

int Call::run(const Places& places, const fs::path& folder) const {
  const std::string command =
      "cd '" + folder.string() + "' && '" + places.program + "' " + words + " >>log.txt 2>&1";
  const int status = std::system(command.c_str());
  return status < 0 || (status & 0x7f) != 0 ? 128 : (status >> 8) & 0xff;
}

ProvingGround provingGround(const Places& places, std::uint64_t number) {
  Random random(7919 * number + 1);
  ProvingGround ground{.number = number, .folder = places.folder / ("site" + std::to_string(number))};
  ground.kind = static_cast<SiteKind>(number % (places.maps.empty() ? 4 : 5));
  ground.rover = ground.kind == SiteKind::Craters
                     ? "lunar_micro"
                     : any(random, std::vector<std::string>{"mer", "sojourner", "fido"});
  fs::remove_all(ground.folder);
  fs::create_directories(ground.folder);
  std::string classes = "classes.asc", soils = "soils.yaml", dem = "site.asc";
  if (ground.kind == SiteKind::Drawn) {
    draw(random, ground.folder);
  } else if (ground.kind == SiteKind::Real) {
    cut(random, places, ground.folder);
  } else {
    const std::string resolution = any(random, std::vector<std::string>{"0.25", "0.5", "1"});
    const Call make{"generate " + std::string(name(ground.kind)) + " --size 64 --resolution " + resolution +
                    " --seed " + std::to_string(number + 1) + " -o site.tif"};
    require(make.run(places, ground.folder), ground, "generate");
    classes = "site_classes.tif", soils = "site_soils.yaml", dem = "site.tif";
  }
  const Library library{places.library};
  ground.site.rover = library.rover(ground.rover);
  ground.site.elevation_m = readRaster(ground.folder / dem);
  ground.site.classes = readRaster(ground.folder / classes);
  for (const auto& [class_number, prior] : library.classes(ground.folder / soils))
    ground.site.kinds[class_number] = groundKind(prior, ground.site.rover);
  if (number % 3 == 1) fence(random, ground);
  const Call build{"costmap " + demWords(ground) + soilWords(ground) + " -o map.ot"};
  require(build.run(places, ground.folder), ground, "costmap");
  if (number % 4 != 0) teach(places, ground, random);
  choosePairs(places, ground, random);
  return ground;
}

Errand errand(const ProvingGround& ground, std::uint64_t k) {
  const auto count = static_cast<std::uint64_t>(planners().size());
  const auto& [start, goal] = ground.pairs[static_cast<std::size_t>(k / count) % ground.pairs.size()];
  return {start, goal, planners()[k % count]};
}

Call planCall(const ProvingGround& ground, const Errand& errand, const std::string& output) {
  return {"plan " + demWords(ground) + " --map map.ot --start " + text(errand.start) + " --goal " +
          text(errand.goal) + " --planner " + errand.planner +
          (errand.planner == "field" ? "" : " --no-proof --time 0.25") + " --seed " +
          std::to_string(ground.number + 1) + " -o " + output};
}

}  // namespace safety
