// Calibration of the map's categories: the share of cells that have a category stated with probability p.
// Worlds are drawn from ranges unknown to the planner, driven with online updates, and compared with the
// categories of their true soils.
#include <array>
#include <cmath>
#include <cstdio>

#include <site_fixture.hpp>

#include <talus/planner/simulation/simulation.hpp>

namespace talus::planner {
namespace reliability_test {

using terramech::Category;

// Undulating ground with slopes up to 19 degrees, classified as sand.
costmap::TraversabilityMap hills() {
  costmap::MapLayers layers;
  layers.elevation.elevation_m =
      maps::Raster<float>({.width = 60, .height = 60, .resolution_m = 1.0, .south_west = {}});
  for (int row = 0; row < 60; ++row)
    for (int column = 0; column < 60; ++column)
      layers.elevation.elevation_m[{column, row}] =
          static_cast<float>(2.0 * std::sin(0.12 * column) * std::cos(0.1 * row));
  return {std::move(layers), costmap::testGround(), {}};
}

class Table {
 public:
  void add(double said, bool is) {
    Bin& bin = bins_[said < 0.6 ? 0 : said < 0.8 ? 1 : said < 0.95 ? 2 : 3];
    bin.said += said;
    bin.were += is ? 1.0 : 0.0;
    bin.count += 1.0;
  }
  void print(const char* what) const {
    for (const Bin& bin : bins_)
      if (bin.count > 0.0)
        std::printf("%-10s said %.3f, were %.3f of %.0f\n", what, bin.said / bin.count, bin.were / bin.count,
                    bin.count);
  }
  // The largest excess of the stated probability over the observed share, over bins of at least `least`
  // cells.
  double worstOverstatement(double least) const {
    double worst = 0.0;
    for (const Bin& bin : bins_)
      if (bin.count >= least) worst = std::max(worst, (bin.said - bin.were) / bin.count);
    return worst;
  }

 private:
  struct Bin {
    double said = 0.0, were = 0.0, count = 0.0;
  };
  std::array<Bin, 4> bins_{};
};

bool nearTrack(const TraverseSimulation& drive, const maps::Point& place) {
  for (const TrackPoint& at : drive.track)
    if (std::hypot(at.place.x_m - place.x_m, at.place.y_m - place.y_m) < 2.5) return true;
  return false;
}

TEST(Reliability, CategoryProbabilitiesAreNotOptimistic) {
  const auto map = hills();
  Truth truth;
  truth.spread = 0.1;
  truth.random_patches = 6;
  truth.patch_radius_m = 3.0;
  truth.patch_soil = costmap::testDust();
  const SimulationSite site(
      map, {.truth = truth, .start = {5.5, 5.5}, .goal = {54.5, 54.5}, .firm = {}, .seed = 31});
  std::array<Table, 3> tables;
  for (std::size_t i = 0; i < 60; ++i) {
    const TrueWorld world = site.trueWorld(i);
    const auto known = site.estimatedMap(SoilKnowledge::PerfectKnowledge, world);
    auto learned = site.estimatedMap(SoilKnowledge::OnLine, world);
    const TraverseSimulation drive = simulateTraverse(learned, world, site.options(SoilKnowledge::OnLine, i));
    for (int row = 0; row < 60; ++row)
      for (int column = 0; column < 60; ++column) {
        const maps::Cell cell{column, row};
        const costmap::CellBelief said = learned.belief(cell);
        if (said.category > 2 || learned.surface().hazards(cell) != costmap::Hazard::None ||
            !nearTrack(drive, learned.grid().centre(cell)))
          continue;
        tables[said.category].add(said.confidence / 16.0, known.costs().category(cell) <= said.category);
      }
  }
  tables[0].print("safe");
  tables[1].print("marginal");
  tables[2].print("dangerous");
  // Property: the stated probability exceeds the observed share by at most 0.05. A higher share is no error
  // and occurs by design: estimates are rounded conservatively, and soil is judged for the least favourable
  // position of the wheels. Cells of one world are correlated, so that 60 worlds estimate a share to about
  // 0.05.
  EXPECT_LT(tables[0].worstOverstatement(500.0), 0.05);
  EXPECT_LT(tables[1].worstOverstatement(500.0), 0.05);
}

}  // namespace reliability_test
}  // namespace talus::planner
