#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <sstream>

#include <refused.hpp>

#include <talus/common/common.hpp>
#include <talus/terramech/estimate/telemetry.hpp>
#include <talus/terramech/io/csv_reader.hpp>
#include <talus/terramech/terramech_io.hpp>

#include "requirement.hpp"
#include "temporary_file.hpp"

namespace talus::terramech {
namespace csv_reader_test {

TEST(Unit, ConvertsWithinOneDimensionOnly) {
  EXPECT_DOUBLE_EQ(conversion("deg", "rad").value(), std::numbers::pi / 180.0);  // Closed form.
  EXPECT_EQ(conversion("kPa", "Pa"), 1000.0);
  EXPECT_EQ(conversion("mm", "m"), 1e-3);
  EXPECT_EQ(conversion("kPa", "N"), std::nullopt);
  EXPECT_EQ(conversion("furlong", "m"), std::nullopt);
}

TEST(Unit, UnitIsTheLongestKnownSuffix) {
  EXPECT_EQ(unitOf("gravity_m_s2"), "m_s2");
  EXPECT_EQ(unitOf("max_torque_Nm"), "Nm");
  EXPECT_EQ(unitOf("density_kg_m3"), "kg_m3");
  EXPECT_EQ(unitOf("sinkage_exponent"), "");
  EXPECT_EQ(unitOf("m"), "");
}

using testing::HasSubstr;

std::string unitError(const std::vector<std::string>& header) {
  try {
    checkColumnUnits(header, knownTelemetryColumns(), "t.csv");
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

// Property: a misspelled known column is rejected with a suggestion; any other name is accepted.
TEST(ColumnUnits, MisspelledKnownColumnIsRejectedWithASuggestion) {
  EXPECT_THAT(unitError({"drawbar_pul_N"}), HasSubstr("write column drawbar_pull_N"));
  EXPECT_THAT(unitError({"torqe_Nm"}), HasSubstr("write column torque_Nm"));
  EXPECT_EQ(unitError({"drawbar_pul_N", "drawbar_pull_N"}), "");
  EXPECT_EQ(unitError({"draw_bar_tension_N", "Fx", "dust_index"}), "");
}

// Property: a known quantity in another unit is rejected, never ignored.
TEST(ColumnUnits, KnownColumnInAnotherUnitIsRejected) {
  for (const auto& [name, write] : std::initializer_list<std::pair<const char*, const char*>>{
           {"sinkage_mm", "sinkage_m, in m (sinkage_mm times 0.001)"},
           {"sinkage_cm", "sinkage_m, in m (sinkage_cm times 0.01)"},
           {"sinkage_um", "sinkage_m, in m"},
           {"sinkage_inch", "sinkage_m, in m"},
           {"sinkage_percent", "sinkage_m, in m"},
           {"torque_mNm", "torque_Nm, in Nm (torque_mNm times 0.001)"},
           {"torque_kNm", "torque_Nm, in Nm (torque_kNm times 1000)"},
           {"torque_Ncm", "torque_Nm, in Nm (torque_Ncm times 0.01)"},
           {"drawbar_pull_kN", "drawbar_pull_N, in N (drawbar_pull_kN times 1000)"},
           {"side_force_mN", "side_force_N, in N"},
           {"load_kN", "load_N, in N"},
           {"load_kg", "load_N, in N"},
           {"load_lbf", "load_N, in N"},
           {"slip_angle_deg", "slip_angle_rad, in rad (slip_angle_deg times 0.01745329252)"},
           {"slip_pct", "slip, a number"},
           {"slip_deg", "slip, a number"},
           {"slope_percent", "slope_rad, in rad"},
           {"slope_mrad", "slope_rad, in rad"},
           {"roll_deg", "roll_rad, in rad"},
           {"pitch_degrees", "pitch_rad, in rad"},
           {"heading_deg", "heading_rad, in rad"},
           {"time_ms", "time_s, in s (time_ms times 0.001)"},
           {"time_min", "time_s, in s (time_min times 60)"},
           {"speed_kmh", "speed_mps, in mps"},
           {"speed_m_s", "speed_mps, in mps"},
           {"rim_speed_cmps", "rim_speed_mps, in mps (rim_speed_cmps times 0.01)"},
           {"rim_speed_rpm", "rim_speed_mps, in mps"},
           {"x_km", "x_m, in m"},
           {"z_mm", "z_m, in m"},
           {"wheel_radius_mm", "wheel_radius_m, in m"},
           {"wheel_width_cm", "wheel_width_m, in m"},
           {"grouser_height_mm", "grouser_height_m, in m"},
           {"shear_modulus_mm", "shear_modulus_m, in m"},
           {"shear_modulus_kPa", "shear_modulus_m, in m"}}) {
    const std::string error = unitError({"run", name});
    EXPECT_THAT(error, HasSubstr(std::string("t.csv:1: column ") + name)) << name;
    EXPECT_THAT(error, HasSubstr(std::string("write column ") + write)) << name;
    EXPECT_EQ(error.find('\n'), std::string::npos) << name;
  }
}

TEST(ColumnUnits, AlternativeSpellingIsAcceptedBesideTheKnownColumn) {
  for (const char* name : {"sinkage_mm", "sinkage", "Sinkage_m"})
    EXPECT_EQ(unitError({"sinkage_m", name}), "") << name;
}

TEST(ColumnUnits, KnownColumnWithoutUnitIsRejected) {
  for (const std::string& column : knownTelemetryColumns()) {
    const std::size_t end = column.rfind('_');
    if (column == "slip" || column == "pass_index" || column == "grouser_count") continue;
    if (column == "time_s" || end == 1) continue;  // may be a date or an axis
    EXPECT_THAT(unitError({column.substr(0, end)}),
                HasSubstr("names no unit; write column " + column + ", in "));
  }
}

TEST(ColumnUnits, KnownColumnWithOtherCaseOrPunctuationIsRejected) {
  for (const char* name : {"Load_N", "load_n", "LOAD_N", "load [N]", "Load (N)", "load-N"})
    EXPECT_THAT(unitError({name}), HasSubstr("resembles a known column; write column load_N, in N")) << name;
  EXPECT_THAT(unitError({"Slip"}), HasSubstr("write column slip, a number"));
  EXPECT_THAT(unitError({"slip (%)"}), HasSubstr("pass --column 'slip=slip"));
  EXPECT_THAT(unitError({"Slip angle [\xC2\xB0]"}), HasSubstr("write column slip_angle_rad"));
  EXPECT_THAT(unitError({"Sinkage (mm)"}), HasSubstr("write column sinkage_m"));
  EXPECT_THAT(unitError({"speed [m/s]"}), HasSubstr("write column speed_mps"));
}

// Property: every known name is accepted, and so are other names that resemble a known name.
TEST(ColumnUnits, UserColumnsAreAccepted) {
  EXPECT_EQ(unitError(knownTelemetryColumns()), "");
  EXPECT_EQ(unitError({""}), "");
  std::istringstream names(
      "run wheel sinkage_note load_cell_id temperature_C slip_class torque_limit torque_limit_Nm "
      "load_case load_std_N slip_long slip_yaw slip_fl slip_t slip_min speed_min speed_max "
      "speed_limit_mps sinkage_raw_mm sink_fl_m time_of_day time_of_day_h x_mps y_N z_rad z_raw_m "
      "heading_source slope_class roll_number pitch_note wheel_id wheel_m run_s wheel_diameter_m "
      "wheel_radius_class grain_mm moisture_percent payload_kg soil soil_temperature_C current_A "
      "predicted_sinkage_mm drawbar_raw time x F_N p_Pa mm kN sinkage_true dp_true density_kg_m3 "
      "pass grouser side rim");
  for (std::string name; names >> name;) EXPECT_EQ(unitError({name}), "");
  EXPECT_EQ(unitError({"slip", "slip_mps"}), "") << "beside the slip, a slip speed is another quantity";
}

TEST(ColumnUnits, TelemetryReaderRejectsWrongUnits) {
  const test::TemporaryFile file{"load_N,slip,sinkage_mm\n80,0.1,12\n"};
  EXPECT_REFUSED(readTelemetry(file.path(), {.required = {"load_N", "slip"}}), InputError,
                 "column sinkage_mm has another unit than the known column; write column sinkage_m, in m");
}

TEST(ColumnUnits, MeasuredDataFilesAreAccepted) {
  const char* folder = std::getenv("TALUS_MEASURED_DATA");
  TALUS_REQUIRE(folder != nullptr, "TALUS_MEASURED_DATA is not set");
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".csv") continue;
    ++files;
    std::vector<std::string> header = CsvReader(entry.path()).header();
    // These tables contain digitised points over the slope in degrees and are not telemetry, in which the
    // column would be rejected.
    if (entry.path().parent_path().filename() == "slope_slip") std::erase(header, "slope_deg");
    EXPECT_EQ(unitError(header), "") << entry.path();
  }
  EXPECT_GE(files, 8);
}

using testing::ElementsAre;

std::vector<CsvRow> rowsOf(const std::string& content) {
  const test::TemporaryFile file{content};
  CsvReader reader{file.path()};
  std::vector<CsvRow> rows;
  for (CsvRow row; reader.next(row);) rows.push_back(row);
  return rows;
}

TEST(CsvReader, ReadsEveryLineEndingQuotesAndByteOrderMark) {
  for (const char* end : {"\n", "\r\n", "\r"}) {
    const std::string e = end;
    const test::TemporaryFile file{"\xEF\xBB\xBF\"a\", b ,c" + e + "1,\"x, \"\"y\"\"\",3" + e + e + "4,,6" +
                                   e};
    CsvReader reader{file.path()};
    EXPECT_THAT(reader.header(), ElementsAre("a", "b", "c"));
    CsvRow row;
    ASSERT_TRUE(reader.next(row));
    EXPECT_THAT(row.fields, ElementsAre("1", "x, \"y\"", "3"));
    EXPECT_EQ(row.line, 2U);
    ASSERT_TRUE(reader.next(row));
    EXPECT_THAT(row.fields, ElementsAre("4", "", "6"));
    EXPECT_EQ(row.line, 4U);
    EXPECT_FALSE(reader.next(row));
  }
}

// A row of units below the header names the columns; one with a number is data, and a contradiction is refused.
TEST(CsvReader, RowOfUnitsIsPartOfTheHeader) {
  const test::TemporaryFile file{"load,slip,speed,torque,note\nkN,%,[m/s],N m,-\n0.06,10,0.1,2,a\n"};
  CsvReader reader{file.path()};
  EXPECT_THAT(reader.header(), ElementsAre("load_kN", "slip_percent", "speed_m_s", "torque_Nm", "note"));
  CsvRow row;
  ASSERT_TRUE(reader.next(row));
  EXPECT_EQ(row.line, 3U);
  EXPECT_EQ(rowsOf("load_N,note\n60,m\n")[0].fields, (std::vector<std::string>{"60", "m"}));
  EXPECT_EQ(rowsOf("run,note\na,b\n").size(), 1U);
  EXPECT_THROW(rowsOf("load_N,slip\nkN,-\n60,0.1\n"), InputError);
}

// Property: a repeated byte order mark is skipped; otherwise it would be part of the first column's name.
TEST(CsvReader, RepeatedByteOrderMarksAreSkipped) {
  const test::TemporaryFile file{"\xEF\xBB\xBF\xEF\xBB\xBFslip,load_N\n0.1,20\n"};
  EXPECT_THAT(CsvReader{file.path()}.header(), ElementsAre("slip", "load_N"));
}

TEST(CsvReader, CommentsAndColumnsDividedByBlanksAreRead) {
  const test::TemporaryFile file{"# rig A, day 2\n#\nload_N  slip\n 60 0.1\n# pause\n80   0.3 \n90\n"};
  CsvReader reader{file.path()};
  EXPECT_THAT(reader.header(), ElementsAre("load_N", "slip"));
  CsvRow row;
  ASSERT_TRUE(reader.next(row));
  EXPECT_THAT(row.fields, ElementsAre("60", "0.1"));
  EXPECT_EQ(row.line, 4U);
  ASSERT_TRUE(reader.next(row));
  EXPECT_THAT(row.fields, ElementsAre("80", "0.3"));
  EXPECT_EQ(row.line, 6U);
  ASSERT_TRUE(reader.next(row));
  EXPECT_EQ(row.fault, "has 1 fields, the header 2");
  // Property: a row of data whose first field begins with # is no comment.
  EXPECT_THAT(rowsOf("run,slip\n#1,0.2\n")[0].fields, ElementsAre("#1", "0.2"));
}

TEST(CsvReader, CountsLinesInsideQuotes) {
  const auto rows = rowsOf("a,b\n\"1\n2\",3\n4,5\n");
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].line, 2U);
  EXPECT_EQ(rows[1].line, 4U);
}

TEST(CsvReader, ReportsFieldCountAndRepeatedHeaderFaults) {
  const auto rows = rowsOf("a,b\n1\n1,2,3\n1,2,\na,b\n1,2\n7");
  ASSERT_EQ(rows.size(), 6U);
  EXPECT_EQ(rows[0].fault, "has 1 fields, the header 2");
  EXPECT_EQ(rows[1].fault, "has 3 fields, the header 2");
  EXPECT_EQ(rows[2].fault, "");  // a comma at the end of the line
  EXPECT_EQ(rows[3].fault, "repeats the header");
  EXPECT_EQ(rows[4].fault, "");
  EXPECT_EQ(rows[5].fault, "has 1 fields, the header 2");
}

std::string readError(const std::string& path) {
  try {
    CsvReader reader{path};
    CsvRow row;
    while (reader.next(row)) {
    }
  } catch (const InputError& e) {
    return e.what();
  }
  return "no error";
}

// Property: rows after an unbalanced quote are reported, with and without a later closing quote.
TEST(CsvReader, UnbalancedQuoteSpanningRowsIsRejected) {
  std::string many = "a,b\n1,2\n3,\"4\n";
  for (int k = 0; k < 20000; ++k) many += "5,6\n";
  for (const std::string& text :
       {std::string("a,b\n1,2\n3,\"4\n5,6\n"), std::string("a,b\n1,2\n\"3,4\n5,6\n\"7,8\n"),
        std::string("a,b\r1,2\r\"3,4\r5,6\r7\",8\r"), many}) {
    const test::TemporaryFile file{text};
    EXPECT_THAT(readError(file.path()), HasSubstr(":3: a quote of this line holds the rows behind it"))
        << text.substr(0, 40);
  }
}

TEST(CsvReader, MissingEmptyAndAmbiguousFilesAreRejected) {
  EXPECT_THAT(readError("/nowhere/at_all.csv"), HasSubstr("/nowhere/at_all.csv: No such file"));
  EXPECT_THAT(readError("/tmp"), HasSubstr("is a directory"));
  const test::TemporaryFile nothing{""}, empty{"\n\n"}, twice{"a,b,a\n"};
  EXPECT_THAT(readError(nothing.path()), HasSubstr("is empty; the first row names the columns"));
  EXPECT_THAT(readError(empty.path()), HasSubstr("is empty"));
  EXPECT_THAT(readError(twice.path()), HasSubstr(":1: column a appears twice"));
  std::string wide = "c0";
  for (int k = 1; k <= 1000; ++k) wide += ",c" + std::to_string(k);
  const test::TemporaryFile columns{wide + '\n'};
  EXPECT_THAT(readError(columns.path()), HasSubstr("has 1001 columns, at most 1000"));
  const test::TemporaryFile binary{std::string("a\0b\n", 4)};
  EXPECT_THAT(readError(binary.path()), HasSubstr("is not text"));
}

// Property: the formats of spreadsheets with semicolons, tabs and decimal commas are read.
TEST(CsvReader, ReadsSemicolonsTabsAndDecimalCommas) {
  for (const std::string part : {";", "\t"}) {
    const auto rows = rowsOf("a" + part + "b" + part + "c\n1,5" + part + "-2,25e1" + part + "some, words\n" +
                             "3" + part + "4.5" + part + "1,2,3\n");
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_THAT(rows[0].fields, ElementsAre("1.5", "-2.25e1", "some, words"));
    EXPECT_THAT(rows[1].fields, ElementsAre("3", "4.5", "1,2,3"));
  }
  // The header determines the separator, here a comma.
  EXPECT_THAT(rowsOf("a,b;c\n1,5\n").front().fields, ElementsAre("1", "5"));
}

TEST(CsvReader, ReadsFilesLargerThanItsBuffer) {
  std::string content = "k,word\n";
  for (int k = 0; k < 20000; ++k) content += std::to_string(k) + ",\"some words\"\n";
  const auto rows = rowsOf(content);
  ASSERT_EQ(rows.size(), 20000U);
  EXPECT_EQ(rows.back().fields[0], "19999");
  EXPECT_EQ(rows.back().line, 20001U);
}

TEST(ParseNumber, ParsesCompleteFieldsOnly) {
  double value = 0.0;
  EXPECT_TRUE(parseNumber("-2.5e3", value));
  EXPECT_EQ(value, -2500.0);
  EXPECT_TRUE(parseNumber("+4", value));
  EXPECT_TRUE(parseNumber("nan", value));
  EXPECT_TRUE(std::isnan(value));
  for (const char* bad : {"", "1,5", "3 m", "0x10", "--1", "one"})
    EXPECT_FALSE(parseNumber(bad, value)) << bad;
}

TEST(CsvField, QuotesOnlyWhereNeeded) {
  EXPECT_EQ(csvField("plain"), "plain");
  EXPECT_EQ(csvField("a,b"), "\"a,b\"");
  EXPECT_EQ(csvField("say \"so\""), "\"say \"\"so\"\"\"");
  EXPECT_EQ(csvField(" x"), "\" x\"");
}

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

Telemetry read(const std::string& content, const TelemetryOptions& options = {}) {
  const test::TemporaryFile file{content};
  return readTelemetry(file.path(), options);
}

std::string errorOf(const std::string& content, const TelemetryOptions& options = {}) {
  try {
    read(content, options);
  } catch (const InputError& e) {
    return e.what();
  }
  return "no error";
}

TEST(TelemetryReader, KeepsEveryColumnInAnyOrder) {
  const Telemetry t = read("note,slip,moisture,load_N,run,wheel\nwet,0.2,3.5,80,1,2\ndry,-1,,81,2,FL\n");
  EXPECT_THAT(t.at("slip"), ElementsAre(0.2, -1.0));
  EXPECT_THAT(*t.findWords("note"), ElementsAre("wet", "dry"));
  EXPECT_THAT(*t.findWords("run"), ElementsAre("1", "2"));
  EXPECT_EQ(t.at("moisture")[0], 3.5);
  EXPECT_TRUE(std::isnan(t.at("moisture")[1]));
  EXPECT_EQ(t.find("torque_Nm"), nullptr);
  EXPECT_THAT(t.lines, ElementsAre(2, 3));
}

// Property: physically impossible readings are rejected.
TEST(TelemetryReader, RejectsPhysicallyImpossibleValues) {
  for (const char* column :
       {"slope_rad=1.5708", "slope_rad=-10", "roll_rad=2", "pass_index=-1", "pass_index=0.5",
        "pass_index=1e15", "x_m=1e15", "y_m=-1e10", "z_m=1e12", "wheel_width_m=1e15", "wheel_width_m=1e-12",
        "grouser_height_m=3", "grouser_count=1e9", "shear_modulus_m=1e15"}) {
    const std::string text = column;
    const std::size_t at = text.find('=');
    const Telemetry t = read("load_N," + text.substr(0, at) + "\n80," + text.substr(at + 1) + "\n80,\n");
    ASSERT_EQ(t.rejected.size(), 1U) << text;
    EXPECT_EQ(t.rejected[0].line, 2U);
  }
}

// Property: a column in percent or degrees is refused, not thinned out to its small values; the unit that an option
// states is taken; single faults are rows that are left out.
TEST(TelemetryReader, PercentAndDegreesAreRefusedWithTheOptionThatReadsThem) {
  const auto column = [](const std::string& name, std::initializer_list<double> values) {
    std::string text = "load_N," + name + "\n";
    for (const double v : values) text += "80," + std::to_string(v) + "\n";
    return text;
  };
  const std::string gentle = column("slip", {0.7, 0.4, 0.9, 5, 0.8, 0.5, 12, 1.1, 2.2, 3});
  EXPECT_THAT(errorOf(gentle),
              HasSubstr("column slip: 4 of 10 values lie beyond 1.6, as percent do; pass --column "
                        "slip=slip:percent, or slip=slip:ratio if"));
  EXPECT_THAT(errorOf(column("slope_rad", {10, 1, 14, -12})),
              HasSubstr("pass --column slope_rad=slope_rad:deg"));
  EXPECT_THAT(errorOf(column("heading_rad", {90, 91, 90})), HasSubstr("heading_rad=heading_rad:deg"));
  for (const auto& [factor, unit] : {std::pair{1e3, "ms"}, {1e6, "us"}, {1e9, "ns"}})
    EXPECT_THAT(errorOf(column("time_s", {1.7e9 * factor, 1.8e9 * factor})),
                HasSubstr("--column time_s=time_s:" + std::string(unit) + ","));
  const test::TemporaryFile file{gentle};
  TableFile table(file.path());
  table.columns = {{.known = "slip", .name = "slip", .unit = "percent"}};
  EXPECT_NEAR(readTelemetry(table).at("slip").back(), 0.03, 1e-15);
  table.columns = {{.known = "slip", .name = "slip", .unit = "ratio"}};
  EXPECT_EQ(readTelemetry(table).rejected.size(), 5U);
  EXPECT_EQ(read(column("slip", {0.12, 0.35, 40, 0.08})).rejected.size(), 1U);
}

TEST(TelemetryReader, RejectedRowsHaveLineAndReason) {
  struct Case {
    const char* row;
    const char* reason;
  };
  const std::string good = "80,0.02,0.3,0.1\n";
  for (const Case& c : {Case{"0,0.02,0.3,0.1", "load_N = 0, must be > 0 and at most 1e7"},
                        {"1e12,0.02,0.3,0.1", "load_N = 1e12, must be > 0 and at most 1e7"},
                        {"nan,0.02,0.3,0.1", "load_N = nan, must be finite"},
                        {"80,0.02,inf,0.1", "slip = inf, must be finite"},
                        {"80,-0.001,0.3,0.1", "sinkage_m = -0.001, must be >= 0"},
                        {"80,0.2,0.3,0.1", "sinkage_m = 0.2, must be < the wheel's diameter, 0.2"},
                        {"80,0.02,1.01,0.1", "slip = 1.01, must be in [-1, 1]"},
                        {"80,0.02,-1.01,0.1", "slip = -1.01, must be in [-1, 1]"},
                        {"80,0.02,0.3,-0.1", "wheel_radius_m = -0.1, must be in [0.001, 10]"},
                        {"80,0.02,0.3,1e14", "wheel_radius_m = 1e14, must be in [0.001, 10]"},
                        {"heavy,0.02,0.3,0.1", "load_N = 'heavy', must be a number"},
                        {"80,0.02", "has 2 fields, the header 4"},
                        {"load_N,sinkage_m,slip,wheel_radius_m", "repeats the header"}}) {
    const Telemetry t = read("load_N,sinkage_m,slip,wheel_radius_m\n" + good + c.row + "\n" + good);
    ASSERT_EQ(t.rejected.size(), 1U) << c.row;
    EXPECT_EQ(t.rejected[0].line, 3U);
    EXPECT_EQ(t.rejected[0].reason, c.reason);
    EXPECT_EQ(t.size(), 2U);
  }
}

// Measured by others: a wheel pulled across its travel reads up to 1.576 rad.
TEST(TelemetryReader, SlipAngleIsLimitedToARightAngle) {
  const Telemetry t = read("load_N,slip_angle_rad\n80,1.576\n80,-1.576\n80,1.61\n80,-3.14159\n");
  EXPECT_EQ(t.size(), 2U);
  ASSERT_EQ(t.rejected.size(), 2U);
  EXPECT_EQ(t.rejected[0].line, 4U);
  EXPECT_EQ(t.rejected[0].reason, "slip_angle_rad = 1.61, must be in [-1.6, 1.6]");
}

TEST(TelemetryReader, KeepsTheNumbersOfRejectedRows) {
  const Telemetry t =
      read("load_N,slip,note,sinkage_m\n80,0.1,a,0\n80,inf,b,x\n80,0.2,c,0\nnan,0.9,d,-1\n80\n");
  ASSERT_EQ(t.rejected.size(), 3U);
  ASSERT_EQ(t.rejected_numbers.size(), 3U) << "known columns";
  EXPECT_EQ(t.rejected_numbers[1].name, "slip");
  EXPECT_EQ(t.rejected_numbers[1].values[0], std::numeric_limits<double>::infinity());
  EXPECT_EQ(t.rejected_numbers[1].values[1], 0.9);
  EXPECT_TRUE(std::isnan(t.rejected_numbers[1].values[2])) << "the row is cut short";
  EXPECT_TRUE(std::isnan(t.rejected_numbers[0].values[1]));
  EXPECT_TRUE(std::isnan(t.rejected_numbers[2].values[0])) << "a word";
  EXPECT_EQ(t.rejected_numbers[2].values[1], -1.0);
}

TEST(TelemetryReader, NumbersBeyondDoubleRangeSaturateInRejectedRows) {
  const auto t = read("load_N,slip,sinkage_m\n1,0.1,1e999\n1,-1e400,0\n1,1e300,0\n-1,1e-999,0x\n1,0.5,0\n");
  constexpr double kMost = std::numeric_limits<double>::max();
  ASSERT_EQ(t.rejected.size(), 4U);
  EXPECT_EQ(t.rejected_numbers[2].values[0], kMost);
  EXPECT_EQ(t.rejected_numbers[1].values[1], -kMost);
  EXPECT_EQ(t.rejected_numbers[1].values[2], 1e300);
  EXPECT_EQ(t.rejected_numbers[1].values[3], 0.0);
  EXPECT_TRUE(std::isnan(t.rejected_numbers[2].values[3])) << "a word";
}

TEST(TelemetryReader, RangeLimitsAreInclusive) {
  const Telemetry t = read("slip,sinkage_m\n1,0\n-1,0.1\n");
  EXPECT_EQ(t.size(), 2U);
  EXPECT_EQ(t.rejected.size(), 0U);
}

TEST(TelemetryReader, RoundingNoiseIsReadAsZero) {
  const Telemetry t = read("pitch_rad,load_N\n4.3e-18,10\n-1e-300,10\n0.1,1e-300\n");
  ASSERT_EQ(t.size(), 2U);
  EXPECT_EQ(t.at("pitch_rad")[0], 0.0);
  EXPECT_EQ(t.at("pitch_rad")[1], 0.0);
  ASSERT_EQ(t.rejected.size(), 1U);
  EXPECT_EQ(t.rejected[0].reason, "load_N = 1e-300, must be > 0 and at most 1e7");
}

TEST(TelemetryReader, RejectsTruncatedLastRow) {
  const Telemetry t = read("load_N,slip,torque_Nm\n80,0.2,1\n80,0.");
  EXPECT_EQ(t.size(), 1U);
  EXPECT_EQ(t.rejected[0].line, 3U);
}

TEST(TelemetryReader, RequiredColumnsMustBePresentInEveryRow) {
  EXPECT_THAT(errorOf("slip\n0.1\n", {.required = {"slip", "load_N", "torque_Nm"}}),
              HasSubstr(":1: no column load_N, torque_Nm"));
  const Telemetry t = read("slip,load_N\n0.1,\n0.2,80\n", {.required = {"slip", "load_N"}});
  EXPECT_EQ(t.rejected[0].reason, "load_N is empty");
  EXPECT_EQ(t.size(), 1U);
}

TEST(TelemetryReader, GivenRadiusIsUsedIfTheFileHasNone) {
  EXPECT_THAT(errorOf("sinkage_m\n0.3\n", {.required = {}, .wheel_radius_m = 0.1}),
              HasSubstr("must be < the wheel's"));
  EXPECT_EQ(read("sinkage_m\n0.3\n").size(), 1U);
}

TEST(TelemetryReader, FileWithoutUsableRowIsRejected) {
  EXPECT_THAT(errorOf("load_N\n"), HasSubstr("no rows after the header"));
  EXPECT_THAT(errorOf("load_N\n-1\n-2\n"),
              HasSubstr(":2: no usable row; 2 refused, this one because load_N = -1"));
}

TEST(TelemetryReader, ReportsProgressAndStopsOnRequest) {
  std::string content = "slip\n";
  for (int k = 0; k < 200000; ++k) content += "0.5\n";
  const test::TemporaryFile file{content};
  std::stop_source stop;
  double last = 0.0;
  const ProgressMonitor watch{[&](double fraction) {
                                EXPECT_GE(fraction, last);
                                last = fraction;
                                if (fraction > 0.3) stop.request_stop();
                              },
                              stop.get_token()};
  EXPECT_LT(readTelemetry(file.path(), {}, watch).size(), 200000U);
  EXPECT_GT(last, 0.3);
}

// Property: on request, repeated rows of a log with overlapping parts count once.
TEST(TelemetryReader, RepeatedRowsAreCountedOnceOnRequest) {
  const std::string part = "1,80,0.1\n2,81,0.2\n2,81,0.2\n3,-82,0.3\n", header = "time_s,load_N,slip\n";
  const Telemetry once = read(header + part + part + "1,80,0.4\n", {.once = true});
  // Two different rows of one time may belong to two wheels.
  EXPECT_THAT(once.at("slip"), ElementsAre(0.1, 0.2, 0.2, 0.4));
  EXPECT_THAT(once.lines, ElementsAre(2, 3, 4, 10));
  EXPECT_EQ(once.rejected.size(), 1U);
  EXPECT_EQ(once.repeated, 4U);
  EXPECT_EQ(read(header + part + part).size(), 6U);
  // Without a time column any row may be a repeated measurement.
  EXPECT_EQ(read("load_N,slip\n80,0.1\n81,0.2\n80,0.1\n", {.once = true}).size(), 3U);
  const std::string named = "time_s,wheel,load_N,slip\n1,a,80,0.1\n1,b,80,0.1\n1,a,80,0.1\n";
  EXPECT_THAT(read(named, {.once = true}).lines, ElementsAre(2, 3));
}

TEST(TelemetryReader, MeasuredDataFilesAreRead) {
  const char* folder = std::getenv("TALUS_MEASURED_DATA");
  TALUS_REQUIRE(folder != nullptr, "TALUS_MEASURED_DATA is not set");
  const Telemetry ding = readTelemetry(std::string(folder) + "/single_wheel_digitised/points.csv");
  EXPECT_EQ(ding.size() + ding.rejected.size(), 11U);
  const Telemetry cmu = readTelemetry(std::string(folder) + "/cmu_testbed/runs.csv");
  EXPECT_EQ(cmu.size() + cmu.rejected.size(), 216U);
}

}  // namespace csv_reader_test
}  // namespace talus::terramech
