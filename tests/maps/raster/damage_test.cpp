// Damage by a grammar: every statement of a file and of those beside it is taken out, set to 0 or to another value, or has
// a bit turned or a byte inserted. Judged by the ground itself, which the reader does not know.
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <regex>

#include <talus/common/common.hpp>
#include <talus/maps/maps_io.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>

#include "raster_fixture.hpp"

namespace talus::maps {
namespace damage_test {

namespace fs = std::filesystem;

constexpr int kWidth = 24, kHeight = 18;
constexpr double kCell_m = 10.0, kWest_m = 500000.0, kNorth_m = 5000000.0;

// Height [m] at metres east of and south of the north-west corner; NaN in the void.
double heightAt(double east_m, double south_m) {
  const double column = east_m / kCell_m, row = south_m / kCell_m;
  if (column > 9 && column < 14 && row > 6 && row < 11) return std::nan("");
  return 1500.0 + 0.31 * east_m - 0.17 * south_m + 3.0 * std::sin(0.4 * column) * std::cos(0.3 * row);
}

// A way to write the ground.
struct Dialect {
  const char* ending;
  RasterFile file;
  double scale = 1.0, offset = 0.0;  // of the numbers
  double step_m = 0.01;              // of the stored heights
  const char* side = "";             // mask or auxiliary
};

std::vector<Dialect> dialects() {
  RasterFile plain{.type = GDT_Float32, .nodata = -9999.0};
  const auto as = [&](const char* driver) {
    RasterFile file = plain;
    file.driver = driver;
    return file;
  };
  const auto local = [&](const char* driver) {
    RasterFile file = as(driver);
    file.crs.clear();
    return file;
  };
  RasterFile scaled = plain, feet = plain, masked = plain, netcdf = as("netCDF"), undeclared = plain;
  scaled.type = GDT_Int16, scaled.nodata = -32768.0, scaled.scale = 0.01, scaled.offset = 1500.0;
  feet.unit = "ft";
  masked.nodata.reset();
  undeclared.nodata.reset();
  RasterFile kilometres = local("PDS3");
  kilometres.unit = "KILOMETER", kilometres.nodata = -32768.0;
  return {{"a.tif", plain},         {"b.tif", scaled, 0.01, 1500.0, 0.01},
          {"c.tif", feet, 0.3048},  {"d.tif", masked, 1.0, 0.0, 0.01, ".msk"},
          {"e.tif", undeclared},    {"f.img", as("ENVI")},
          {"g.bil", as("EHdr")},    {"h.asc", as("AAIGrid"), 1.0, 0.0, 0.1},
          {"i.xml", local("PDS4")}, {"j.cub", local("ISIS3")},
          {"k.nc", netcdf},         {"l.tif", plain, 1.0, 0.0, 0.01, ".aux.xml"},
          {"m.xyz", local("XYZ")},  {"n.lbl", kilometres, 1000.0},
          {"o.vic", local("VICAR")}};
}

// The bytes of a file of PDS3: its label and its numbers, in an equirectangular projection of the Moon where the file has a
// CRS, else without a place.
std::string pds3(const RasterFile& file) {
  const std::size_t width = file.rows.front().size(), height = file.rows.size(),
                    records = (1200 + 4 * width) / (4 * width);
  const auto line = [](const char* key, const std::string& value) {
    return std::string(key) + " = " + value + "\r\n";
  };
  const auto count = [](std::size_t n) { return std::to_string(n); };
  const auto& c = *file.transform;
  std::string text = line("PDS_VERSION_ID", "PDS3") + line("RECORD_TYPE", "FIXED_LENGTH") +
                     line("RECORD_BYTES", count(4 * width)) + line("FILE_RECORDS", count(records + height)) +
                     line("LABEL_RECORDS", count(records)) + line("^IMAGE", count(records + 1)) +
                     line("OBJECT", "IMAGE") + line("LINES", count(height)) +
                     line("LINE_SAMPLES", count(width)) + line("SAMPLE_TYPE", "PC_REAL") +
                     line("SAMPLE_BITS", "32") + line("UNIT", file.unit) +
                     line("MISSING_CONSTANT", "-32768.0") + line("END_OBJECT", "IMAGE");
  if (!file.crs.empty())
    text += line("OBJECT", "IMAGE_MAP_PROJECTION") + line("MAP_PROJECTION_TYPE", "\"EQUIRECTANGULAR\"") +
            line("A_AXIS_RADIUS", "1737.4 <KM>") + line("B_AXIS_RADIUS", "1737.4 <KM>") +
            line("C_AXIS_RADIUS", "1737.4 <KM>") + line("CENTER_LATITUDE", "0.0 <DEG>") +
            line("CENTER_LONGITUDE", "0.0 <DEG>") + line("TARGET_NAME", "MOON") +
            line("MAP_SCALE", std::to_string(c[1]) + " <METERS/PIXEL>") +
            line("MAP_RESOLUTION", std::to_string(1737400.0 * kDegree / c[1]) + " <PIXEL/DEG>") +
            line("SAMPLE_PROJECTION_OFFSET", std::to_string(-0.5 - c[0] / c[1])) +
            line("LINE_PROJECTION_OFFSET", std::to_string(-0.5 - c[3] / c[5])) +
            line("END_OBJECT", "IMAGE_MAP_PROJECTION");
  text += "END\r\n";
  text.resize(records * 4 * width, ' ');
  for (const auto& row : file.rows)
    for (const double each : row) {
      const auto value = static_cast<float>(each);
      text.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
  return text;
}

// Writes the ground into an empty folder; returns the path of the file to read.
std::string written(const Dialect& dialect, const TemporaryFolder& folder) {
  RasterFile file = dialect.file;
  file.transform = std::array<double, 6>{kWest_m, kCell_m, 0, kNorth_m, 0, -kCell_m};
  std::vector<std::vector<double>> seen;
  for (int row = 0; row < kHeight; ++row) {
    file.rows.emplace_back();
    for (int column = 0; column < kWidth; ++column) {
      const double z = heightAt((column + 0.5) * kCell_m, (row + 0.5) * kCell_m);
      file.rows.back().push_back(std::isnan(z) ? file.nodata.value_or(-9999.0)
                                               : (z - dialect.offset) / dialect.scale);
    }
  }
  if (file.driver == "PDS3") return folder.write(dialect.ending, pds3(file));
  const std::string path = write(file, folder / dialect.ending);
  if (dialect.side == std::string(".aux.xml"))
    folder.write("l.tif.aux.xml",
                 "<PAMDataset>\n  <PAMRasterBand band=\"1\">\n    <NoDataValue>-9999</NoDataValue>\n"
                 "    <UnitType>m</UnitType>\n  </PAMRasterBand>\n</PAMDataset>\n");
  if (dialect.side == std::string(".msk")) {
    const GDALDatasetUniquePtr raster(GDALDataset::Open(path.c_str(), GDAL_OF_UPDATE));
    EXPECT_EQ(raster->CreateMaskBand(GMF_PER_DATASET), CE_None);
    for (int row = 0; row < kHeight; ++row)
      for (int column = 0; column < kWidth; ++column) {
        unsigned char known = std::isnan(heightAt((column + 0.5) * kCell_m, (row + 0.5) * kCell_m)) ? 0 : 255;
        EXPECT_EQ(raster->GetRasterBand(1)->GetMaskBand()->RasterIO(GF_Write, column, row, 1, 1, &known, 1, 1,
                                                                    GDT_Byte, 0, 0, nullptr),
                  CE_None);
      }
  }
  return path;
}

ReadOptions optionsOf(const Dialect& dialect) {
  ReadOptions options{.keep_holes = true};
  if (dialect.file.crs.empty()) options.resolution_m = kCell_m;
  return options;
}

// A statement of a file, and the bytes of its value.
struct Statement {
  std::string name;
  std::size_t begin, end, value, value_end;
  bool tag = false;
};

std::uint32_t word(const std::string& bytes, std::size_t at, std::size_t count = 4) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < count && at + i < bytes.size(); ++i)
    value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  return value;
}

// Tags of a TIFF; lines "key = value" or elements of XML of a text; else the words at the beginning.
std::vector<Statement> statementsOf(const std::string& bytes) {
  std::vector<Statement> found;
  if (bytes.starts_with(std::string("II*\0", 4))) {
    constexpr std::size_t kSizes[] = {0, 1, 1, 2, 4, 8, 1, 1, 2, 4, 8, 4, 8};
    for (std::size_t at = word(bytes, 4); at != 0 && at + 2 < bytes.size();) {
      const std::size_t count = word(bytes, at, 2);
      for (std::size_t i = 0; i < count; ++i) {
        const std::size_t entry = at + 2 + 12 * i;
        const std::size_t size = kSizes[word(bytes, entry + 2, 2) % 13] * word(bytes, entry + 4);
        const std::size_t value = size > 4 ? word(bytes, entry + 8) : entry + 8;
        found.push_back({std::to_string(word(bytes, entry, 2)), entry, entry + 12, value,
                         std::min(bytes.size(), value + std::max<std::size_t>(size, 1)), true});
      }
      at = word(bytes, at + 2 + 12 * count);
    }
    return found;
  }
  const bool text = std::ranges::all_of(
      bytes.substr(0, 64), [](unsigned char c) { return c >= 0x20 ? c < 0x7F : std::isspace(c) != 0; });
  if (!text && !bytes.starts_with("CDF")) return found;
  static const std::regex kText(
      R"(([A-Za-z^_][\w:^ ]*?(?= *=)|[A-Za-z^_][\w:^]*)( *= *| +|[^<>]*>)([ -;=?-~]+)(\r?\n|</))");
  const std::string head = bytes.substr(0, 4000);
  for (std::sregex_iterator at(head.begin(), head.end(), kText), end; at != end; ++at) {
    const auto begin = static_cast<std::size_t>(at->position(0)),
               value = static_cast<std::size_t>(at->position(3));
    found.push_back({at->str(1), begin, begin + at->str(0).size(), value, value + at->str(3).size()});
  }
  for (std::size_t at = 0; bytes.starts_with("CDF") && at + 4 <= head.size() && at < 400; at += 4)
    found.push_back({"word", at, at + 4, at, at + 4});
  return found;
}

constexpr const char* kWays[] = {"absent", "0", "other", "bit", "byte"};

std::string damaged(std::string bytes, const Statement& s, std::size_t way, std::mt19937& random) {
  const auto any = [&](std::size_t below) { return random() % std::max<std::size_t>(below, 1); };
  const std::size_t size = s.value_end - s.value, at = s.value + any(size);
  if (way == 0 && s.tag) {
    // The entries behind it and the offset of the next image move up.
    const std::size_t first = s.begin - s.begin % 2;
    std::size_t directory = word(bytes, 4);
    while (directory != 0 && first >= directory + 2 + 12 * word(bytes, directory, 2))
      directory = word(bytes, directory + 2 + 12 * word(bytes, directory, 2));
    const std::size_t count = word(bytes, directory, 2), end = directory + 6 + 12 * count;
    bytes.replace(first, end - first, bytes.substr(first + 12, end - first - 12) + std::string(12, '\0'));
    bytes[directory] = static_cast<char>(count - 1);
  } else if (way == 0) {
    bytes.erase(s.begin, s.end - s.begin);
  } else if (way == 1) {
    bytes.replace(s.value, size, s.tag ? std::string(size, '\0') : "0");
  } else if (way == 2) {
    char* end = nullptr;
    const std::string text = bytes.substr(s.value, size);
    const double number = std::strtod(text.c_str(), &end);
    if (s.tag || s.name == "word")
      bytes[at] = static_cast<char>(random());
    else
      bytes.replace(s.value, size, end == text.c_str() ? "other" : std::to_string(2.0 * number + 1.0));
  } else if (way == 3) {
    bytes[at] = static_cast<char>(bytes[at] ^ (1 << any(8)));
  } else {
    bytes.insert(at, 1, static_cast<char>(random()));
  }
  return bytes;
}

// The worst fault of a map: unknown ground is safe, another height is not. Empty if there is none.
std::string faultOf(const ElevationMap& map, double step_m) {
  Grid grid = map.grid();
  if (!map.georeference) grid.south_west = {kWest_m, kNorth_m - kHeight * kCell_m};
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column) {
      const auto z = static_cast<double>(map.elevation_m[{column, row}]);
      if (std::isnan(z)) continue;
      const double east_m = grid.south_west.x_m + (column + 0.5) * grid.resolution_m - kWest_m,
                   south_m = kNorth_m - grid.south_west.y_m - (row + 0.5) * grid.resolution_m;
      const double truth_m = heightAt(east_m, south_m);
      if (std::isnan(truth_m)) return "ground in the void";
      if (std::abs(z - truth_m) > step_m + 1e-3)
        return std::to_string(z) + " m instead of " + std::to_string(truth_m) + " m";
    }
  return "";
}

TEST(Damage, WholeFilesAreReadAsTheGround) {
  for (const Dialect& dialect : dialects()) {
    const TemporaryFolder folder;
    const ElevationMap map = readElevation(written(dialect, folder), optionsOf(dialect));
    EXPECT_EQ(faultOf(map, dialect.step_m), "") << dialect.ending;
    EXPECT_NEAR(validFraction(map.elevation_m), 1.0 - 25.0 / (kWidth * kHeight), 1e-9) << dialect.ending;
  }
}

OGRSpatialReference crsOf(const std::string& text) {
  OGRSpatialReference crs;
  crs.SetFromUserInput(text.c_str());
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return crs;
}

// Property: one ground is the same map in every format, frame, unit and offset, within the error of cubic interpolation,
// and its void (declared or not) is ground in none.
TEST(Damage, GroundIsTheSameInEveryFrame) {
  struct Frame {
    std::string crs;
    std::array<double, 6> transform;
    std::string unit = "";
    double size_m = 1.0, raised_m = 0.0;
    std::string ending = "tif", driver = "GTiff";
    std::optional<double> nodata = std::nullopt;
    double step = 0.0;  // of the numbers, which are then of 16 bits
  };
  const std::string utm_name = "EPSG:32610", moon = "+proj=eqc +R=1737400", degrees = "EPSG:4326";
  constexpr double kTurn = 0.3;
  const std::array<double, 6> own{kWest_m, kCell_m, 0, kNorth_m, 0, -kCell_m},
      on_moon{1000, kCell_m, 0, 20000, 0, -kCell_m}, in_degrees{-123.0, 1.2e-4, 0, 45.1535, 0, -0.9e-4};
  const Frame frames[] = {
      {degrees, in_degrees},
      {"EPSG:3857", {-13692297.0, 14.0, 0, 5645700.0, 0, -14.0}},
      {utm_name, {kWest_m, kCell_m, 0, kNorth_m, 0, -0.6 * kCell_m}},
      {utm_name,
       {kWest_m + 40, 8 * std::cos(kTurn), 8 * std::sin(kTurn), kNorth_m - 50, 8 * std::sin(kTurn),
        -8 * std::cos(kTurn)}},
      {utm_name, {kWest_m, kCell_m, 0, kNorth_m - 2 * kHeight * kCell_m, 0, kCell_m}},  // rows run north
      {utm_name, own, "km", 1000.0},
      {utm_name, own, "US survey foot", 1200.0 / 3937.0},
      {utm_name, own, "", 1.0, -5000.0, "tif", "GTiff", -32768.0},
      {utm_name, own, "", 1.0, 0.0, "tif", "GTiff", -32768.0, 0.05},
      {utm_name, own, "m", 1.0, 0.0, "bil", "EHdr"},
      {utm_name, own, "", 1.0, 0.0, "img", "ENVI"},
      {utm_name, own, "", 1.0, 0.0, "asc", "AAIGrid", -32768.0},
      {utm_name, own, "", 1.0, -1500.0, "nc", "netCDF"},
      {degrees, in_degrees, "", 1.0, 0.0, "nc", "netCDF"},
      {moon, on_moon, "", 1.0, 0.0, "xml", "PDS4", -32768.0},
      {moon, on_moon, "", 1.0, 0.0, "cub", "ISIS3"},
      {moon, on_moon, "KILOMETER", 1000.0, 0.0, "lbl", "PDS3"}};
  for (const Frame& frame : frames) {
    SCOPED_TRACE(frame.crs + " " + frame.driver + " " + frame.unit);
    const bool earth = frame.crs != moon;
    const OGRSpatialReference crs = crsOf(frame.crs), ground = crsOf(earth ? utm_name : moon);
    const std::unique_ptr<OGRSpatialReference> places(ground.CloneGeogCS());
    places->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    const std::unique_ptr<OGRCoordinateTransformation> from_file(
        OGRCreateCoordinateTransformation(&crs, &ground)),
        from_place(OGRCreateCoordinateTransformation(places.get(), &ground));
    const auto truthAt = [&](OGRCoordinateTransformation& to_ground, double x, double y) {
      to_ground.Transform(1, &x, &y);
      const double east_m = x - (earth ? own : on_moon)[0], south_m = (earth ? own : on_moon)[3] - y;
      const bool inside = east_m > -50 && south_m > -50 && east_m < 300 && south_m < 250;
      return inside ? heightAt(east_m, south_m) + frame.raised_m : std::nan("");
    };
    RasterFile file{.driver = frame.driver,
                    .crs = frame.crs,
                    .transform = frame.transform,
                    .nodata = frame.nodata,
                    .unit = frame.unit};
    if (frame.step > 0.0) file.type = GDT_Int16, file.scale = frame.step, file.offset = 1500.0;
    const auto& c = frame.transform;
    for (int row = 0; row < 2 * kHeight; ++row) {
      file.rows.emplace_back();
      for (int column = 0; column < kWidth; ++column) {
        const double u = column + 0.5, v = row + 0.5;
        const double z = truthAt(*from_file, c[0] + u * c[1] + v * c[2], c[3] + u * c[4] + v * c[5]);
        file.rows.back().push_back(std::isnan(z) ? -32768.0 : (z / frame.size_m - file.offset) / file.scale);
      }
    }
    const TemporaryFolder folder;
    const std::string path = folder / ("ground." + frame.ending);
    const ElevationMap map =
        readElevation(frame.driver == "PDS3" ? folder.write("ground.lbl", pds3(file)) : write(file, path),
                      {.keep_holes = true});
    const Grid& grid = map.grid();
    double worst_m = 0.0, known = 0.0;
    for (Cell cell{}; cell.row < grid.height; ++cell.row)
      for (cell.column = 0; cell.column < grid.width; ++cell.column) {
        const auto z = static_cast<double>(map.elevation_m[cell]);
        if (std::isnan(z)) continue;
        bool rim = false;  // where cubic interpolation lacks a side
        for (int k = 0; k < 25; ++k) {
          const Cell near{cell.column + k % 5 - 2, cell.row + k / 5 - 2};
          rim = rim || !grid.contains(near) || std::isnan(map.elevation_m[near]);
        }
        const GeoPoint place = map.georeference->reverse(grid.centre(cell));
        const double truth =
            truthAt(*from_place, place.longitude_rad / kDegree, place.latitude_rad / kDegree);
        if (!rim) worst_m = std::max(worst_m, std::isnan(truth) ? 1e9 : std::abs(z - truth));
        // The height of one cell's slope.
        EXPECT_TRUE(!rim || std::isnan(truth) || std::abs(z - truth) < 3.5);
        known += 1.0;
      }
    EXPECT_LT(worst_m, 0.25);
    EXPECT_GT(known, 250.0);
  }
}

// Places, sizes of pixels, scales, offsets and units, to which a file holds no second statement: docs/limits.md.
bool isStatedLimit(const std::string& name) {
  static const std::regex kAlone(
      "42112|33550|33922|[xy]llcorner|cellsize|U[LR][XY]MAP|[XY]DIM|map info|Multiplier|Base|UNIT");
  return std::regex_match(name, kAlone);
}

// Property: a damaged file is refused, or what is read of it is the ground. The number of files is
// TALUS_DAMAGED_FILES, 300 if not set.
TEST(Damage, DamagedStatementIsRefusedOrHarmless) {
  const char* more = std::getenv("TALUS_DAMAGED_FILES");
  const int count = more ? std::atoi(more) : 300;
  std::mt19937 random(11);
  std::map<std::string, int> sums;
  const std::vector<Dialect> all = dialects();
  std::vector<std::map<std::string, std::string>> whole;  // files of each dialect
  for (const Dialect& dialect : all) {
    const TemporaryFolder folder;
    whole.emplace_back();
    for (const auto& entry : fs::directory_iterator(fs::path(written(dialect, folder)).parent_path())) {
      std::ifstream stream(entry.path(), std::ios::binary);
      whole.back()[entry.path().filename()] = {std::istreambuf_iterator<char>(stream), {}};
    }
  }
  for (int k = 0; k < count; ++k) {
    const std::size_t of = static_cast<std::size_t>(k) % all.size();
    const Dialect& dialect = all[of];
    const TemporaryFolder folder;
    for (const auto& [each, content] : whole[of]) folder.write(each, content);
    const std::string path = folder / dialect.ending;
    const auto chosen =
        std::next(whole[of].begin(), static_cast<std::ptrdiff_t>(random() % whole[of].size()));
    const fs::path file = folder / chosen->first;
    const std::string& bytes = chosen->second;
    const auto statements = statementsOf(bytes);
    const std::size_t way = random() % std::size(kWays);
    std::string name = "file";
    if (statements.empty() || (file != path && random() % 8 == 0)) {
      if (way == 0)
        fs::remove(file);
      else
        folder.write(chosen->first, bytes.substr(0, bytes.size() / 2));
    } else {
      const Statement& statement = statements[random() % statements.size()];
      name = statement.name;
      folder.write(chosen->first, damaged(bytes, statement, way, random));
    }
    testing::internal::CaptureStderr();
    std::string fault,
        outcome = refusal([&] { fault = faultOf(readElevation(path, optionsOf(dialect)), dialect.step_m); });
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_EQ(outcome.find('\n'), outcome.npos);
    const bool refused = outcome != "accepted";
    ++sums[refused               ? "refused"
           : fault.empty()       ? "right"
           : isStatedLimit(name) ? "stated limit"
                                 : "less safe"];
    if (more && !refused && !fault.empty())
      std::printf("%s %s: %s, %s\n", file.filename().c_str(), name.c_str(), kWays[way], fault.c_str());
    EXPECT_FALSE(outcome.starts_with("another error")) << outcome;
    EXPECT_TRUE(refused || fault.empty() || isStatedLimit(name))
        << "file " << k << ": " << file.filename() << ", " << name << " " << kWays[way] << ": " << fault;
  }
  for (const auto& [name, sum] : sums) RecordProperty(name, sum);
  if (more)
    for (const auto& [name, sum] : sums) std::printf("%s: %d of %d\n", name.c_str(), sum, count);
}

}  // namespace damage_test
}  // namespace talus::maps
