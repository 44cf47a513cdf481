#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>
#include <optional>
#include <sstream>
#include <string_view>
#include <system_error>
#include <vector>

#include <cpl_minixml.h>
#include <cpl_string.h>
#include <gdal_priv.h>
#include <nlohmann/json.hpp>

#include <talus/common/input_error.hpp>
#include <talus/maps/raster/complete_file.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>

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

std::uintmax_t wholeNumber(const std::string& text) {
  std::uintmax_t value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

std::uintmax_t sizeOf(const std::string& path) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  return error ? 0 : size;
}

[[noreturn]] void refuseSize(const std::string& path, std::uintmax_t size, std::uintmax_t stated) {
  throw InputError({path,
                    "holds " + std::to_string(size) + " bytes, its label states " + std::to_string(stated) +
                        ": bytes were inserted or lost",
                    "fetch file and label again"});
}

void refuseFewerBytes(const std::string& path, std::uintmax_t needed) {
  if (const std::uintmax_t size = sizeOf(path); size < needed)
    throw InputError({path,
                      "is cut short: " + std::to_string(size) + " of " + std::to_string(needed) + " bytes",
                      "fetch it again"});
}

// End [bytes] of the last object (label, history, table) of an ISIS cube by its StartByte and Bytes.
std::uintmax_t lastByte(const nlohmann::json& label) {
  std::uintmax_t end = 0;
  if (label.is_object() && label.contains("StartByte") && label.contains("Bytes") &&
      label["StartByte"].is_number_unsigned() && label["Bytes"].is_number_unsigned())
    end = label["StartByte"].get<std::uintmax_t>() - 1 + label["Bytes"].get<std::uintmax_t>();
  if (label.is_structured())
    for (const auto& part : label) end = std::max(end, lastByte(part));
  return end;
}

nlohmann::json labelOf(GDALDataset& dataset, const char* domain) {
  char** text = dataset.GetMetadata(domain);
  return text == nullptr ? nlohmann::json() : nlohmann::json::parse(*text, nullptr, false);
}

// File size [bytes] that the label of a raster of plain numbers states, beside the size of its pixels: of
// records (PDS3, VICAR), of the file (PDS4) or of further objects (ISIS). 0: none.
std::uintmax_t statedBytes(GDALDataset& dataset, const std::string& path, std::uintmax_t size) {
  const std::string_view driver = driverOf(dataset);
  if (driver == "PDS")
    return wholeNumber(pds3Keyword(path, "RECORD_BYTES")) * wholeNumber(pds3Keyword(path, "FILE_RECORDS"));
  if (driver == "ISIS3") return lastByte(labelOf(dataset, "json:ISIS3"));
  if (driver == "VICAR") {
    const auto record = labelOf(dataset, "json:VICAR").value("RECSIZE", std::uintmax_t{0});
    return record == 0 ? 0 : size / record * record;
  }
  if (driver != "PDS4") return 0;
  char** xml = dataset.GetMetadata("xml:PDS4");
  const CPLXMLTreeCloser tree(CPLParseXMLString(xml == nullptr ? "" : *xml));
  CPLStripXMLNamespace(tree.get(), nullptr, TRUE);
  const CPLXMLNode* file = CPLSearchXMLNode(tree.get(), "=File");
  return file == nullptr ? 0 : wholeNumber(CPLGetXMLValue(file, "file_size", "0"));
}

// Rejects a raster of plain numbers whose file is shorter or longer than its label states: GDAL reads missing
// bytes as zeros, and a byte that was inserted moves all pixels behind it into other numbers.
void refuseOtherSize(GDALDataset& dataset, const std::string& path) {
  GDALDataset::RawBinaryLayout raw;
  if (driverOf(dataset) == "GTiff" || !dataset.GetRawBinaryLayout(raw)) return;
  if (raw.osRawFilename.empty()) raw.osRawFilename = path;
  // A negative offset runs towards the beginning of the file.
  const auto steps = [](int count, GIntBig bytes) {
    return static_cast<std::uintmax_t>(std::max(count - 1, 0)) *
           static_cast<std::uintmax_t>(std::max<GIntBig>(bytes, 0));
  };
  const std::uintmax_t end =
      std::uintmax_t{raw.nImageOffset} + steps(dataset.GetRasterCount(), raw.nBandOffset) +
      steps(dataset.GetRasterYSize(), raw.nLineOffset) + steps(dataset.GetRasterXSize(), raw.nPixelOffset) +
      static_cast<std::uintmax_t>(GDALGetDataTypeSizeBytes(raw.eDataType));
  refuseFewerBytes(raw.osRawFilename, end);
  const std::uintmax_t size = sizeOf(raw.osRawFilename), stated = statedBytes(dataset, path, size);
  // Lines may be longer than their pixels, also the last one.
  const std::uintmax_t whole_lines =
      std::uintmax_t{raw.nImageOffset} + steps(dataset.GetRasterYSize() + 1, raw.nLineOffset);
  if (size != end && size != stated && size != whole_lines)
    refuseSize(raw.osRawFilename, size, std::max(end, stated));
}

// Rejects pixels that GDAL reads as other numbers or in another order than the label states.
void refuseMisread(GDALDataset& dataset, const std::string& path) {
  const auto refuse = [&](const std::string& what) {
    throw InputError({path, what + ", which GDAL reads as other numbers", "convert it to a GeoTIFF"});
  };
  GDALRasterBand& band = *dataset.GetRasterBand(1);
  const char* signed_byte = band.GetMetadataItem("PIXELTYPE", "IMAGE_STRUCTURE");
  if (signed_byte != nullptr && signed_byte == std::string_view("SIGNEDBYTE")) refuse("holds signed bytes");
  if (driverOf(dataset) == "PDS") {
    const std::string type = pds3Keyword(path, "SAMPLE_TYPE", "IMAGE");
    const bool integers = type.find("INTEGER") != type.npos;
    if (integers && (GDALDataTypeIsFloating(band.GetRasterDataType()) != FALSE ||
                     (band.GetRasterDataType() == GDT_Byte && type.find("UNSIGNED") == type.npos)))
      refuse("holds pixels of SAMPLE_TYPE " + type + " and SAMPLE_BITS " +
             pds3Keyword(path, "SAMPLE_BITS", "IMAGE"));
    if (wholeNumber(pds3Keyword(path, "LINE_SUFFIX_BYTES", "IMAGE")) > 0) refuse("has LINE_SUFFIX_BYTES");
    const auto map = [&](const char* key) { return std::atof(pds3Keyword(path, key).c_str()); };
    // Pixels per degree times the size of a pixel [km or m] is a degree on the sphere, within 2 % on ellipsoids.
    const double degree = map("MAP_SCALE") * map("MAP_RESOLUTION"),
                 own = map("A_AXIS_RADIUS") * std::numbers::pi / 180.0;
    const auto near = [&](double length) { return std::abs(degree - length) <= 0.02 * length; };
    if (degree > 0.0 && own > 0.0 && !near(own) && !near(1000.0 * own))
      throw InputError(
          {path, "states a MAP_SCALE and a MAP_RESOLUTION of different pixels", "correct one of them"});
  }
  if (driverOf(dataset) == "PDS4") {
    char** xml = dataset.GetMetadata("xml:PDS4");
    const std::string_view label = xml == nullptr ? "" : *xml;
    for (const char* unread : {"SignedByte", "Right to Left"})
      if (label.find(unread) != label.npos) refuse(std::string("states ") + unread);
  }
}

// Rejects a GeoTIFF with an image that GDAL uses neither as the raster nor as its overview or mask: one bit of
// its header separates a mask from the raster.
void refuseUnusedImages(GDALDataset& dataset, const std::string& path) {
  if (driverOf(dataset) != "GTiff") return;
  GDALRasterBand& band = *dataset.GetRasterBand(1);
  const std::vector<InputFile> files = filesOf(dataset, path);
  const auto beside = [&](const char* role) { return std::ranges::count(files, role, &InputFile::role) > 0; };
  int used = 1 + (beside("overviews") ? 0 : band.GetOverviewCount());
  const bool masked = (band.GetMaskFlags() & GMF_PER_DATASET) != 0;
  if (beside("mask") && !masked)
    throw InputError({path + ".msk", "lacks INTERNAL_MASK_FLAGS, by which GDAL knows a mask",
                      "write it again with gdal_translate -mask, or remove it"});
  if (masked && !beside("mask")) used += 1 + band.GetMaskBand()->GetOverviewCount();
  const GdalErrors quiet;
  constexpr const char* kTiff[] = {"GTiff", nullptr};
  const std::string next = "GTIFF_DIR:" + std::to_string(used + 1) + ":" + path;
  if (const Dataset more{GDALDataset::Open(next.c_str(), GDAL_OF_RASTER, kTiff)})
    throw InputError({path, "holds a further image, neither raster, overview nor mask",
                      "fetch it again; if it is meant to, take its image out with gdal_translate " + next});
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
  for (const InputFile& file : filesOf(dataset, path))
    if (const Dataset source{file.role == "source"
                                 ? GDALDataset::Open(file.path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY)
                                 : nullptr})
      each(*source, file.path);
}

// True if a block of a GeoTIFF has no place in the file, and no value stands for no data.
bool lost(GDALRasterBand& band) {
  if (int stated = 0; band.GetNoDataValue(&stated), stated != 0) return false;
  int width = 0, height = 0;
  band.GetBlockSize(&width, &height);
  for (int row = 0; row * height < band.GetYSize(); ++row)
    for (int column = 0; column * width < band.GetXSize(); ++column)
      if (const std::string block = "BLOCK_OFFSET_" + std::to_string(column) + "_" + std::to_string(row);
          band.GetMetadataItem(block.c_str(), "TIFF") == nullptr)
        return true;
  return false;
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
    values_ += header_ ? 0 : 1;
    if (isNumber(word)) return;
    throw InputError({path_ + ":" + std::to_string(line),
                      "'" + std::string(word.substr(0, 40)) + "' is not a number",
                      "write the NODATA_value, or nan, where nothing is known"});
  }

  std::uintmax_t values() const { return values_; }

 private:
  const std::string& path_;
  bool header_ = true, value_of_key_ = false;
  std::uintmax_t values_ = 0;
};

}  // namespace

void refuseDamaged(GDALDataset& dataset, const std::string& path) {
  const std::string_view driver = driverOf(dataset);
  refuseOtherSize(dataset, path);
  refuseMisread(dataset, path);
  refuseUnusedImages(dataset, path);
  if (driver == "netCDF")
    if (const auto end = ClassicHeader(path).end()) {
      refuseFewerBytes(path, *end);
      if (sizeOf(path) > (*end + 3) / 4 * 4) refuseSize(path, sizeOf(path), *end);
    }
  // Each value takes at least two bytes: a digit and a separator.
  if (driver == "AAIGrid" || driver == "GSAG") refuseFewerBytes(path, 2 * cellsOf(dataset));
  if (driver == "AAIGrid" || driver == "GSAG" || driver == "XYZ") {
    refuseForeignBytes(path);
    refuseOpenEnd(path);
  }
  if (driver == "VRT")
    forSources(dataset, path, [](GDALDataset& source, const std::string& of) { refuseDamaged(source, of); });
}

void refuseLostBlocks(GDALDataset& dataset, int band, const std::string& path) {
  if (driverOf(dataset) == "VRT")
    return forSources(dataset, path, [](GDALDataset& source, const std::string& of) {
      for (int own = 1; own <= source.GetRasterCount(); ++own) refuseLostBlocks(source, own, of);
    });
  if (driverOf(dataset) == "GTiff" && lost(*dataset.GetRasterBand(band)))
    throw InputError(
        {path, "is cut short or half written: blocks are missing, and no value stands for no data",
         "write it again, or state one with gdal_edit.py -a_nodata if they are meant to be empty"});
}

std::string pds3Keyword(const std::string& path, const std::string& keyword, const std::string& object) {
  // GDAL searches a label of PDS3 in as many bytes at most.
  constexpr std::size_t kLabel = std::size_t{64} << 10U;
  std::ifstream file(path, std::ios::binary);
  std::string text(kLabel, '\0');
  file.read(text.data(), static_cast<std::streamsize>(kLabel));
  std::istringstream lines(text.substr(0, text.find('\0')));
  bool inside = object.empty();
  for (std::string line, key, equals, value; std::getline(lines, line) && key != "END";) {
    std::istringstream words(line);
    if (!(words >> key >> equals >> value) || equals != "=") continue;
    std::erase(value, '"');
    if (inside && key == keyword) return value;
    if (value == object && (key == "OBJECT" || key == "END_OBJECT")) inside = key == "OBJECT";
  }
  return "";
}

std::uintmax_t valuesOfGrid(const std::string& path) {
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
  return words.values();
}

}  // namespace talus::maps
