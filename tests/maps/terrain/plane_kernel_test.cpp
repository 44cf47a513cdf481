#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include <talus/maps/terrain/plane_fit.hpp>

namespace talus::maps {
namespace plane_kernel_test {

struct Fitted {
  std::vector<float> dz_dx, dz_dy, roughness_m, relief_m;
};

Fitted fitted(PlaneKernel kernel, const Footprint& disc, const std::vector<std::vector<float>>& rows,
              int width) {
  const auto n = static_cast<std::size_t>(width);
  Fitted out{std::vector<float>(n), std::vector<float>(n), std::vector<float>(n), std::vector<float>(n)};
  std::vector<const float*> heights;
  for (const auto& row : rows) heights.push_back(row.data() + disc.reach);
  kernel(disc, {.heights = heights.data(),
                .width = width,
                .cells_per_metre = 2.0F,
                .dz_dx = out.dz_dx.data(),
                .dz_dy = out.dz_dy.data(),
                .roughness_m = out.roughness_m.data(),
                .relief_m = out.relief_m.data()});
  return out;
}

std::vector<std::vector<float>> rowsOf(const Footprint& disc, int width, auto&& height) {
  std::vector<std::vector<float>> rows;
  for (int r = -disc.reach; r <= disc.reach; ++r) {
    auto& row = rows.emplace_back();
    for (int c = -disc.reach; c < width + disc.reach + kPlaneLanes; ++c) row.push_back(height(c, r));
  }
  return rows;
}

TEST(PlaneKernel, FitReproducesAPlane) {
  const Footprint disc = discFootprint(2.5);
  const auto rows = rowsOf(
      disc, 13, [](int c, int r) { return 0.125F * static_cast<float>(c) - 0.25F * static_cast<float>(r); });
  const Fitted out = fitted(planeKernel(), disc, rows, 13);
  for (std::size_t i = 0; i < 13; ++i) {
    // Closed form: cells of half a metre. Tolerance: float.
    EXPECT_NEAR(out.dz_dx[i], 0.25, 1e-6);
    EXPECT_NEAR(out.dz_dy[i], -0.5, 1e-6);
    EXPECT_NEAR(out.roughness_m[i], 0.0, 1e-6);
    EXPECT_NEAR(out.relief_m[i], 0.0, 2e-6);
  }
}

TEST(PlaneKernel, KernelsAreBitIdentical) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> height(-3.0F, 3.0F), chance(0.0F, 1.0F);
  for (const double radius : {1.0, 2.5, 4.0}) {
    const Footprint disc = discFootprint(radius);
    const auto rows = rowsOf(disc, 37, [&](int, int) {
      const float z = height(random);
      return chance(random) < 0.02F ? std::numeric_limits<float>::quiet_NaN() : z;
    });
    const Fitted plain = fitted(fitPlanesBaseline, disc, rows, 37),
                 fast = fitted(planeKernel(), disc, rows, 37);
    // Property: NaN occurs in the same places; other values are bit-identical.
    const auto same = [](float a, float b) {
      return (std::isnan(a) && std::isnan(b)) ||
             std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
    };
    for (std::size_t i = 0; i < 37; ++i) {
      EXPECT_TRUE(same(plain.dz_dx[i], fast.dz_dx[i])) << i;
      EXPECT_TRUE(same(plain.dz_dy[i], fast.dz_dy[i])) << i;
      EXPECT_TRUE(same(plain.roughness_m[i], fast.roughness_m[i])) << i;
      EXPECT_TRUE(same(plain.relief_m[i], fast.relief_m[i])) << i;
    }
  }
}

// Property: kernels are bit-identical for heights far below the datum, where single precision is coarse.
#if defined(__x86_64__)
TEST(PlaneKernel, KernelsAreBitIdenticalFarFromTheDatum) {
  if (!__builtin_cpu_supports("avx2")) GTEST_SKIP() << "this processor has no AVX2";
  const Footprint footprint = discFootprint(3.2);
  const int width = 61;
  const int stride = width + 2 * footprint.reach + kPlaneLanes;
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(-4501.0F, -4499.0F);
  std::vector<float> heights(static_cast<std::size_t>(stride * (2 * footprint.reach + 1)));
  for (float& h : heights) h = uniform(random);
  heights[200] = std::numeric_limits<float>::quiet_NaN();
  std::vector<const float*> rows;
  for (int r = 0; r <= 2 * footprint.reach; ++r)
    rows.push_back(heights.data() + r * stride + footprint.reach);
  const auto bits = [&](PlaneKernel kernel) {
    std::vector<float> out(static_cast<std::size_t>(4 * width));
    kernel(footprint, {.heights = rows.data(),
                       .width = width,
                       .cells_per_metre = 0.3F,
                       .dz_dx = out.data(),
                       .dz_dy = out.data() + width,
                       .roughness_m = out.data() + 2 * width,
                       .relief_m = out.data() + 3 * width});
    std::vector<std::uint32_t> words;
    for (float v : out) words.push_back(std::bit_cast<std::uint32_t>(v));
    return words;
  };
  EXPECT_EQ(bits(fitPlanesBaseline), bits(fitPlanesAvx2));
}
#endif

}  // namespace plane_kernel_test
}  // namespace talus::maps
