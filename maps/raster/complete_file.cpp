#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string_view>
#include <system_error>
#include <vector>

#include <gdal_priv.h>

#include <talus/common/input_error.hpp>
#include <talus/maps/raster/complete_file.hpp>

namespace talus::maps {
namespace {

constexpr std::size_t kPiece = std::size_t{1} << 20;

std::string_view driverOf(GDALDataset& dataset) {
  GDALDriver* driver = dataset.GetDriver();
  return driver == nullptr ? std::string_view() : GDALGetDriverShortName(driver);
}

std::uintmax_t cellsOf(GDALDataset& dataset) {
  return static_cast<std::uintmax_t>(dataset.GetRasterXSize()) *
         static_cast<std::uintmax_t>(dataset.GetRasterYSize());
}

void refuseFewerBytes(const std::string& path, std::uintmax_t needed) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (!error && size < needed)
    throw InputError({path,
                      "is cut short: " + std::to_string(size) + " of " + std::to_string(needed) + " bytes",
                      "fetch it again"});
}

// Size [bytes] that the header of an ENVI file states. GDAL reads missing bytes at the end of the file as
// zeros.
std::uintmax_t bytesOfEnvi(GDALDataset& dataset) {
  const auto bytes =
      static_cast<std::uintmax_t>(GDALGetDataTypeSizeBytes(dataset.GetRasterBand(1)->GetRasterDataType()));
  return bytes * cellsOf(dataset) * static_cast<std::uintmax_t>(dataset.GetRasterCount());
}

// Parser of a netCDF-3 header ("The NetCDF Classic Format Specification", Unidata). A read beyond the end of
// the file sets the failure state of the stream.
class ClassicHeader {
 public:
  explicit ClassicHeader(const std::string& path) : path_(path), file_(path, std::ios::binary) {}

  // Offset [bytes] of the end of the last variable; nullopt if the file is not netCDF-3.
  std::optional<std::uintmax_t> end() {
    char magic[4] = {};
    file_.read(magic, 4);
    if (!file_ || std::string_view(magic, 3) != "CDF" || (magic[3] != 1 && magic[3] != 2 && magic[3] != 5))
      return std::nullopt;
    wide_ = magic[3] == 5;
    offset_bytes_ = magic[3] == 1 ? 4 : 8;
    const std::uintmax_t stated = number(countBytes());
    const bool streamed =
        // value for an unknown number of records
        stated == (wide_ ? UINTMAX_MAX : UINTMAX_C(0xffffffff));
    readDimensions();
    skipAttributes();
    readVariables();
    if (!file_) throw InputError({path_, "is cut short within its header", "fetch it again"});
    std::uintmax_t end = static_cast<std::uintmax_t>(file_.tellg());
    const std::uintmax_t records = streamed ? 0 : stated;
    const std::uintmax_t of_records = recordBytes();
    for (const Variable& v : variables_) {
      if (!v.by_record)
        end = std::max(end, v.begin + v.bytes);
      else if (records > 0)
        end = std::max(end, v.begin + (records - 1) * of_records + v.bytes);
    }
    return end;
  }

 private:
  struct Variable {
    std::uintmax_t begin, bytes;  // size of the variable, or of one record of it
    bool by_record;
  };
  static constexpr std::uintmax_t kMost = 1'000'000;  // limit of dimensions, attributes or variables

  int countBytes() const { return wide_ ? 8 : 4; }
  static std::uintmax_t padded(std::uintmax_t bytes) { return (bytes + 3) / 4 * 4; }

  std::uintmax_t number(int bytes) {
    std::uintmax_t value = 0;
    for (int i = 0; i < bytes; ++i)
      value = value << 8 | static_cast<unsigned char>(static_cast<char>(file_.get()));
    return file_ ? value : 0;
  }
  // Length of a list. A length above kMost sets the failure state of the stream.
  std::uintmax_t length() {
    number(4);  // tag of the list
    const std::uintmax_t count = number(countBytes());
    if (count > kMost) file_.setstate(std::ios::failbit);
    return file_ ? count : 0;
  }
  void skip(std::uintmax_t bytes) { file_.seekg(static_cast<std::streamoff>(padded(bytes)), std::ios::cur); }
  void skipName() { skip(number(countBytes())); }

  static std::uintmax_t bytesOfType(std::uintmax_t type) {
    constexpr std::uintmax_t kBytes[] = {0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};
    return type < std::size(kBytes) ? kBytes[type] : 0;
  }

  void readDimensions() {
    for (std::uintmax_t n = length(); n > 0 && file_; --n) {
      skipName();
      dimensions_.push_back(number(countBytes()));
    }
  }
  void skipAttributes() {
    for (std::uintmax_t n = length(); n > 0 && file_; --n) {
      skipName();
      const std::uintmax_t bytes = bytesOfType(number(4));
      skip(bytes * number(countBytes()));
    }
  }
  void readVariables() {
    for (std::uintmax_t n = length(); n > 0 && file_; --n) {
      skipName();
      std::uintmax_t axes = number(countBytes()), count = 1;
      bool by_record = false;
      if (axes > kMost) file_.setstate(std::ios::failbit);
      for (; axes > 0 && file_; --axes) {
        const std::uintmax_t id = number(countBytes());
        const std::uintmax_t extent = id < dimensions_.size() ? dimensions_[id] : 0;
        by_record = by_record || extent == 0;
        count *= std::max<std::uintmax_t>(extent, 1);
      }
      skipAttributes();
      const std::uintmax_t bytes = bytesOfType(number(4)) * count;
      number(countBytes());  // vsize, which is unreliable for large variables
      variables_.push_back({number(offset_bytes_), bytes, by_record});
    }
  }
  // Size of one record [bytes]. Record variables are padded to 4 bytes, except a single record variable.
  std::uintmax_t recordBytes() const {
    std::uintmax_t sum = 0, own = 0, count = 0;
    for (const Variable& v : variables_)
      if (v.by_record) {
        sum += padded(v.bytes);
        own = v.bytes;
        ++count;
      }
    return count == 1 ? own : sum;
  }

  const std::string& path_;
  std::ifstream file_;
  bool wide_ = false;
  int offset_bytes_ = 4;
  std::vector<std::uintmax_t> dimensions_;
  std::vector<Variable> variables_;
};

// Rejects a text file that ends with a digit or a point: its last number may be incomplete.
void refuseOpenEnd(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  file.seekg(-1, std::ios::cur);
  const int last = file.get();
  if (file && std::isdigit(last) == 0 && last != '.') return;
  throw InputError({path, "ends within a number, as a file that is cut short does",
                    "fetch it again; if it is whole, end its last line"});
}

// Rejects a table of numbers with control bytes or non-ASCII bytes.
void refuseForeignBytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string piece(kPiece, '\0');
  std::size_t line = 1;
  while (file.read(piece.data(), static_cast<std::streamsize>(piece.size())), file.gcount() > 0)
    for (const char c : std::string_view(piece.data(), static_cast<std::size_t>(file.gcount()))) {
      line += c == '\n' ? 1U : 0U;
      const auto byte = static_cast<unsigned char>(c);
      if (byte >= 0x80 || (byte < 0x20 && std::isspace(byte) == 0))
        throw InputError(
            {path + ":" + std::to_string(line),
             "holds the byte " + std::to_string(byte) + " among its numbers, as a damaged file does",
             "fetch it again"});
    }
}

// Calls `each` for every source raster of a VRT.
template <typename Each>
void forSources(GDALDataset& dataset, const std::string& path, Each each) {
  char** files = dataset.GetFileList();
  for (char** file = files; file != nullptr && *file != nullptr; ++file)
    if (const GDALDatasetUniquePtr source{std::string_view(*file) == path
                                              ? nullptr
                                              : GDALDataset::Open(*file, GDAL_OF_RASTER | GDAL_OF_READONLY)})
      each(*source, *file);
  CSLDestroy(files);
}

bool lost(GDALRasterBand& band) {
  if (int stated = 0; band.GetNoDataValue(&stated), stated != 0) return false;
  return (band.GetDataCoverageStatus(0, 0, band.GetXSize(), band.GetYSize(), 0, nullptr) &
          GDAL_DATA_COVERAGE_STATUS_EMPTY) != 0;
}

constexpr std::size_t kLongest = 400;  // longest accepted number [characters]

// True if a word is a number for GDAL, which accepts a decimal comma.
bool isNumber(std::string_view word) {
  if (word.size() > kLongest) return false;
  std::string text(word);
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
  if (std::ranges::count(text, ',') == 1 && text.find('.') == text.npos) std::ranges::replace(text, ',', '.');
  std::string_view rest = text;
  if (rest.starts_with('+') || rest.starts_with('-')) rest.remove_prefix(1);
  for (const std::string_view known : {"nan", "inf", "infinity", "1.#inf", "1.#ind", "1.#qnan", "1.#snan"})
    if (rest == known) return true;
  if (rest.starts_with('+') || rest.starts_with('-')) return false;
  double value = 0.0;
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
  return error != std::errc::invalid_argument && end == rest.data() + rest.size();
}

bool isKey(std::string_view word) {
  return !word.empty() && std::isalpha(static_cast<unsigned char>(word.front())) != 0 && !isNumber(word);
}

// Checks the words of an ASCII grid in order: header keys, each followed by a number, then numbers only.
class Words {
 public:
  explicit Words(const std::string& path) : path_(path) {}

  void take(std::string_view word, std::size_t line) {
    if (header_ && !value_of_key_ && isKey(word)) {
      value_of_key_ = true;
      return;
    }
    if (!value_of_key_) header_ = false;
    value_of_key_ = false;
    if (isNumber(word)) return;
    throw InputError({path_ + ":" + std::to_string(line),
                      "'" + std::string(word.substr(0, 40)) + "' is not a number",
                      "write the NODATA_value, or nan, where nothing is known"});
  }

 private:
  const std::string& path_;
  bool header_ = true, value_of_key_ = false;
};

}  // namespace

void refuseCutShort(GDALDataset& dataset, const std::string& path) {
  const std::string_view driver = driverOf(dataset);
  if (driver == "ENVI") refuseFewerBytes(path, bytesOfEnvi(dataset));
  if (driver == "netCDF")
    if (const auto end = ClassicHeader(path).end()) refuseFewerBytes(path, *end);
  // Each value takes at least two bytes: a digit and a separator.
  if (driver == "AAIGrid" || driver == "GSAG") refuseFewerBytes(path, 2 * cellsOf(dataset));
  if (driver == "AAIGrid" || driver == "GSAG" || driver == "XYZ") {
    refuseForeignBytes(path);
    refuseOpenEnd(path);
  }
  if (driver == "VRT")
    forSources(dataset, path, [](GDALDataset& source, const std::string& of) { refuseCutShort(source, of); });
}

void refuseLostBlocks(GDALDataset& dataset, int band, const std::string& path) {
  if (driverOf(dataset) == "VRT")
    return forSources(dataset, path, [](GDALDataset& source, const std::string& of) {
      for (int own = 1; own <= source.GetRasterCount(); ++own) refuseLostBlocks(source, own, of);
    });
  GDALRasterBand& of = *dataset.GetRasterBand(band);
  bool any = lost(of);
  for (int i = 0; i < of.GetOverviewCount(); ++i) any = any || lost(*of.GetOverview(i));
  if (any)
    throw InputError(
        {path, "is cut short or half written: blocks are missing, and no value stands for no data",
         "write it again, or state one with gdal_edit.py -a_nodata if they are meant to be empty"});
}

void refuseWordsInGrid(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string piece(kPiece, '\0'), word;
  Words words(path);
  std::size_t line = 1;
  while (file.read(piece.data(), static_cast<std::streamsize>(piece.size())), file.gcount() > 0)
    for (const char c : std::string_view(piece.data(), static_cast<std::size_t>(file.gcount()))) {
      const bool between = c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\0';
      if (!between && word.size() <= kLongest) word += c;
      if (between && !word.empty()) {
        words.take(word, line);
        word.clear();
      }
      line += c == '\n' ? 1U : 0U;
    }
  if (!word.empty()) words.take(word, line);
}

}  // namespace talus::maps
