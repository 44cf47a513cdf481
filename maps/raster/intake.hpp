#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <talus/maps/maps.hpp>
#include <talus/maps/maps_io.hpp>

class GDALDataset;
class GDALRasterBand;

/// From the numbers of a file to a quantity with a unit.
namespace talus::maps {

/// Value of cells without data in a raster of floats: NaN.
inline constexpr float kNoValue = std::numeric_limits<float>::quiet_NaN();

/// Criteria for the choice of a band of a raster file.
struct BandCriteria {
  std::string path{};                      ///< path of the file in error messages
  std::optional<int> band{};               ///< band number from 1 that the user selected
  std::vector<std::string_view> words{};   ///< lower-case substrings of the description that select a band
  std::vector<std::string_view> others{};  ///< lower-case substrings of the description that exclude a band
};

/// Returns the number of the band that the user selected, or otherwise of the first band whose description
/// fits, or otherwise of the first band. A choice among several bands is appended to `notes`. @throws
/// InputError for a band that does not exist, or for a colour image without a selected band
int chooseBand(GDALDataset& file, const BandCriteria& wish, std::vector<std::string>& notes);

/// A rectangle of pixels; column and row of its first pixel are counted from the upper left corner of the
/// raster.
struct PixelBox {
  int column = 0;
  int row = 0;
  int width = 0;
  int height = 0;

  friend bool operator==(const PixelBox&, const PixelBox&) = default;
};

/// Returns the box of all pixels of a raster.
PixelBox wholeOf(GDALDataset& file);

/// Numbers of pixels as a file stores them, in file order, without what its mask excludes. They have no unit, and
/// marks of no data are among them: only a Quantity makes values of them.
class RawPixels {
 public:
  RawPixels() = default;
  /// Reads a box of a band. `where` names the file in error messages. @throws InputError with GDAL's message
  RawPixels(GDALDataset& raster, int band, const PixelBox& box, const std::string& where);

  const PixelBox& box() const noexcept { return box_; }

 private:
  friend class Quantity;
  PixelBox box_{};
  std::vector<float> numbers_{};
  std::size_t masked_ = 0;
};

/// A unit and its length in the unit of a quantity.
struct Unit {
  std::string_view name;  ///< lower case
  double size;
};

/// What the numbers of a band may mean, and the units in which files state it.
enum class Kind { Height_m, Rocks, Classes, Added_J_per_m };

/// The conversion of the numbers of one band to values: value = number * scale + offset, in metres, fractions, class
/// numbers or joules per metre.
class Quantity {
 public:
  /// Values that the program made itself: each number is a value, and NaN means no data.
  Quantity() = default;
  /// The conversion that a band and the files beside it state by unit, scale, offset, no-data value, special
  /// constants and valid range, and the options. Statements of the unit are that of the band, of a label of PDS3, of a
  /// vertical CRS and of Zunits in a .prj or .hdr; of heights also an offset within 1 % of the radius R of the body
  /// (metres) or of R/1000 (kilometres), from which R is subtracted. @throws InputError if the unit is not known, if
  /// two statements differ, or for a scale beyond 1e-6 to 1e6 in magnitude
  Quantity(Kind kind, GDALDataset& file, int band, const std::string& path, const ReadOptions& options = {});

  /// Looks for customary no-data values (-9999, -32768, -32767, -99999) that nothing states. Of heights, they mean no
  /// data below all other numbers of the boxes that were searched.
  void search(const RawPixels& pixels);
  /// Ends the search. Heights that are all within 1 % of the radius of the body are radii, from which R is subtracted,
  /// on cells of 12.5 m or more.
  void found();

  /// Returns the values of pixels. Numbers equal to a no-data value, outside the valid range, or beyond 1e30 in
  /// magnitude (but infinite added costs) become NaN. @throws InputError for a height beyond 131072 m in magnitude
  std::vector<float> of(RawPixels pixels);

  /// Returns how numbers become values, on one line: "heights = raw x 0.001 + 1500 m (file), no-data -32768 (found),
  /// mask 7.8 %"; a unit that nothing states is "assumed".
  std::string reading() const;

  /// Decisions that the user should know, one line each.
  std::vector<std::string> notes{};

 private:
  struct Statement {
    std::string unit, where;
  };

  std::vector<Statement> statements(GDALDataset& file, GDALRasterBand& band) const;
  double unitOf(const std::vector<Statement>& stated, double offset, double radius_m,
                const ReadOptions& options);
  void takeLabel(GDALDataset& file);
  void takeConstant(std::string key, const std::string& text);
  bool isMark(float value) const;

  struct Mark {
    float number;
    const char* how;  // file, label, --nodata, found; empty: where it is found
  };

  Kind kind_ = Kind::Height_m;
  std::string path_{}, from_{};  // unit as stated, and where
  double scale_ = 1.0, offset_ = 0.0;
  double least_ = -std::numeric_limits<double>::infinity(),
         greatest_ = std::numeric_limits<double>::infinity();
  std::vector<Mark> marks_{};
  double radius_m_ = 0.0, cell_m_ = 0.0;  // of the body and of a pixel; 0: unknown
  // Ends of the numbers searched that are no customary mark.
  float lowest_ = std::numeric_limits<float>::infinity(), highest_ = -lowest_;
  std::array<std::size_t, 4> customary_{};
  std::size_t masked_ = 0, read_ = 0;
};

/// Returns a raster in order from south to north of values in order from north to south.
Raster<float> northUp(const Grid& grid, std::vector<float> values);

}  // namespace talus::maps
