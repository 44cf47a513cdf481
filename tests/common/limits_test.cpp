#include <talus/common/common.hpp>
#include <talus/common/limits.hpp>

namespace talus {
namespace limits_test {

TEST(MemoryBudget, RequestAboveTheBudgetIsRejectedWithItsSize) {
  setMemoryBudget(std::uint64_t{2} << 30U);
  EXPECT_NO_THROW(requireMemory(1e8, "a.npy"));
  try {
    requireMemory(6.2e9, "big.ot");
    ADD_FAILURE();
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(),
                testing::StartsWith("big.ot: needs 6.2 GB, more than the memory budget of 2.15 GB"));
    EXPECT_THAT(e.what(), testing::HasSubstr("--max-memory"));
  }
  setMemoryBudget(0);
}

TEST(MemoryBudget, DefaultBudgetRejectsExcessiveRequests) {
  EXPECT_NO_THROW(requireMemory(1e3, "small"));
  EXPECT_THROW(requireMemory(1e15, "no machine has this"), InputError);
}

}  // namespace limits_test
}  // namespace talus
