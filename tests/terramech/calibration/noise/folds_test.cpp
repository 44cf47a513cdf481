#include <cmath>
#include <map>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include <talus/terramech/calibration/noise/folds.hpp>

#include "made_rows.hpp"

namespace talus::terramech {
namespace folds_test {

Trial trialOf(const MadeRows& rows, const std::string& column = "") {
  return makeTrial(rows.telemetry(column), RefinedModel{});
}

/// Expects that all rows with one value of the key are in one fold, and each row in a valid fold.
void expectWhole(const Folds& folds, const std::vector<double>& key) {
  std::map<double, std::set<int>> seen;
  ASSERT_EQ(folds.of_row.size(), key.size());
  for (std::size_t row = 0; row < key.size(); ++row) {
    seen[key[row]].insert(folds.of_row[row]);
    EXPECT_GE(folds.of_row[row], 0);
    EXPECT_LT(folds.of_row[row], folds.count);
  }
  for (const auto& [value, in] : seen) EXPECT_EQ(in.size(), 1U) << value;
  EXPECT_GT(seen.size(), 1U);
}

TEST(Folds, RowsOfARunStayTogether) {
  MadeRows rows(wheelColumns());
  std::mt19937_64 random{1};
  std::vector<double> run;
  for (int k = 0; k < 60; ++k) {
    run.push_back(k % 7);
    rows.add({50.0, 0.1 + 0.01 * k, 1.0, 0.01, 5.0, 0.1, 0.1}, "run" + std::to_string(k % 7));
  }
  const Folds folds = foldsOf(trialOf(rows, "run"));
  EXPECT_NE(folds.scheme.find("runs"), std::string::npos);
  expectWhole(folds, run);
}

TEST(Folds, SlipLevelsStayTogether) {
  MadeRows rows(wheelColumns());
  std::vector<double> slip;
  for (int k = 0; k < 48; ++k) {
    slip.push_back(0.1 * (k % 6 + 1));
    rows.add({40.0 + k, slip.back(), 1.0, 0.01, 5.0, 0.1, 0.1});
  }
  const Folds folds = foldsOf(trialOf(rows));
  EXPECT_NE(folds.scheme.find("slip levels"), std::string::npos);
  expectWhole(folds, slip);
}

TEST(Folds, LevelsOfSignedColumnAreHeldOutOneByOne) {
  std::vector<std::string> columns = wheelColumns();
  columns.emplace_back("slip_angle_rad");
  MadeRows rows(columns);
  std::vector<double> angle;
  for (int k = 0; k < 40; ++k) {
    angle.push_back(0.25 * (k % 4));
    rows.add({50.0, 0.3, 1.0, 0.01, 5.0, 0.1, 0.1, k % 8 < 4 ? angle.back() : -angle.back()});
  }
  const Folds folds = levelFolds(trialOf(rows), "slip_angle_rad");
  EXPECT_EQ(folds.count, 4);
  expectWhole(folds, angle);
  EXPECT_EQ(levelFolds(trialOf(rows), "load_N").count, 0);  // a single level
}

TEST(Folds, HeldOutAndTrainingRowsAreComplementary) {
  const Folds folds{"", {0, 1, 0, 2}, 3};
  EXPECT_EQ(rowsOf(folds, 0, true), (std::vector<char>{1, 0, 1, 0}));
  EXPECT_EQ(rowsOf(folds, 0, false), (std::vector<char>{0, 1, 0, 1}));
}

}  // namespace folds_test
}  // namespace talus::terramech
