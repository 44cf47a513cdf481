#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include <talus/planner/field/bucket_queue.hpp>

namespace talus::planner {
namespace bucket_queue_test {

constexpr auto kAlways = [](std::uint64_t) { return true; };

// Property: keys within range are returned bucket by bucket, in insertion order within a bucket, also keys
// queued during the processing. The ring is small, so that it wraps many times.
TEST(BucketQueue, KeysWithinRangeAreInBucketOrder) {
  for (const unsigned shift : {0U, 3U, 5U}) {
    std::mt19937 random(shift + 1);
    std::vector<std::uint64_t> keys{17};  // by index
    BucketQueue queue(shift, 100);
    queue.startAt(keys[0]);
    queue.push(keys[0], 0);
    std::vector<std::uint32_t> taken;
    queue.run(
        [&](std::uint32_t index) {
          taken.push_back(index);
          EXPECT_EQ(queue.bucketOf(keys[index]), queue.current());
          for (int k = 0; k < 2 && keys.size() < 5'000; ++k) {
            keys.push_back(keys[index] + random() % 101);
            queue.push(keys.back(), static_cast<std::uint32_t>(keys.size() - 1));
          }
        },
        kAlways);
    ASSERT_EQ(taken.size(), keys.size());
    // The index counts insertions, so that insertion order within a bucket is the order of the index.
    EXPECT_TRUE(std::ranges::is_sorted(
        taken, {}, [&](std::uint32_t index) { return std::pair(queue.bucketOf(keys[index]), index); }));
  }
}

TEST(BucketQueue, PastKeysAreReturnedAtOnceAndDistantKeysAtTheLastBucket) {
  BucketQueue queue(0, 6);  // a ring of 8 buckets
  queue.startAt(50);
  queue.push(50, 0);
  std::vector<std::pair<std::uint32_t, std::uint64_t>> taken;  // index and bucket
  queue.run(
      [&](std::uint32_t index) {
        taken.emplace_back(index, queue.current());
        if (index != 0) return;
        queue.push(1'000, 1);
        queue.push(3, 2);
      },
      kAlways);
  // Closed form: 50 + 8 - 1 is the last bucket of the ring.
  EXPECT_EQ(taken, (std::vector<std::pair<std::uint32_t, std::uint64_t>>{{0, 50}, {2, 50}, {1, 57}}));
}

TEST(BucketQueue, RunPausesAndResumes) {
  BucketQueue queue(2, 40);
  for (const std::uint32_t key : {0U, 9U, 21U}) queue.push(key, key);
  std::vector<std::uint32_t> taken;
  const auto take = [&](std::uint32_t index) { taken.push_back(index); };
  queue.run(take, [](std::uint64_t first) { return first < 12; });
  EXPECT_EQ(taken, (std::vector<std::uint32_t>{0, 9}));
  queue.run(take, kAlways);
  EXPECT_EQ(taken, (std::vector<std::uint32_t>{0, 9, 21}));
}

}  // namespace bucket_queue_test
}  // namespace talus::planner
