#include <algorithm>
#include <cmath>
#include <set>

#include <nlohmann/json.hpp>

#include <talus/cli/app/context.hpp>
#include <talus/cli/draw/page.hpp>
#include <talus/cli/ground/ground_options.hpp>
#include <talus/common/common.hpp>
#include <talus/costmap/costmap.hpp>

#include "bad_input.hpp"
#include "browser.hpp"
#include "requirement.hpp"
#include "run_program.hpp"

namespace talus::cli {
namespace heading_costs_test {

// A site with slopes below and above the climbing limit, an area without data and a step.
Ground steepSite(const Folder& folder) {
  folder.write("steep.asc", asciiGrid(60, 50, [](int column, int row) {
                 const bool hole = column > 50 && row > 40;
                 return hole ? -9999.0 : (1.0 + row / 25.0) * std::sin(column / 6.0) + (column == 30 ? 2 : 0);
               }));
  GroundOptions options;
  options.elevation.path = folder / "steep.asc";
  options.elevation.read.resolution_m = 1.0;
  options.soil = "sandy_loam";
  options.rover = "fido";
  Context context;
  context.quiet = true;
  return readGround(options, context);
}

// For each cell of the page, top row first: category, and cost in eight headings (null if refused).
nlohmann::json answersOf(const Scene& scene) {
  const Shown shown = show(played(scene, R"((async () => {
    const data = JSON.parse(document.getElementById("data").textContent), read = await readHeadings(data);
    const costs = index => [0, 1, 2, 3, 4, 5, 6, 7].map(k => headingCost(read, index, k * Math.PI / 4 + 0.1));
    const cells = Array.from(read.kinds, (kind, i) => [data.categories[kind >> 16].label, ...costs(i)]);
    const box = document.body.appendChild(document.createElement("pre"));
    box.id = "answers";
    box.textContent = JSON.stringify(cells);
  })();)"));
  const std::string begin = "id=\"answers\">";
  const auto at = shown.dom.find(begin);
  EXPECT_NE(at, std::string::npos) << shown.console;
  const auto from = at + begin.size();
  return nlohmann::json::parse(shown.dom.substr(from, shown.dom.find("</pre>", from) - from));
}

// Cost of `talus explain`; infinite if the heading is refused or the ground is unknown.
double explainedCost(const Ground& site, maps::Cell cell, double heading) {
  for (const costmap::Cause& cause :
       costmap::explain(site.map, cell, costmap::Direction{std::cos(heading), std::sin(heading)}).causes)
    if (cause.name == "cost_J_per_m") return cause.value;
  return INFINITY;
}

// Property: category and cost per heading equal those of `talus explain`, including refusals. A page cell
// that covers several map cells has the values of the map cell at its centre.
TEST(HeadingCosts, PageValuesEqualThoseOfExplain) {
  TALUS_REQUIRE(test::installed("chromium"), "chromium is not installed");
  const Folder folder;
  const Ground site = steepSite(folder);
  for (const int side : {60, 20}) {
    const auto answers = answersOf(sceneOf(site.map, {.title = "steep", .max_side = side}));
    const int block = 60 / side, width = 60 / block, height = (50 + block - 1) / block;
    std::set<std::string> categories;
    int refused = 0;
    for (int i = 0; i < width * height; i += 7) {
      const int row = height - 1 - i / width;
      const maps::Cell cell{i % width * block + block / 2, std::min(49, row * block + block / 2)};
      const auto& answer = answers.at(static_cast<std::size_t>(i));
      ASSERT_EQ(answer.at(0), terramech::name(costmap::explain(site.map, cell).category)) << i;
      categories.insert(answer.at(0));
      for (std::size_t k = 0; k < 8; ++k) {
        const double cost = explainedCost(site, cell, static_cast<double>(k) * 45.0 * kDegree + 0.1);
        ASSERT_EQ(answer.at(k + 1).is_number(), std::isfinite(cost)) << i << ' ' << k;
        refused += std::isfinite(cost) ? 0 : 1;
        if (!std::isfinite(cost)) continue;
        // Tolerance: 24-bit words on a logarithmic scale, and rounding to float.
        ASSERT_NEAR(answer.at(k + 1).get<double>() / cost, 1.0, 1e-5) << i << ' ' << k;
      }
    }
    EXPECT_GE(categories.size(), side == 60 ? 3U : 2U) << side;
    EXPECT_GT(refused, 50) << side;
  }
}

}  // namespace heading_costs_test
}  // namespace talus::cli
