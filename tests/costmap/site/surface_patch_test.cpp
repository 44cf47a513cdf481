#include <cmath>
#include <random>
#include <string>
#include <thread>

#include <refused.hpp>
#include <site_map.hpp>

#include <talus/costmap/site/surface_patch.hpp>

namespace talus::costmap {
namespace surface_patch_test {

const maps::Grid kMap{.width = 40, .height = 30, .resolution_m = 0.5, .south_west = {10.0, 20.0}};

MapLayers flat() {
  MapLayers layers;
  layers.elevation.elevation_m = maps::Raster<float>(kMap, 3.0F);
  layers.classes = maps::Raster<std::uint8_t>(kMap, 1);
  return layers;
}

TraversabilityMap flatMap() {
  return TraversabilityMap(flat(), testGround(), {});
}

// A grid of 4 x 4 cells with its corner at a place.
maps::Grid gridAt(maps::Point south_west) {
  return {.width = 4, .height = 4, .resolution_m = 0.5, .south_west = south_west};
}

SurfacePatch heightsAt(maps::Point south_west, float height_m = 3.1F) {
  SurfacePatch patch;
  patch.elevation_m = maps::Raster<float>(gridAt(south_west), height_m);
  return patch;
}

std::string refusal(TraversabilityMap& map, const SurfacePatch& patch) {
  try {
    map.patch(patch);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "taken";
}

struct Wrong {
  const char* what;
  SurfacePatch patch;
  const char* said;
};

std::vector<Wrong> wrongPatches() {
  const auto with = [](SurfacePatch patch, const auto& change) {
    change(patch);
    return patch;
  };
  return {
      {"off the map", heightsAt({1000.0, 20.0}), "reaches off the map of 40 x 30 cells"},
      {"partly off", heightsAt({28.5, 20.0}), "cut it to the map"},
      {"far off", heightsAt({1e300, 20.0}), "lies off the map"},
      {"nowhere", heightsAt({NAN, 20.0}), "lies off the map"},
      {"between cells", heightsAt({10.2, 20.0}), "between the cells"},
      {"other resolution",
       with(heightsAt({10.0, 20.0}),
            [](SurfacePatch& p) {
              p.elevation_m = maps::Raster<float>(
                  {.width = 4, .height = 4, .resolution_m = 0.25, .south_west = {10, 20}}, 3.0F);
            }),
       "resolution_m = 0.25, must be the map's 0.5"},
      {"resolution NaN",
       with(heightsAt({10.0, 20.0}),
            [](SurfacePatch& p) {
              p.elevation_m = maps::Raster<float>(
                  {.width = 4, .height = 4, .resolution_m = NAN, .south_west = {10, 20}}, 3.0F);
            }),
       "must be the map's 0.5"},
      {"all NaN", heightsAt({12.0, 22.0}, NAN), "nothing was observed"},
      {"no layer", {}, "no layer has a cell"},
      {"1e30",
       with(heightsAt({12.0, 22.0}),
            [](SurfacePatch& p) {
              p.elevation_m[{2, 1}] = 1e30F;
            }),
       "elevation_m = 1e+30 at (13.25, 22.75) m, column 2, row 1, must be NaN or within"},
      {"infinite",
       with(heightsAt({12.0, 22.0}),
            [](SurfacePatch& p) {
              p.elevation_m[{0, 0}] = INFINITY;
            }),
       "elevation_m = inf at"},
      {"a share of 2",
       with(heightsAt({12.0, 22.0}),
            [](SurfacePatch& p) { p.rock_abundance = maps::Raster<float>(p.elevation_m.grid(), 2.0F); }),
       "rock_abundance = 2 at (12.25, 22.25) m, column 0, row 0, must be NaN or 0 to 1"},
      {"two grids",
       with(heightsAt({12.0, 22.0}),
            [](SurfacePatch& p) {
              p.keep_out = maps::Raster<std::uint8_t>(gridAt({12.0, 22.5}), 1);
            }),
       "give all layers of a patch on one grid"},
  };
}

TEST(SurfacePatch, InvalidPatchIsRejectedWithOneLineAndMapUnchanged) {
  TraversabilityMap map = flatMap();
  const auto before = map.published();
  for (const Wrong& wrong : wrongPatches()) {
    const std::string said = refusal(map, wrong.patch);
    EXPECT_NE(said.find(wrong.said), std::string::npos) << wrong.what << ": " << said;
    EXPECT_EQ(said.find('\n'), std::string::npos) << said;
    EXPECT_EQ(map.published(), before) << wrong.what;
    for (const float h : map.elevation().elevation_m.values()) ASSERT_EQ(h, 3.0F) << wrong.what;
  }
}

// Property: a map rejects the layer values that a patch rejects; an invalid height or rock abundance is not
// treated as missing.
TEST(SurfacePatch, MapLayersAreValidatedLikePatches) {
  for (const float bad : {1e30F, INFINITY, -INFINITY}) {
    MapLayers layers = flat();
    layers.elevation.elevation_m[{1, 2}] = bad;
    EXPECT_REFUSED(TraversabilityMap(std::move(layers), testGround(), {}), std::invalid_argument,
                   "column 1, row 2, must be NaN or -131072 to 131072")
        << bad;
  }
  for (const float bad : {-9999.0F, -INFINITY, 2.0F}) {
    MapLayers layers = flat();
    layers.rock_abundance = maps::Raster<float>(layers.elevation.grid(), 0.0F);
    layers.rock_abundance[{1, 2}] = bad;
    EXPECT_REFUSED(TraversabilityMap(std::move(layers), testGround(), {}), std::invalid_argument,
                   "column 1, row 2, must be NaN or 0 to 1")
        << bad;
  }
  for (const double bad : {1e-9, 1e9, static_cast<double>(NAN)}) {
    MapLayers layers;
    const maps::Grid grid{.width = 4, .height = 4, .resolution_m = bad, .south_west = {}};
    layers.elevation.elevation_m = maps::Raster<float>(grid, 0.0F);
    EXPECT_REFUSED(TraversabilityMap(std::move(layers), testGround(), {}), std::invalid_argument,
                   "must be finite, of 0.001 m to 1000 km")
        << bad;
  }
}

TEST(SurfacePatch, ClassPatchRequiresAMapWithClasses) {
  MapLayers layers = flat();
  layers.classes = {};
  TraversabilityMap map(std::move(layers), testGround(), {});
  SurfacePatch patch;
  patch.classes = maps::Raster<std::uint8_t>(gridAt({12.0, 22.0}), 2);
  EXPECT_NE(refusal(map, patch).find("build it with a class raster"), std::string::npos);
}

// Property: a class that a later patch introduces costs as much as on a map built with the class.
TEST(SurfacePatch, NewClassCostsAsOnAMapBuiltWithIt) {
  MapLayers with = flat();
  const SurfacePatch patch = [] {
    SurfacePatch dust;
    dust.classes = maps::Raster<std::uint8_t>(gridAt({14.0, 24.0}), 2);
    return dust;
  }();
  const maps::Cell inside{9, 9};
  for (int row = 8; row < 12; ++row)
    for (int column = 8; column < 12; ++column) with.classes[{column, row}] = 2;
  const TraversabilityMap begun(std::move(with), testGround(), {});
  TraversabilityMap patched = flatMap();
  const auto cost = [&](const TraversabilityMap& map) {
    return map.published()->cost().costPerMetre(map.published()->at(inside), {});
  };
  const float sand = cost(patched);
  patched.patch(patch);
  EXPECT_EQ(cost(patched), cost(begun));
  EXPECT_NE(cost(patched), sand);
  EXPECT_EQ(patched.costs().category(inside), begun.costs().category(inside));
}

// Property: a patch replaces only the tiles within its reach; all other tiles are shared with the previous
// version.
TEST(SurfacePatch, PatchSharesUnaffectedTiles) {
  MapLayers layers;
  const maps::Grid grid{.width = 640, .height = 640, .resolution_m = 0.5, .south_west = {}};
  layers.elevation.elevation_m = maps::Raster<float>(grid, 0.0F);
  TraversabilityMap map(std::move(layers), testGround(), {});
  const auto before = map.published();
  map.patch(heightsAt({176.0, 176.0}, 0.01F));  // in the middle of tile (5, 5)
  const auto after = map.published();
  std::size_t changed = 0;
  for (std::size_t t = 0; t < before->content().tiles.size(); ++t)
    changed += before->content().tiles[t] != after->content().tiles[t];
  EXPECT_EQ(changed, 1U);
}

// Property: a map built without data takes its base elevation from the first patch.
TEST(SurfacePatch, FirstPatchSetsTheBaseElevation) {
  MapLayers layers;
  const maps::Grid grid{.width = 60, .height = 60, .resolution_m = 0.05, .south_west = {}};
  layers.elevation.elevation_m = maps::Raster<float>(grid, NAN);
  TraversabilityMap map(std::move(layers), testGround(), {});
  EXPECT_EQ(map.costs().countCategories().unknown, grid.size());
  SurfacePatch patch;
  patch.elevation_m = maps::Raster<float>(grid, -4500.0F);
  map.patch(patch);
  EXPECT_GT(map.costs().countCategories().safe, 1000U);
  EXPECT_DOUBLE_EQ(map.surface().keys().baseElevation_m(), -4500.0);
  patch.elevation_m = maps::Raster<float>(grid, 4500.0F);
  EXPECT_NE(refusal(map, patch).find("within 1638.35 m of -4500 m"), std::string::npos);
}

// A random observation of ground weaker or stronger than the class, sometimes with immobilisation.
WheelObservation anywhere(std::mt19937_64& random) {
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  WheelObservation seen{.time_s = 1.0,
                        .place = {between(10.0, 30.0), between(20.0, 35.0)},
                        .pull = {between(-0.1, 0.4), 0.05},
                        .sinkage = {between(0.0, 0.3), 0.05}};
  seen.shared_std = 0.03;
  seen.trust = static_cast<Trust>(random() % 3);
  seen.sinkage_verified = random() % 2 == 0;
  seen.pose_std_m = random() % 2 == 0 ? 0.0 : 0.4;
  if (random() % 8 == 0) seen.here.most_pull = between(-0.2, 0.1);
  if (random() % 8 == 0) seen.here.least_sinkage = between(0.5, 1.0);
  return seen;
}

// Property: readings on ground of a known class without heights have, after a patch adds the heights, the
// same effect as on a map built with the heights. The map built without any data is included.
TEST(SurfacePatch, EvidenceFromBeforeThePatchIsRetained) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    std::mt19937_64 random(seed);
    MapLayers whole = flat();
    for (int row = 0; row < kMap.height; ++row)
      for (int column = 0; column < kMap.width; ++column)
        whole.elevation.elevation_m[{column, row}] = 3.0F + 0.05F * static_cast<float>((column * row) % 3);
    MapLayers unseen = whole;
    SurfacePatch rest;
    rest.elevation_m = whole.elevation.elevation_m;
    for (int row = 0; row < kMap.height; ++row)
      for (int column = seed % 3 == 0 ? 0 : 15; column < kMap.width; ++column)
        unseen.elevation.elevation_m[{column, row}] = NAN;
    TraversabilityMap begun(std::move(whole), testGround({.allow_unknown = seed % 2 == 0}), {});
    TraversabilityMap patched(std::move(unseen), testGround({.allow_unknown = seed % 2 == 0}), {});
    for (int i = 0; i < 60; ++i) {
      const WheelObservation seen = anywhere(random);
      EXPECT_TRUE(begun.learn(seen));
      EXPECT_TRUE(patched.learn(seen));
      if (i % 20 == 0) patched.publish();
    }
    begun.publish();
    patched.publish();
    patched.patch(rest);
    for (int row = 0; row < kMap.height; ++row)
      for (int column = 0; column < kMap.width; ++column) {
        const maps::Cell cell{column, row};
        ASSERT_EQ(patched.ground(cell)->pull.value, begun.ground(cell)->pull.value) << seed;
        ASSERT_EQ(patched.ground(cell)->sinkage.value, begun.ground(cell)->sinkage.value) << seed;
        ASSERT_EQ(patched.costs().category(cell), begun.costs().category(cell)) << seed;
        const auto a = patched.published(), b = begun.published();
        for (const Direction heading : {Direction{1.0, 0.0}, {0.6, -0.8}, {0.0, 1.0}})
          ASSERT_EQ(a->cost().costPerMetre(a->at(cell), heading),
                    b->cost().costPerMetre(b->at(cell), heading))
              << seed << ' ' << column << ' ' << row;
      }
  }
}

// Property: with two threads each patch is applied completely, or rejected because the other thread changes
// the map. After all patches are applied the map equals that of one thread.
TEST(SurfacePatch, ConcurrentPatchesAreAtomic) {
  TraversabilityMap map = flatMap();
  const auto keepPatching = [&](double x_m) {
    for (int k = 0; k < 40;) try {
        map.patch(heightsAt({x_m, 20.0 + 0.5 * (k % 20)}, 3.0F + 0.001F * static_cast<float>(k)));
        ++k;
      } catch (const std::logic_error& error) {
        if (dynamic_cast<const std::invalid_argument*>(&error) != nullptr ||
            std::string(error.what()).find("let one thread change it") == std::string::npos)
          ADD_FAILURE() << error.what();
      }
  };
  {
    std::jthread west([&] { keepPatching(10.0); }), east([&] { keepPatching(22.0); });
  }
  TraversabilityMap one = flatMap();
  for (const double x_m : {10.0, 22.0})
    for (int k = 0; k < 40; ++k)
      one.patch(heightsAt({x_m, 20.0 + 0.5 * (k % 20)}, 3.0F + 0.001F * static_cast<float>(k)));
  EXPECT_EQ(map.published()->version(), 81U);
  for (int row = 0; row < kMap.height; ++row)
    for (int column = 0; column < kMap.width; ++column)
      ASSERT_EQ(map.published()->at({column, row}), one.published()->at({column, row}))
          << column << ' ' << row;
}

}  // namespace surface_patch_test
}  // namespace talus::costmap
