#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <cpl_string.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <talus/common/common.hpp>

namespace talus::maps {

/// A separate folder for each test, removed at its end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "talus-maps-XXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }

  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

  std::string write(const std::string& name, const std::string& content) const {
    std::ofstream(path_ / name, std::ios::binary) << content;
    return *this / name;
  }

 private:
  std::filesystem::path path_;
};

/// Suppresses GDAL's messages.
struct GdalQuiet {
  GdalQuiet() { CPLPushErrorHandler(CPLQuietErrorHandler); }
  GdalQuiet(const GdalQuiet&) = delete;
  GdalQuiet& operator=(const GdalQuiet&) = delete;
  ~GdalQuiet() { CPLPopErrorHandler(); }
};

/// A small raster file. Rows run from north to south, as drawn.
struct RasterFile {
  std::vector<std::vector<double>> rows{};  ///< values of band 1
  std::string driver = "GTiff";
  std::string crs = "EPSG:32610";  ///< empty: none
  std::optional<std::array<double, 6>> transform = std::array<double, 6>{500000, 10, 0, 5000000, 0, -10};
  GDALDataType type = GDT_Float32;
  std::optional<double> nodata{};
  double scale = 1.0;
  double offset = 0.0;
  std::string unit{};
  std::vector<std::string> names{};  ///< one for each band; band n is band 1 plus 1000 (n - 1)
};

inline std::string write(const RasterFile& file, const std::string& path) {
  GDALAllRegister();
  const GdalQuiet quiet;
  const int width = static_cast<int>(file.rows.front().size());
  const int height = static_cast<int>(file.rows.size());
  const int bands = std::max(1, static_cast<int>(file.names.size()));
  GDALDriver* memory = GetGDALDriverManager()->GetDriverByName("MEM");
  const std::unique_ptr<GDALDataset> draft(memory->Create("", width, height, bands, file.type, nullptr));
  if (file.transform) draft->SetGeoTransform(const_cast<double*>(file.transform->data()));
  if (!file.crs.empty()) {
    OGRSpatialReference crs;
    crs.SetFromUserInput(file.crs.c_str());
    crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    draft->SetSpatialRef(&crs);
  }
  for (int b = 1; b <= bands; ++b) {
    GDALRasterBand& band = *draft->GetRasterBand(b);
    if (!file.names.empty()) band.SetDescription(file.names[static_cast<std::size_t>(b - 1)].c_str());
    if (file.nodata) band.SetNoDataValue(*file.nodata);
    if (file.scale != 1.0) band.SetScale(file.scale);
    if (file.offset != 0.0) band.SetOffset(file.offset);
    if (!file.unit.empty()) band.SetUnitType(file.unit.c_str());
    for (int row = 0; row < height; ++row) {
      std::vector<double> values = file.rows[static_cast<std::size_t>(row)];
      for (double& v : values) v += 1000.0 * (b - 1);
      EXPECT_EQ(
          band.RasterIO(GF_Write, 0, row, width, 1, values.data(), width, 1, GDT_Float64, 0, 0, nullptr),
          CE_None);
    }
  }
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName(file.driver.c_str());
  const std::unique_ptr<GDALDataset> written(
      driver->CreateCopy(path.c_str(), draft.get(), FALSE, nullptr, nullptr, nullptr));
  EXPECT_TRUE(written) << CPLGetLastErrorMsg();
  return path;
}

/// Heights from a drawing: a digit is that many metres, '.' is no data (-1).
inline std::vector<std::vector<double>> drawn(const std::vector<std::string>& lines) {
  std::vector<std::vector<double>> rows{};
  for (const std::string& line : lines) {
    rows.emplace_back();
    for (char c : line) rows.back().push_back(c == '.' ? -1.0 : c - '0');
  }
  return rows;
}

/// A hill of 4 x 5 cells with one hole.
inline const std::vector<std::vector<double>> kHill = drawn({"1234",  //
                                                             "2345",  //
                                                             "345.",  //
                                                             "4567",  //
                                                             "5678"});

/// The message of the InputError that a call throws, or a description of another outcome.
template <typename Call>
std::string refusal(const Call& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  } catch (const std::exception& error) {
    return std::string("another error: ") + error.what();
  }
  return "accepted";
}

}  // namespace talus::maps
