#include <algorithm>
#include <cmath>
#include <set>

#include <site_map.hpp>

#include <talus/costmap/telemetry/drive_id.hpp>
#include <talus/costmap/telemetry/telemetry_rows.hpp>

namespace talus::costmap {
namespace drive_id_test {

std::string driveId(const terramech::Telemetry& telemetry) {
  DriveId id;
  id.add(telemetry);
  return id.text();
}

// A table with every used column: two accepted rows and a rejected one between them.
terramech::Telemetry table() {
  terramech::Telemetry out;
  out.source = "t.csv";
  double value = 0.1;
  for (const std::string_view name : usedNumberColumns()) {
    out.numbers.push_back({std::string(name), {value, value + 0.01}});
    out.rejected_numbers.push_back({std::string(name), {value + 0.02}});
    value += 0.03;
  }
  for (const std::string_view name : usedWordColumns()) out.words.push_back({std::string(name), {"a", "b"}});
  out.lines = {2, 4};
  out.rejected = {{3, "load_N = -3, must be > 0"}};
  return out;
}

// Property: the id of a drive is independent of the order of columns, of unused columns and of empty
// columns, so that such a file is not counted twice.
TEST(DriveId, IdIsIndependentOfColumnOrderAndUnusedColumns) {
  const std::string id = driveId(table());
  terramech::Telemetry turned = table();
  std::ranges::reverse(turned.numbers);
  std::ranges::reverse(turned.words);
  std::ranges::reverse(turned.rejected_numbers);
  EXPECT_EQ(driveId(turned), id);
  terramech::Telemetry more = table();
  more.words.push_back({"remark", {"x", "y"}});
  more.numbers.insert(more.numbers.begin(), {"temperature_K", {250.0, NAN}});
  EXPECT_EQ(driveId(more), id);
  terramech::Telemetry less = table(), empty = table();
  std::erase_if(less.numbers, [](const auto& column) { return column.name == "z_m"; });
  for (auto& column : empty.numbers)
    if (column.name == "z_m") column.values = {NAN, -NAN};
  EXPECT_EQ(driveId(less), driveId(empty));
  terramech::Telemetry footer = table();
  footer.rejected.push_back({5, "load_N = 'end', must be a number"});
  for (auto& column : footer.rejected_numbers) column.values.push_back(NAN);
  EXPECT_EQ(driveId(footer), id);
  EXPECT_NE(driveId(less), id);
}

// Property: a change of any used value, also in rejected rows, or of the order of rows makes a different id.
TEST(DriveId, IdDependsOnEveryUsedValue) {
  std::set<std::string> ids{driveId(table())};
  std::size_t tables = 1;
  const auto add = [&](auto&& change) {
    terramech::Telemetry changed = table();
    change(changed);
    ids.insert(driveId(changed));
    EXPECT_EQ(ids.size(), ++tables);
  };
  for (std::size_t column = 0; column < usedNumberColumns().size(); ++column) {
    add([&](auto& t) { t.numbers[column].values[1] += 1.0; });
    add([&](auto& t) { t.rejected_numbers[column].values[0] += 1.0; });
  }
  for (std::size_t column = 0; column < usedWordColumns().size(); ++column)
    add([&](auto& t) { t.words[column].values[0] = "c"; });
  add([](auto& t) { t.rejected[0].line = 5; });
  add([](auto& t) {
    for (auto& column : t.numbers) std::swap(column.values[0], column.values[1]);
  });
}

// Property: the id of a divided drive is that of the whole drive.
TEST(DriveId, IdIsIndependentOfDivision) {
  terramech::Telemetry first = table(), second = table();
  for (auto* columns : {&first.numbers, &second.numbers})
    for (auto& column : *columns) column.values.erase(column.values.begin() + (columns == &first.numbers));
  for (auto* columns : {&first.words, &second.words})
    for (auto& column : *columns) column.values.erase(column.values.begin() + (columns == &first.words));
  first.lines = {2};
  second.lines = {4};
  second.rejected.clear();
  second.rejected_numbers.clear();
  DriveId id;
  id.add(first);
  id.add(second);
  EXPECT_EQ(id.text(), driveId(table()));
}

}  // namespace drive_id_test
}  // namespace talus::costmap
