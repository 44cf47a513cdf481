#include "nav2_layer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <nav2_costmap_2d/cost_values.hpp>

#include "small_site.hpp"

#ifdef TALUS_NAV2_MAIN
#define Nav2LayerTest Nav2LayerOfMain  // the same tests, by another name
#endif

namespace talus_ros2 {
namespace {

using nav2_costmap_2d::Costmap2D;
using nav2_costmap_2d::LETHAL_OBSTACLE;
using nav2_costmap_2d::MAX_NON_OBSTACLE;
using nav2_costmap_2d::NO_INFORMATION;
using Message = grid_map_msgs::msg::GridMap;

struct Bounds {
  double min_x = std::numeric_limits<double>::max(), min_y = min_x, max_x = -min_x, max_y = -min_x;
};

/// The layer as Nav2's costmap has it: behind its interface.
class Nav2LayerTest : public RosTest {
 protected:
  void start(bool rolling = false) {
    parent_ = std::make_unique<nav2_costmap_2d::LayeredCostmap>("map", rolling, true);
    layer_->initialize(parent_.get(), "ground", nullptr, node_, nullptr);
    layer_->activate();
  }

  // A costmap over the whole site in cells of a size.
  static Costmap2D costmap(double resolution_m, unsigned char standing = NO_INFORMATION) {
    const auto cells = [&](double m) { return static_cast<unsigned int>(std::lround(m / resolution_m)); };
    return {cells(40.0), cells(20.0), resolution_m, -5.0, 3.0, standing};
  }
  static unsigned char at(const Costmap2D& master, double x_m, double y_m) {
    const auto cell = [&](double m) { return static_cast<unsigned int>(m / master.getResolution()); };
    return master.getCharMap()[master.getIndex(cell(x_m + 5.0), cell(y_m - 3.0))];
  }
  Bounds bounds() {
    Bounds b;
    layer_->updateBounds(0.0, 8.0, 0.0, &b.min_x, &b.min_y, &b.max_x, &b.max_y);
    return b;
  }
  void draw(Costmap2D& master) {
    bounds();
    layer_->updateCosts(master, 0, 0, static_cast<int>(std::lround(40.0 / master.getResolution())),
                        static_cast<int>(std::lround(20.0 / master.getResolution())));
  }
  std::shared_ptr<nav2_costmap_2d::Layer::Node> node_ = std::make_shared<nav2_costmap_2d::Layer::Node>();
  std::unique_ptr<nav2_costmap_2d::LayeredCostmap> parent_;
  std::unique_ptr<nav2_costmap_2d::Layer> layer_ = std::make_unique<Nav2Layer>();
};

// Heights of a plane that climbs east at a gradient.
Message plane(double gradient) {
  return heightsOn({25.0, 10.0, 10.0, 10.0}, [&](double x, double) { return gradient * (x - 19.75); });
}

TEST_F(Nav2LayerTest, CellCostsFollowTheTraversabilityMap) {
  start();
  Costmap2D master = costmap(0.5);
  draw(master);
  EXPECT_TRUE(layer_->isCurrent());
  EXPECT_EQ(at(master, 10.7, 8.0), LETHAL_OBSTACLE);  // the wall
  EXPECT_EQ(at(master, 20.0, 8.0), 0);                // Closed form: level ground of the only kind
  hear(plane(0.08));
  draw(master);
  const unsigned char gentle = at(master, 25.0, 10.0);
  EXPECT_GT(gentle, 0);
  EXPECT_LT(gentle, MAX_NON_OBSTACLE);
  EXPECT_TRUE(log().empty());
  // Independent derivation: each cell of the middle by 360 headings, each by itself.
  const auto published = MapNode::shared()->published();
  float dearest = 0.0F;
  for (int k = 0; k < 360; ++k)
    dearest = std::max(dearest, published->cost().costPerMetre(
                                    published->at(*published->grid().cellAt({25.0, 10.0})),
                                    {std::cos(k * talus::kDegree), std::sin(k * talus::kDegree)}));
  const float level =
      published->cost().costPerMetre(published->at(*published->grid().cellAt({0.0, 8.0})), {});
  EXPECT_NEAR(gentle, 251.0 * static_cast<double>(dearest / level - 1.0F) / 19.0, 1.0);
}

TEST_F(Nav2LayerTest, PartiallyRefusedCellHasTheHighestNonLethalCost) {
  start();
  Costmap2D master = costmap(0.5);
  std::set<int> seen;
  for (double gradient = 0.05; gradient < 1.0; gradient += 0.05) {
    hear(plane(gradient));
    std::fill_n(master.getCharMap(), 80 * 40, static_cast<unsigned char>(0));
    draw(master);
    seen.insert(at(master, 25.0, 10.0));
  }
  EXPECT_TRUE(seen.contains(MAX_NON_OBSTACLE));
  EXPECT_EQ(*seen.rbegin(), LETHAL_OBSTACLE);  // too steep for any
  EXPECT_FALSE(seen.contains(253));            // which would be lethal for the rover's middle
}

TEST_F(Nav2LayerTest, CellsOfAnotherSizeHaveTheMaximumOfOverlappingCells) {
  start();
  for (const double resolution_m : {0.25, 1.0, 0.7}) {
    Costmap2D master = costmap(resolution_m), same = costmap(0.5);
    draw(master);
    draw(same);
    const auto cells = [&](double m) { return static_cast<int>(std::lround(m / resolution_m)); };
    for (int j = 0; j < cells(20.0) - 1; ++j)
      for (int i = 0; i < cells(40.0) - 1; ++i) {
        unsigned char worst = 0;
        for (double x = i * resolution_m + 1e-3; x < (i + 1) * resolution_m; x += 0.5 * 0.249)
          for (double y = j * resolution_m + 1e-3; y < (j + 1) * resolution_m; y += 0.5 * 0.249)
            worst = std::max(worst, at(same, x - 5.0, y + 3.0));
        for (const double x : {i * resolution_m + 1e-3, (i + 1) * resolution_m - 1e-3})
          for (const double y : {j * resolution_m + 1e-3, (j + 1) * resolution_m - 1e-3})
            worst = std::max(worst, at(same, x - 5.0, y + 3.0));
        ASSERT_EQ(
            master.getCharMap()[master.getIndex(static_cast<unsigned int>(i), static_cast<unsigned int>(j))],
            worst)
            << resolution_m << ": " << i << ' ' << j;
      }
  }
}

TEST_F(Nav2LayerTest, ExistingCostsAreNeverLoweredAndOutsideCellsKept) {
  start();
  Costmap2D lethal = costmap(0.5, LETHAL_OBSTACLE);
  draw(lethal);
  EXPECT_EQ(at(lethal, 20.0, 8.0), LETHAL_OBSTACLE);
  Costmap2D off(10, 10, 0.5, 100.0, 100.0, 17);
  layer_->updateCosts(off, 0, 0, 10, 10);
  EXPECT_TRUE(std::all_of(off.getCharMap(), off.getCharMap() + 100, [](unsigned char c) { return c == 17; }));
}

TEST_F(Nav2LayerTest, UnknownGroundIsLethalUnlessDisabled) {
  const auto unseen = [&](bool refuse) {
    talus::costmap::MapLayers layers;
    layers.elevation.elevation_m = talus::maps::Raster<float>(smallSite().grid(), NAN);
    talus::costmap::TraversabilityMap blind(
        std::move(layers), std::make_shared<talus::costmap::GroundModel>(smallSite().model()), {});
    talus::costmap::writeMap(blind, file_);
    layer_ = std::make_unique<Nav2Layer>();
    node_->parameters["ground.refuse_unknown"] = refuse;
    parent_ = std::make_unique<nav2_costmap_2d::LayeredCostmap>("map", false, true);
    layer_->initialize(parent_.get(), "ground", nullptr, node_, nullptr);
    Costmap2D master = costmap(0.5, 5);
    draw(master);
    return at(master, 20.0, 8.0);
  };
  EXPECT_EQ(unseen(true), LETHAL_OBSTACLE);
  EXPECT_EQ(unseen(false), 5);
}

TEST_F(Nav2LayerTest, BoundsContainTheChangedCellsAndAllAfterReset) {
  start();
  const Bounds first = bounds();
  EXPECT_LE(first.min_x, -5.0);
  EXPECT_GE(first.max_x, 35.0);
  EXPECT_GT(bounds().min_x, bounds().max_x);  // nothing since
  hear(plateau({33.0, 10.0, 2.0, 2.0}, 0.02F));
  const Bounds changed = bounds();
  EXPECT_GE(changed.min_x, -5.0 + 32.0);  // the second tile of 64 cells begins there
  EXPECT_LE(changed.min_x, 32.0);
  layer_->reset();
  EXPECT_LE(bounds().min_x, -5.0);
  layer_ = std::make_unique<Nav2Layer>();
  start(true);
  bounds();
  EXPECT_LE(bounds().min_x, -5.0);
}

TEST_F(Nav2LayerTest, InvalidParametersAreRefused) {
  node_->parameters["ground.full_cost_ratio"] = 1.0;
  EXPECT_THROW(start(), std::invalid_argument);
  node_->parameters["ground.full_cost_ratio"] = 20.0;
  parent_ = std::make_unique<nav2_costmap_2d::LayeredCostmap>("odom", false, true);
  EXPECT_THROW(layer_->initialize(parent_.get(), "ground", nullptr, node_, nullptr), std::invalid_argument);
}

}  // namespace
}  // namespace talus_ros2
