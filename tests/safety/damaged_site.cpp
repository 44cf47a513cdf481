#include "damaged_site.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <tuple>

#include <gdal.h>
#include <nlohmann/json.hpp>

namespace safety {
namespace {

namespace fs = std::filesystem;

// Numbers of the sites that have keep-out areas and drives.
std::uint64_t siteNumber(std::uint64_t n) {
  constexpr std::uint64_t kOfTwelve[] = {1, 7, 10};
  return 12 * (n / 3) + kOfTwelve[n % 3];
}

std::string content(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void write(const fs::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

void convert(const fs::path& from, const fs::path& to, const char* driver, const char* option = nullptr) {
  const GDALDatasetH source = GDALOpen(from.c_str(), GA_ReadOnly);
  const char* options[] = {option, nullptr};
  const GDALDatasetH made = GDALCreateCopy(GDALGetDriverByName(driver), to.c_str(), source, FALSE,
                                           const_cast<char**>(options), nullptr, nullptr);
  if (made == nullptr) throw std::runtime_error(to.string() + ": cannot be written");
  GDALClose(made);
  GDALClose(source);
}

// A raster of rock heights: few rocks, and dense fields of rocks.
Raster rocksOn(const Raster& elevation) {
  Raster rocks = elevation;
  for (std::size_t i = 0; i < rocks.values.size(); ++i) {
    const auto column = static_cast<double>(i % static_cast<std::size_t>(rocks.width));
    const auto row = static_cast<double>(i / static_cast<std::size_t>(rocks.width));
    rocks.values[i] = 0.05 + 0.02 * std::sin(0.9 * column + 0.3 * row) +
                      (std::sin(0.21 * column) * std::cos(0.17 * row) > 0.6 ? 0.6 : 0.0);
  }
  return rocks;
}

constexpr const char* kModel = R"(name: loose sand
soil: {name: loose, cohesion_Pa: 500, friction_angle_rad: 0.55, sinkage_exponent: 1.0, cohesive_modulus: 3000,
  frictional_modulus: 900000, shear_modulus_m: 0.02}
model: wong-reece
effects: [{name: bulldozing, parameters: [0.15]}]
)";

// Reads the vertices of a route file; the checker derives the stations of a planned line from the vertices
// alone.
std::optional<Route> lineOf(const fs::path& path) {
  const auto document = nlohmann::json::parse(content(path), nullptr, false);
  Route route;
  try {
    for (const auto& position : document.at("features").at(0).at("geometry").at("coordinates"))
      route.vertices.push_back({position.at(0).get<double>(), position.at(1).get<double>()});
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
  route.elevation_m.assign(route.vertices.size(), std::nan(""));
  route.turn_rad.assign(route.vertices.size(), 0.0);
  route.heading_rad = route.turn_rad;
  return route;
}

// First line without the prefix "talus: "; else the number of error lines if not 1 for exit code 2; else
// empty.
std::string complaintOf(const std::string& printed, int exit) {
  std::istringstream lines(printed);
  int errors = 0;
  for (std::string line; std::getline(lines, line);) {
    const bool odd = std::any_of(line.begin(), line.end(), [](char c) { return c >= 0 && c < ' '; });
    if (!line.starts_with("talus: ") || odd) return line.empty() ? "an empty line" : line;
    errors += line.starts_with("talus: warning: ") ? 0 : 1;
  }
  if (exit == 2 && errors != 1) return std::to_string(errors) + " lines of an error";
  return exit > 2 ? "exit " + std::to_string(exit) + ": " + printed : "";
}

std::string text(Place p) {
  std::ostringstream out;
  out.precision(9);
  out << p.x_m << ',' << p.y_m;
  return out.str();
}

}  // namespace

DamagedSite::DamagedSite(const Places& places, std::uint64_t number)
    : places_(places), ground_(provingGround(places, siteNumber(number))) {
  const fs::path& in = folder();
  writeAscii(ground_.site.elevation_m, in / "dem.asc");
  writeAscii(*ground_.site.classes, in / "classes.asc");
  writeAscii(rocksOn(ground_.site.elevation_m), in / "rocks.asc");
  convert(in / "dem.asc", in / "dem.img", "ENVI");
  convert(in / "dem.asc", in / "dem.tif", "GTiff");
  convert(in / "dem.asc", in / "dem_deflate.tif", "GTiff", "COMPRESS=DEFLATE");
  convert(in / "dem.asc", in / "dem.nc", "netCDF");
  convert(in / "classes.asc", in / "classes.img", "ENVI");
  convert(in / "rocks.asc", in / "rocks.img", "ENVI");
  write(in / "model.yaml", kModel);
  for (const char* old : {"evidence.db", "evidence.db-wal", "evidence.db-shm", "learned.ot"})
    fs::remove(in / old);
  writeUnseen();
  std::string complaint;
  for (const auto& [dem, classes, map] : {std::tuple{"dem.asc", "classes.asc", "base.ot"},
                                          std::tuple{"unseen.asc", "unseen_classes.asc", "unseen.ot"}})
    if (call("costmap " + ground(dem, classes) + " -o " + map, complaint) != 0)
      throw std::runtime_error(in.string() + ": no map: " + complaint);
  if (!fs::exists(in / "drive.csv") ||
      call("update base.ot drive.csv -o learned.ot --journal evidence.db", complaint) != 0) {
    fs::remove(in / "drive.csv");
    fs::copy_file(in / "base.ot", in / "learned.ot");
  }
  prior_ = std::make_unique<Belief>(ground_.site, none_);
  learned_ = std::make_unique<Belief>(
      ground_.site, fs::exists(in / "evidence.db") ? readJournal(in / "evidence.db") : none_);
  fs::remove(in / "route.geojson");
  call("plan " + ground("dem.asc", "classes.asc") + errand(0) + " -o route.geojson", complaint);
}

// Writes a map without data in its middle, and the heights and classes of that window, rows from south to
// north.
void DamagedSite::writeUnseen() {
  Raster heights = ground_.site.elevation_m, classes = *ground_.site.classes;
  const Cell corner{heights.width / 8, heights.height / 8};
  const int width = heights.width - 2 * corner.column, height = heights.height - 2 * corner.row;
  std::string numbers, bytes;
  for (int row = corner.row; row < corner.row + height; ++row)
    for (int column = corner.column; column < corner.column + width; ++column) {
      const auto at = static_cast<std::size_t>(row) * static_cast<std::size_t>(heights.width) +
                      static_cast<std::size_t>(column);
      const auto z = static_cast<float>(heights.values[at]);
      const double of = classes.values[at];
      numbers.append(reinterpret_cast<const char*>(&z), sizeof z);
      bytes += static_cast<char>(std::isnan(of) ? 255 : static_cast<unsigned char>(of));
      heights.values[at] = classes.values[at] = std::nan("");
    }
  writeAscii(heights, folder() / "unseen.asc");
  writeAscii(classes, folder() / "unseen_classes.asc");
  write(folder() / "patch.f32", numbers);
  write(folder() / "patch.u8", bytes);
  std::ostringstream window;
  window.precision(17);
  window << heights.west_m + corner.column * heights.cell_m << ' '
         << heights.south_m + corner.row * heights.cell_m << ' ' << width << ' ' << height << ' '
         << heights.cell_m;
  window_ = window.str();
}

std::string DamagedSite::whole(const std::string& file) const {
  return content(folder() / file);
}

std::string DamagedSite::ground(const std::string& dem, const std::string& classes,
                                const std::string& areas) const {
  std::ostringstream words;
  words.precision(9);
  words << dem << " --ignore-crs --resolution " << ground_.site.elevation_m.cell_m << " --terrain " << classes
        << " --soils " << (ground_.kind >= SiteKind::Drawn ? "soils.yaml" : "site_soils.yaml") << " --rover "
        << ground_.rover << " --keep-out " << areas;
  return words.str();
}

std::string DamagedSite::errand(std::size_t pair) const {
  const auto& [start, goal] = ground_.pairs[pair];
  return " --start " + text(start) + " --goal " + text(goal);
}

int DamagedSite::call(const std::string& words, std::string& complaint) const {
  return run("'" + places_.program + "' " + words, complaint);
}

int DamagedSite::run(const std::string& words, std::string& complaint) const {
  const std::string command = "cd '" + folder().string() + "' && " + words + " >out.txt 2>err.txt";
  const int status = std::system(command.c_str());
  const int exit = status < 0 || (status & 0x7f) != 0 ? 128 : (status >> 8) & 0xff;
  if (const std::string printed = complaintOf(content(folder() / "err.txt"), exit); complaint.empty())
    complaint = printed;
  return exit;
}

// Adds each cause that all beliefs report for the route. A cause that depends on a lost row of the journal
// is not reported, nor a cause that only the undamaged file shows.
void DamagedSite::judgeOn(const std::string& file, const std::vector<const Belief*>& beliefs,
                          DamageResult& result) const {
  const auto route = lineOf(folder() / file);
  if (!route || route->vertices.empty()) {
    result.causes.emplace_back("no line");
    return;
  }
  std::map<std::string, std::size_t> charged;
  for (const Belief* belief : beliefs)
    for (const Violation& violation : Judge(ground_.site, *belief).judge(*route)) ++charged[violation.cause];
  for (const auto& [cause, times] : charged)
    if (times == beliefs.size()) result.causes.push_back(cause);
}

void DamagedSite::scoreWhole(const std::string& more, const std::string& path, DamageResult& result) const {
  std::ostringstream words;
  words.precision(9);
  words << "score dem.asc --ignore-crs --resolution " << ground_.site.elevation_m.cell_m << more << " --path "
        << path;
  if (call(words.str(), result.complaint) != 0) result.causes.emplace_back("refused on the whole file");
}

void DamagedSite::plan(const std::string& file, std::size_t pair, DamageResult& result) const {
  std::ostringstream local;
  local.precision(9);
  local << "dem.asc --ignore-crs --resolution " << ground_.site.elevation_m.cell_m << " --rover "
        << ground_.rover;
  const std::string rocks = " --terrain classes.asc --soils " +
                            std::string(ground_.kind >= SiteKind::Drawn ? "soils.yaml" : "site_soils.yaml") +
                            " --rocks ";
  const auto part = [&](const std::string& name, const std::string& usual) {
    return file.starts_with(name) ? "damaged/" + file : usual;
  };
  std::string words =
      ground(part("dem", "dem.asc"), part("classes", "classes.asc"), part("keep_out", "keep_out.geojson"));
  if (file == "model.yaml") words = local.str() + " --model damaged/model.yaml";
  if (file == "rocks.img") words = local.str() + rocks + "damaged/rocks.img";
  result.exit = call("plan " + words + errand(pair) + " -o damaged/route.geojson", result.complaint);
  if (result.exit != 0) return;
  const std::string rover = " --rover " + ground_.rover;
  if (file == "model.yaml")
    scoreWhole(rover + " --model model.yaml", "damaged/route.geojson", result);
  else if (file == "rocks.img")
    scoreWhole(rover + rocks + "rocks.img", "damaged/route.geojson", result);
  else
    judgeOn("damaged/route.geojson", {prior_.get()}, result);
}

// Damaged telemetry or a damaged journal is used to update the base map; a damaged map is planned on
// directly.
void DamagedSite::planLearned(const std::string& file, std::size_t pair, DamageResult& result) const {
  std::string map = "damaged/learned.ot";
  if (file != "learned.ot") {
    const bool drive = file == "drive.csv";
    result.exit = call("update base.ot " + std::string(drive ? "damaged/drive.csv" : "drive.csv") +
                           " -o damaged/next.ot --journal damaged/evidence.db",
                       result.complaint);
    if (result.exit != 0) return;
    map = "damaged/next.ot";
  }
  result.exit = call("plan dem.asc --ignore-crs --map " + map + errand(pair) + " -o damaged/route.geojson",
                     result.complaint);
  if (result.exit != 0) return;
  judgeOn("damaged/route.geojson", {prior_.get(), learned_.get()}, result);
}

void DamagedSite::score(const std::string& file, DamageResult& result) const {
  result.exit =
      call("score " + ground("dem.asc", "classes.asc") + " --path damaged/" + file, result.complaint);
  if (result.exit == 0) judgeOn("damaged/" + file, {prior_.get()}, result);
}

// A C program opens the map without data in its middle and patches both arrays into the map.
void DamagedSite::patch(const std::string& file, std::size_t pair, DamageResult& result) const {
  const auto part = [&](const std::string& name) { return (file == name ? "damaged/" : "") + name; };
  const auto& [start, goal] = ground_.pairs[pair];
  std::ostringstream words;
  words.precision(9);
  words << "'" SAFETY_PATCH_ROUTE "' unseen.ot " << part("patch.f32") << ' ' << part("patch.u8") << ' '
        << window_ << ' ' << start.x_m << ' ' << start.y_m << ' ' << goal.x_m << ' ' << goal.y_m
        << " damaged/route.geojson";
  result.exit = run(words.str(), result.complaint);
  if (result.exit == 0) judgeOn("damaged/route.geojson", {prior_.get()}, result);
}

DamageResult DamagedSite::tried(const std::string& file, const std::string& bytes, std::size_t pair) {
  DamageResult result;
  result.file = file;
  const fs::path damaged = folder() / "damaged";
  fs::remove_all(damaged);
  fs::create_directory(damaged);
  if (file.ends_with(".img")) {
    const std::string header = file.substr(0, file.size() - 4) + ".hdr";
    fs::copy_file(folder() / header, damaged / header);
  }
  write(damaged / file, bytes);
  if (file == "route.geojson")
    score(file, result);
  else if (file.starts_with("patch."))
    patch(file, pair, result);
  else if (file == "drive.csv" || file == "evidence.db" || file == "learned.ot")
    planLearned(file, pair, result);
  else
    plan(file, pair, result);
  // Heights of the route come from the damaged file, so that the cause "height" does not count.
  std::erase(result.causes, "height");
  return result;
}

}  // namespace safety
