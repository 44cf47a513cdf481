#include <algorithm>
#include <array>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <vector>

#include <talus/costmap/telemetry/drive_id.hpp>
#include <talus/costmap/telemetry/telemetry_rows.hpp>

namespace talus::costmap {
namespace {

std::string hexadecimal(const Checksum& sum) {
  std::array<char, 17> digits{};
  std::snprintf(digits.data(), digits.size(), "%016" PRIx64, sum.value());
  return digits.data();
}

// Calls take(row) for each row and take_rejected(row) for each rejected row, in the order of the file: the
// identifier of a drive does not depend on its division into parts.
template <typename Take, typename TakeRejected>
void eachRow(const terramech::Telemetry& telemetry, Take&& take, TakeRejected&& take_rejected) {
  std::size_t rejected = 0;
  const auto addRejected = [&](std::size_t before_line) {
    for (; rejected < telemetry.rejected.size() && telemetry.rejected[rejected].line < before_line;
         ++rejected)
      take_rejected(rejected);
  };
  for (std::size_t i = 0; i < telemetry.size(); ++i) {
    addRejected(telemetry.lines[i]);
    take(i);
  }
  addRejected(std::numeric_limits<std::size_t>::max());
}

using Column = const std::vector<double>*;

std::vector<Column> usedOf(const std::vector<terramech::Telemetry::Numbers>& columns) {
  std::vector<Column> used;
  for (const std::string_view name : usedNumberColumns()) {
    used.push_back(nullptr);
    for (const auto& column : columns)
      if (column.name == name) used.back() = &column.values;
  }
  return used;
}

// Adds the values of a row. A missing column counts as a column of NaN, except columns that files of older
// maps could not have, so that their identifiers stay.
void addNumbers(Checksum& sum, const std::vector<Column>& columns, std::size_t row) {
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const Column column = columns[c];
    const std::string_view name = usedNumberColumns()[c];
    if (!column && (name.starts_with("odometry") || name == "wheel_rate_rad_s")) continue;
    double value = column ? (*column)[row] : std::numeric_limits<double>::quiet_NaN();
    if (std::isnan(value)) value = std::numeric_limits<double>::quiet_NaN();
    sum.add(&value, sizeof value);
  }
}

void addWord(Checksum& sum, const std::string& word) {
  sum.add(word.c_str(), word.size() + 1);
}

// Calls added(rejected) after each row.
template <typename Added>
void addRows(Checksum& sum, const terramech::Telemetry& telemetry, Added&& added) {
  const std::vector<Column> numbers = usedOf(telemetry.numbers),
                            left_out = usedOf(telemetry.rejected_numbers);
  std::vector<const std::vector<std::string>*> words;
  for (const std::string_view name : usedWordColumns()) words.push_back(telemetry.findWords(name));
  eachRow(
      telemetry,
      [&](std::size_t i) {
        addNumbers(sum, numbers, i);
        for (const auto* column : words) addWord(sum, column ? (*column)[i] : std::string());
        added(false);
      },
      [&](std::size_t i) {
        // A row without any number, such as a footer or a repeated header, does not change the identifier.
        const auto holds = [i](Column column) { return column && !std::isnan((*column)[i]); };
        if (std::ranges::any_of(left_out, holds)) addNumbers(sum, left_out, i);
        added(true);
      });
}

}  // namespace

void DriveId::add(const terramech::Telemetry& telemetry) {
  addRows(sum_, telemetry, [](bool) {});
}

std::string DriveId::text() const {
  return hexadecimal(sum_);
}

std::uint16_t driveTag(const terramech::Telemetry& telemetry) {
  std::optional<std::uint16_t> tag;
  Checksum sum;
  addRows(sum, telemetry, [&](bool) {
    if (!tag) tag = static_cast<std::uint16_t>(sum.value());
  });
  return tag.value_or(0);
}

DriveBeginning knownBeginning(const terramech::Telemetry& telemetry,
                              const std::map<std::string, TraversabilityMap::Drive>& drives) {
  DriveBeginning here, known;
  Checksum sum;
  if (drives.empty()) return known;
  addRows(sum, telemetry, [&](bool rejected) {
    ++(rejected ? here.rejected : here.rows);
    if (drives.contains(hexadecimal(sum))) known = here;
  });
  return known;
}

}  // namespace talus::costmap
