#include <algorithm>
#include <cmath>

#include <site_map.hpp>

#include <talus/costmap/costmap.hpp>
#include <talus/costmap/ground/cost_curve_table.hpp>
#include <talus/costmap/telemetry/telemetry_processor.hpp>

namespace talus::costmap {
namespace explanation_test {

using terramech::Category;

const Cause& cause(const Explanation& explanation, const std::string& name) {
  const auto found = std::find_if(explanation.causes.begin(), explanation.causes.end(),
                                  [&](const Cause& c) { return c.name == name; });
  if (found == explanation.causes.end()) throw std::out_of_range(name);
  return *found;
}

const std::vector<std::string> kPlain(12, "111111111111");

TEST(Explain, SafeCellListsItsCauses) {
  const Explanation e = explain(mapOf(kPlain, 0.05), {6, 6});
  EXPECT_EQ(e.category, Category::Safe);
  // Closed form: the given plane. Tolerance: heights of 1000 m are stored as floats, 6e-5 m apart.
  EXPECT_NEAR(cause(e, "slope_rad").value, std::atan(0.05), 1e-4);
  EXPECT_NEAR(cause(e, "slope_along_rad").value, std::atan(0.05),
              1e-3);  // the slope is stored in steps of 1/1024
  EXPECT_EQ(cause(e, "evidence_samples").value, 0.0);
  EXPECT_GT(cause(e, "drawbar_pull_over_load").std, 0.0);
}

TEST(Explain, CategoryDependsOnHeading) {
  const TraversabilityMap map = mapOf(kPlain, 0.2);
  const Explanation up = explain(map, {6, 6}, Direction{1, 0});
  const Explanation down = explain(map, {6, 6}, Direction{-1, 0});
  EXPECT_LT(cause(down, "energy_J_per_m").value, cause(up, "energy_J_per_m").value);
  EXPECT_NE(up.category, Category::Safe);
  EXPECT_EQ(down.category, Category::Safe);
}

// Property: without a heading the category is that of the map, also for refused cells, and no better than in
// the worst heading.
TEST(Explain, CategoryWithoutHeadingIsThatOfTheMapAndWorstHeading) {
  for (int k = 0; k < 30; ++k) {
    const TraversabilityMap map = mapOf(kPlain, 0.0133 * k);
    const Explanation cell = explain(map, {6, 6});
    const Direction worst = worstHeading(map.published()->cost(), map.published()->at({6, 6}));
    EXPECT_EQ(static_cast<std::uint8_t>(cell.category), map.costs().category({6, 6})) << k;
    EXPECT_GE(cell.category, explain(map, {6, 6}, worst).category) << k;
    EXPECT_EQ(cell.verdict.find(terramech::name(cell.category)), 0U) << cell.verdict;
    const bool refused = cell.verdict.find("; refused") != std::string::npos;
    EXPECT_TRUE(!refused || cell.category == Category::Dangerous) << cell.verdict;
  }
}

TEST(Explain, VerdictNamesTheHazard) {
  std::vector<std::string> site = kPlain;
  site[5][6] = '#';
  const Explanation e = explain(mapOf(site), {6, 6});
  EXPECT_EQ(e.category, Category::Dangerous);
  EXPECT_NE(e.verdict.find("keep-out"), std::string::npos);
}

TEST(Explain, UnseenCellIsUnknown) {
  std::vector<std::string> site = kPlain;
  site[5][6] = '?';
  const Explanation unseen = explain(mapOf(site), {6, 6});
  EXPECT_EQ(unseen.category, Category::Unknown);
  EXPECT_TRUE(std::isnan(unseen.probability)) << "Unknown has none";
}

// Property: for an unseen cell that the policy opens, the explanation states the policy and the assumed
// ground.
TEST(Explain, UnseenCellOpenedByPolicyIsReported) {
  std::vector<std::string> site = kPlain;
  site[5][6] = '?';
  const Explanation open = explain(mapOf(site, 0.0, {.allow_unknown = true}), {6, 6});
  EXPECT_NE(open.category, Category::Unknown);
  EXPECT_NE(open.verdict.find("unknown; allowed on request, at the slope between the heights beside it, as"),
            std::string::npos)
      << open.verdict;
  EXPECT_EQ(cause(open, "hazard").remark, "not excluded");
}

// Property: immobilisation evidence on an unseen cell refuses the cell, and the explanation states the
// evidence, whether or not the policy opens the cell.
TEST(Explain, UnseenCellWithImmobilisationEvidenceIsRefused) {
  std::vector<std::string> site = kPlain;
  site[5][6] = '?';
  TraversabilityMap map = mapOf(site, 0.0, {.allow_unknown = true});
  WheelObservation spun{.time_s = 1.0, .place = map.grid().centre({6, 6}), .pull = {}, .sinkage = {}};
  spun.here.most_pull = -0.4;
  ASSERT_TRUE(map.learn(boundAlone(spun)));
  map.publish();
  const Explanation held = explain(map, {6, 6});
  EXPECT_EQ(held.category, Category::Dangerous);
  EXPECT_NE(held.verdict.find("refused"), std::string::npos) << held.verdict;
  EXPECT_NE(held.verdict.find("allowed on request"), std::string::npos) << held.verdict;
  EXPECT_EQ(cause(held, "evidence_samples").remark.find("prior only"), std::string::npos);
}

// Property: a place to drive to next is allowed, and a reading there reduces the expected deviation of ground that
// is not safe; on ground that is safe in every heading there is none.
TEST(Explain, NextDriveReducesTheDeviationOfUnsafeGround) {
  EXPECT_FALSE(nextDrive(mapOf(kPlain), {6, 6}).has_value());
  const TraversabilityMap steep = mapOf(kPlain, 0.2);
  const auto next = nextDrive(steep, {6, 6});
  ASSERT_TRUE(next.has_value());
  EXPECT_TRUE(std::isfinite(
      steep.published()->cost().costPerMetre(steep.published()->at(next->cell), next->heading)));
  EXPECT_LT(next->after, next->std);
}

}  // namespace explanation_test
}  // namespace talus::costmap
