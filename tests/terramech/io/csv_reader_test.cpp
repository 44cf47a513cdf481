#include <cmath>

#include <talus/common/common.hpp>
#include <talus/terramech/io/csv_reader.hpp>

#include "temporary_file.hpp"

namespace talus::terramech {
namespace csv_reader_test {

using testing::ElementsAre;
using testing::HasSubstr;

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

std::string errorOf(const std::string& path) {
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
    EXPECT_THAT(errorOf(file.path()), HasSubstr(":3: a quote of this line holds the rows behind it"))
        << text.substr(0, 40);
  }
}

TEST(CsvReader, MissingEmptyAndAmbiguousFilesAreRejected) {
  EXPECT_THAT(errorOf("/nowhere/at_all.csv"), HasSubstr("/nowhere/at_all.csv: No such file"));
  EXPECT_THAT(errorOf("/tmp"), HasSubstr("is a directory"));
  const test::TemporaryFile nothing{""}, empty{"\n\n"}, twice{"a,b,a\n"};
  EXPECT_THAT(errorOf(nothing.path()), HasSubstr("is empty; the first row names the columns"));
  EXPECT_THAT(errorOf(empty.path()), HasSubstr("is empty"));
  EXPECT_THAT(errorOf(twice.path()), HasSubstr(":1: column a appears twice"));
  std::string wide = "c0";
  for (int k = 1; k <= 1000; ++k) wide += ",c" + std::to_string(k);
  const test::TemporaryFile columns{wide + '\n'};
  EXPECT_THAT(errorOf(columns.path()), HasSubstr("has 1001 columns, at most 1000"));
  const test::TemporaryFile binary{std::string("a\0b\n", 4)};
  EXPECT_THAT(errorOf(binary.path()), HasSubstr("is not text"));
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

}  // namespace csv_reader_test
}  // namespace talus::terramech
