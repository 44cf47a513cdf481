#include <fstream>

#include <nlohmann/json.hpp>

#include <talus/terramech/mobility/category.hpp>

#include "reference_table.hpp"

namespace talus::terramech {
namespace {

std::optional<double> numberOrNone(const nlohmann::json& value) {
  return value.is_null() ? std::nullopt : std::optional{value.get<double>()};
}

TEST(CategoryCases, AgreeWithTheReferenceOnEveryEdge) {
  if (test::referenceFolder().empty()) GTEST_SKIP() << "TALUS_REFERENCE is not set";
  std::ifstream file(test::referenceFolder() + "/category_cases.json");
  for (const auto& c : nlohmann::json::parse(file)) {
    const CategoryThresholds limits{.dp_low = c["dp_low"],
                                    .dp_high = c["dp_high"],
                                    .z_threshold = c["z_threshold"],
                                    .z_critical = c["z_critical"],
                                    .t_threshold = numberOrNone(c["t_threshold"]),
                                    .t_critical = numberOrNone(c["t_critical"])};
    const Category got = categorise({.drawbar_pull_over_load = c["dp_over_w"],
                                     .sinkage_over_radius = c["z_over_r"],
                                     .torque_over_load_radius = numberOrNone(c["t_over_rw"])},
                                    limits);
    EXPECT_EQ(name(got), c["category"].get<std::string>())
        << c.dump();  // Closed form: the rule by another hand.
  }
}

}  // namespace
}  // namespace talus::terramech
