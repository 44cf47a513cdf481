#include <talus/terramech/mobility/category.hpp>

#include "reference_table.hpp"

namespace talus::terramech {
namespace category_reference_test {

std::optional<double> numberOrNone(const test::ReferenceRow& row, const std::string& column) {
  return row.has(column) ? std::optional{row[column]} : std::nullopt;
}

TEST(CategoryReference, MatchesTheReferenceOnEveryThreshold) {
  const auto rows = test::referenceTable("category_edges");
  EXPECT_EQ(rows.size(), 34u);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto& row = rows[k];
    const CategoryThresholds limits{.dp_low = row["dp_low"],
                                    .dp_high = row["dp_high"],
                                    .z_threshold = row["z_threshold"],
                                    .z_critical = row["z_critical"],
                                    .t_threshold = numberOrNone(row, "t_threshold"),
                                    .t_critical = numberOrNone(row, "t_critical")};
    const Category got = categorise({.drawbar_pull_over_load = row["drawbar_pull_over_load"],
                                     .sinkage_over_radius = row["sinkage_over_radius"],
                                     .torque_over_load_radius = numberOrNone(row, "torque_over_load_radius")},
                                    limits);
    EXPECT_EQ(name(got), row.text("category")) << "row " << k;  // Closed form: an independent implementation.
  }
}

}  // namespace category_reference_test
}  // namespace talus::terramech
