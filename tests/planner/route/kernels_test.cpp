#include <cstdint>
#include <limits>

#include <gtest/gtest.h>

#include <talus/planner/route/kernels.hpp>

namespace talus::planner {
namespace kernels_test {

// Property: every element is writable. Arrays of a cache line and more are aligned to a cache line, and
// arrays from two huge pages on to a huge page of 2 MiB.
TEST(LargeArray, ArrayIsAlignedAndFullyWritable) {
  for (const std::size_t count : {1UL, 15UL, 16UL, 17UL, (1UL << 20) - 1, 1UL << 20, (1UL << 20) + 1}) {
    const auto array = makeLargeArray<std::uint32_t>(count);
    const auto address = reinterpret_cast<std::uintptr_t>(array.get());
    EXPECT_EQ(address % 64, 0U) << count;
    if (count >= 1UL << 20) {
      EXPECT_EQ(address % (1UL << 21), 0U) << count;
    }
    for (std::size_t i = 0; i < count; ++i) array[i] = static_cast<std::uint32_t>(i);
    for (std::size_t i = 0; i < count; i += 997) ASSERT_EQ(array[i], i);
    EXPECT_EQ(array[count - 1], count - 1);
  }
}

TEST(LargeArray, ExcessiveSizeThrowsBadAlloc) {
  EXPECT_THROW(makeLargeArray<std::uint64_t>(std::size_t{1} << 58), std::bad_alloc);
}

}  // namespace kernels_test
}  // namespace talus::planner
