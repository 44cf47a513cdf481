#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <deque>
#include <fstream>
#include <new>
#include <optional>

#include <csv.h>

#include <talus/common/common.hpp>
#include <talus/terramech/io/column_units.hpp>
#include <talus/terramech/io/csv_reader.hpp>
#include <talus/terramech/io/table_columns.hpp>

namespace talus::terramech {
namespace {

constexpr std::size_t kMostColumns = 1000;

// Returns the field separator, from the first line that is neither empty nor a comment: the most frequent of
// comma, semicolon and tab, or else blanks.
char separatorOf(std::string_view text) {
  std::string_view line;
  do {
    text.remove_prefix(std::min(text.size(), text.find_first_not_of("\r\n ")));
    line = text.substr(0, text.find_first_of("\r\n"));
    text.remove_prefix(line.size());
  } while (line.starts_with('#'));
  char most = ',';
  for (const char c : {';', '\t'})
    if (std::ranges::count(line, c) > std::ranges::count(line, most)) most = c;
  return line.find(most) == line.npos && line.find(' ') != line.npos ? ' ' : most;
}

}  // namespace

/// State of libcsv, which returns fields and record ends by callbacks; complete records wait in a queue.
struct CsvReader::Parser {
  explicit Parser(const TableFile& table);
  ~Parser() { csv_free(&csv); }
  Parser(const Parser&) = delete;
  Parser& operator=(const Parser&) = delete;

  void open();
  void readHeader();
  bool pop(CsvRow& row);
  void feed();
  void endRecord(int terminator);
  std::string faultOf(const CsvRow& row) const;
  [[noreturn]] void refuse(const std::string& reason, const std::string& remedy) const;

  TableFile table;
  std::filesystem::path path;
  std::optional<TableColumns> columns;
  char separator = ',';
  std::ifstream file;
  std::uintmax_t size = 0, read = 0;
  csv_parser csv{};
  std::vector<std::string> header;
  std::deque<CsvRow> ready;
  CsvRow current;
  std::size_t line = 1;       // first line of the current record
  std::size_t swallowed = 0;  // line of a record whose quotes enclose other rows; 0: none
  bool after_return = false;  // the last record ended with CR: a following LF belongs to it
  bool done = false;
};

CsvReader::Parser::Parser(const TableFile& asked) : table(asked), path(asked.path) {
  if (csv_init(&csv, CSV_REPALL_NL) != 0) throw std::bad_alloc();
}

void CsvReader::Parser::open() {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) refuse("is a directory", "name a CSV file");
  checkInput(path.string());
  file.open(path, std::ios::binary);
  if (!file) refuse(std::strerror(errno), "check the path and its permissions");
  size = std::filesystem::file_size(path, error);
  readHeader();
}

void CsvReader::Parser::refuse(const std::string& reason, const std::string& remedy) const {
  throw InputError({.where = path.string(), .reason = reason, .remedy = remedy});
}

void CsvReader::Parser::readHeader() {
  CsvRow row;
  if (!pop(row)) refuse("is empty", "the first row names the columns");
  header = row.fields;
  if (header.size() > kMostColumns)
    refuse("has " + std::to_string(header.size()) + " columns, at most 1000 can be read",
           "keep those that are needed");
  for (const std::string& name : header)
    if (!name.empty() && std::ranges::count(header, name) > 1)
      throw InputError({path.string() + ":" + std::to_string(row.line),
                        "column " + name + " appears twice in the header", "rename one"});
  std::vector<std::string> names = header;
  if (CsvRow below; pop(below) && !takeUnits(names, below.fields, path.string()))
    ready.push_front(std::move(below));
  columns.emplace(std::move(names), table, separator != ',');
}

bool CsvReader::Parser::pop(CsvRow& row) {
  while (ready.empty() && !done) feed();
  if (ready.empty()) return false;
  row = std::move(ready.front());
  ready.pop_front();
  if (!columns) return true;
  if (row.fault.empty()) row.fault = faultOf(row);
  columns->apply(row.fields, row.fault.empty());
  return true;
}

void CsvReader::Parser::feed() {
  std::array<char, 1 << 16> buffer;
  file.read(buffer.data(), buffer.size());
  const auto count = static_cast<std::size_t>(file.gcount());
  if (read == 0 && std::memchr(buffer.data(), 0, count))
    refuse("is not text", "save it as UTF-8 text with commas");
  std::size_t skip = 0;  // skip byte order marks, which would become part of the first column's name
  while (read == 0 && std::string_view(buffer.data() + skip, count - skip).starts_with("\xEF\xBB\xBF"))
    skip += 3;
  if (read == 0) {
    separator = separatorOf(std::string_view(buffer.data() + skip, count - skip));
    csv_set_delim(&csv, static_cast<unsigned char>(separator));
  }
  read += count;
  const auto field = [](void* text, std::size_t length, void* parser) {
    static_cast<Parser*>(parser)->current.fields.emplace_back(static_cast<const char*>(text), length);
  };
  const auto end_of_record = [](int terminator, void* parser) {
    static_cast<Parser*>(parser)->endRecord(terminator);
  };
  if (csv_parse(&csv, buffer.data() + skip, count - skip, field, end_of_record, this) != count - skip)
    refuse(csv_strerror(csv_error(&csv)), "");
  if (swallowed == 0 && file) return;
  done = true;
  constexpr int kFieldBegun = 2;  // state of libcsv inside a field
  const bool open_quote = csv.pstate == kFieldBegun && csv.quoted;
  if (open_quote && swallowed == 0) swallowed = line;
  if (swallowed > 0)
    throw InputError({.where = path.string() + ":" + std::to_string(swallowed),
                      .reason = "a quote of this line holds the rows behind it",
                      .remedy = "close or remove it"});
  csv_fini(&csv, field, end_of_record, this);
}

void CsvReader::Parser::endRecord(int terminator) {
  if (terminator == '\n' && after_return && current.fields.empty()) {
    after_return = false;
    return;
  }
  after_return = terminator == '\r';
  current.line = line;
  const auto holds_rows = [this](const std::string& f) {
    return f.find(separator) != std::string::npos && f.find_first_of("\r\n") != std::string::npos;
  };
  if (swallowed == 0 && std::ranges::any_of(current.fields, holds_rows)) swallowed = line;
  for (const auto& f : current.fields) line += static_cast<std::size_t>(std::count(f.begin(), f.end(), '\n'));
  ++line;
  if (separator == ' ') std::erase(current.fields, "");  // between blanks
  const bool before_header = header.empty() && ready.empty();
  const bool comment = !current.fields.empty() && current.fields.front().starts_with('#') &&
                       (before_header || current.fields.size() == 1 || current.fields.front() == "#");
  if (!current.fields.empty() && !comment) ready.push_back(std::move(current));
  current = {};
}

std::string CsvReader::Parser::faultOf(const CsvRow& row) const {
  if (row.fields == header) return "repeats the header";
  std::size_t fields = row.fields.size();
  while (fields > header.size() && row.fields[fields - 1].empty()) --fields;
  if (fields == header.size()) return "";
  return "has " + std::to_string(row.fields.size()) + " fields, the header " + std::to_string(header.size());
}

CsvReader::CsvReader(const TableFile& table) : parser_(std::make_unique<Parser>(table)) {
  parser_->open();
}

CsvReader::~CsvReader() = default;

const std::vector<std::string>& CsvReader::header() const noexcept {
  return parser_->columns->header();
}

bool CsvReader::next(CsvRow& row) {
  return parser_->pop(row);
}

double CsvReader::fraction() const noexcept {
  return parser_->size ? static_cast<double>(parser_->read) / static_cast<double>(parser_->size) : 1.0;
}

std::string csvField(std::string_view text) {
  const bool outer_blank = !text.empty() && (text.front() == ' ' || text.back() == ' ');
  if (!outer_blank && text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

}  // namespace talus::terramech
