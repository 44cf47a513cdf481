#include <talus/common/common.hpp>
#include <talus/terramech/io/csv_reader.hpp>
#include <talus/terramech/io/table_columns.hpp>
#include <talus/terramech/io/terramech_io.hpp>

#include "temporary_file.hpp"

namespace talus::terramech {
namespace table_columns_test {

using testing::ElementsAre;
using testing::HasSubstr;

// A table with other names, units and separators.
constexpr const char* kStudent = "Fz;slip_pct;Mx;Fx;sinkage_mm\n80,5;20;2,25;12;12,5\n90;30;3;15;15\n";

std::string refusal(const std::string& content, const std::vector<MappedColumn>& columns,
                    const std::vector<std::pair<std::string, double>>& constants = {}) {
  const test::TemporaryFile file{content};
  TableFile table(file.path());
  table.columns = columns;
  table.constants = constants;
  try {
    CsvReader reader(table);
    return "accepted";
  } catch (const InputError& error) {
    return error.what();
  }
}

// Closed form: conversion from percent and millimetres.
TEST(TableColumns, MapsColumnNamesUnitsAndConstants) {
  const test::TemporaryFile file{kStudent};
  TableFile table(file.path());
  table.columns = {{.known = "load_N", .name = "Fz"},
                   {.known = "slip", .name = "slip_pct", .unit = "percent"},
                   {.known = "torque_Nm", .name = "Mx"}};
  table.constants = {{"wheel_radius_m", 0.1}, {"wheel_width_m", 0.08}};
  std::vector<std::string> notes;
  table.note = [&](const std::string& text) { notes.push_back(text); };
  const Telemetry read = readTelemetry(table, {.required = {"load_N", "slip", "torque_Nm", "sinkage_m"}});
  EXPECT_THAT(read.at("load_N"), ElementsAre(80.5, 90.0));
  EXPECT_THAT(read.at("slip"), ElementsAre(0.2, 0.3));
  EXPECT_THAT(read.at("torque_Nm"), ElementsAre(2.25, 3.0));
  EXPECT_THAT(read.at("sinkage_m"), ElementsAre(0.0125, 0.015));
  EXPECT_THAT(read.at("wheel_radius_m"), ElementsAre(0.1, 0.1));
  EXPECT_THAT(read.at("Fx"), ElementsAre(12.0, 15.0));
  EXPECT_THAT(
      notes,
      ElementsAre("column Fz is read as load_N", "column slip_pct is read as slip, times 0.01",
                  "column Mx is read as torque_Nm", "column sinkage_mm is read as sinkage_m, times 0.001",
                  "column Fx is kept as a column of your own; if it is drawbar_pull_N, pass --column "
                  "drawbar_pull_N=Fx"));
}

// Closed form: 5 % is 0.05, also in a column of percent; a percent of newtons is no number. Times of clocks that count
// nanoseconds since 1970 are exact to a quarter of a microsecond in double precision.
TEST(TableColumns, PercentCellsAndNanosecondsAreRead) {
  const test::TemporaryFile file{"load_N,slip,time_ns\n80,5%,1764000000123456789\n8%,0.1,1\n"};
  TableFile table(file.path());
  table.note = [](const std::string&) {};
  const Telemetry read = readTelemetry(table);
  EXPECT_THAT(read.at("slip"), ElementsAre(0.05));
  EXPECT_NEAR(read.at("time_s").front(), 1764000000.123456789, 2.5e-7);
  const test::TemporaryFile other{"slip_percent\n5%\n5\n"};
  TableFile percents(other.path());
  percents.columns = {{.known = "slip", .name = "slip_percent"}};
  EXPECT_THAT(readTelemetry(percents).at("slip"), ElementsAre(0.05, 0.05));
}

// Property: a column in another unit is rejected without a mapping, because an unnoticed conversion could be
// wrong.
TEST(TableColumns, OtherUnitWithoutMappingIsRejected) {
  const test::TemporaryFile file{"load_N,slip,sinkage_mm\n80,0.2,12\n"};
  EXPECT_THROW(readTelemetry(file.path()), InputError);
}

TEST(TableColumns, StatedUnitOverridesTheUnitInTheName) {
  const auto load = [](const std::string& name, const std::string& unit) {
    const test::TemporaryFile file{name + "\n2\n"};
    TableFile table(file.path());
    table.columns = {{.known = "load_N", .name = name, .unit = unit}};
    return readTelemetry(table).at("load_N").front();
  };
  EXPECT_EQ(load("Fz_kN", ""), 2000.0);
  EXPECT_EQ(load("Fz", "kN"), 2000.0);
  EXPECT_EQ(load("Fz_kN", "N"), 2.0);
  EXPECT_EQ(load("W_t", ""), 2.0);
}

TEST(TableColumns, InvalidMappingsAreRejected) {
  EXPECT_THAT(refusal(kStudent, {{.known = "load_N", .name = "Fn"}}),
              HasSubstr(":1: no column Fn (--column load_N=Fn)"));
  EXPECT_THAT(refusal(kStudent, {{.known = "load_N", .name = "Fz", .unit = "mm"}}),
              HasSubstr("'mm' is no unit of load_N"));
  EXPECT_THAT(refusal(kStudent, {{.known = "slip", .name = "slip_pct", .unit = "deg"}}),
              HasSubstr("'deg' is no unit of slip"));
  EXPECT_THAT(refusal("load_N,Fz\n1,2\n", {{.known = "load_N", .name = "Fz"}}),
              HasSubstr("has column load_N already"));
  EXPECT_THAT(refusal("load_N,wheel_radius_m\n1,2\n", {}, {{"wheel_radius_m", 0.1}}),
              HasSubstr("has column wheel_radius_m, which is also given"));
  EXPECT_THAT(refusal(kStudent, {{.known = "load_N", .name = "Fz"}, {.known = "side_force_N", .name = "Fz"}}),
              HasSubstr("or it is mapped twice"));
}

TEST(TableColumns, TruncatedRowKeepsItsFault) {
  const test::TemporaryFile file{"a,b\n1\n1,2,,\n"};
  TableFile table(file.path());
  table.constants = {{"c", 3.0}};
  CsvReader reader(table);
  CsvRow row;
  ASSERT_TRUE(reader.next(row));
  EXPECT_EQ(row.fault, "has 1 fields, the header 2");
  ASSERT_TRUE(reader.next(row));
  EXPECT_EQ(row.fault, "");
  EXPECT_THAT(row.fields, ElementsAre("1", "2", "3"));
}

}  // namespace table_columns_test
}  // namespace talus::terramech
