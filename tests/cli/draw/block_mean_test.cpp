#include <cmath>
#include <random>

#include <talus/cli/draw/block_mean.hpp>

namespace talus::cli {
namespace block_mean_test {

TEST(Blocks, BlocksCoverTheMapAndExcludeNoData) {
  maps::Raster<float> fine({5, 4, 2.0, {10.0, 20.0}}, 1.0F);
  fine[{4, 0}] = 3.0F;
  fine[{0, 0}] = std::nanf("");
  const Blocks blocks(fine.grid(), 3);
  EXPECT_EQ(blocks.coarse(), (maps::Grid{3, 2, 4.0, {10.0, 20.0}}));
  const maps::Raster<float> mean = blocks.mean([&](maps::Cell c) { return fine[c]; });
  EXPECT_EQ((mean[{0, 0}]), 1.0F);
  EXPECT_EQ((mean[{2, 0}]), 2.0F);  // the block at the east edge: one cell of 3 and one of 1
}

TEST(Blocks, BlockWithoutDataIsNan) {
  const maps::Grid grid{4, 4, 1.0, {0.0, 0.0}};
  const maps::Raster<float> mean = Blocks(grid, 2).mean([](maps::Cell) { return std::nanf(""); });
  EXPECT_TRUE(std::isnan(mean[{1, 1}]));
}

// Property: the factor is the smallest that limits both sides to max_side; block means equal brute-force
// means, and a map within max_side is unchanged.
TEST(Blocks, FactorIsMinimalAndMeansMatchBruteForce) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> value(-1.0F, 1.0F);
  for (const int most : {7, 8, 20, 50}) {
    maps::Raster<float> fine({50, 33, 2.0, {-3.0, 7.0}});
    for (float& each : fine.values()) each = value(random);
    const Blocks blocks(fine.grid(), most);
    const maps::Grid& coarse = blocks.coarse();
    const int factor = static_cast<int>(std::lround(coarse.resolution_m / 2.0));
    EXPECT_LE(std::max(coarse.width, coarse.height), most);
    if (factor > 1) {
      EXPECT_GT((50 + factor - 2) / (factor - 1), most);
    }
    EXPECT_GE(coarse.width * factor, 50);
    EXPECT_LT((coarse.width - 1) * factor, 50);
    const auto mean = blocks.mean([&](maps::Cell c) { return fine[c]; });
    for (int row = 0; row < coarse.height; ++row)
      for (int column = 0; column < coarse.width; ++column) {
        double sum = 0.0;
        int count = 0;
        for (int r = row * factor; r < std::min((row + 1) * factor, 33); ++r)
          for (int c = column * factor; c < std::min((column + 1) * factor, 50); ++c)
            sum += static_cast<double>(fine[{c, r}]), ++count;
        EXPECT_NEAR((mean[{column, row}]), sum / count, 1e-6) << factor;
      }
  }
}

}  // namespace block_mean_test
}  // namespace talus::cli
