#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace talus::planner {

/// Indices in the order of whole-number keys, bucket by bucket; within a bucket as they came. What lies
/// farther ahead than the ring reaches is handed out too early, and what lies behind at once: whoever takes
/// an index reads its key again.
class BucketQueue {
 public:
  /// Buckets of 2^shift keys, for keys that lie up to `reach` apart.
  BucketQueue(unsigned shift, std::uint64_t reach)
      : shift_(shift), ring_(std::bit_ceil((reach >> shift) + 2)) {}

  /// The bucket that a key belongs to.
  std::uint64_t bucketOf(std::uint64_t key) const noexcept { return key >> shift_; }

  /// The bucket whose turn it is.
  std::uint64_t current() const noexcept { return current_; }

  std::uint64_t queued() const noexcept { return queued_; }

  void startAt(std::uint64_t key) noexcept { current_ = bucketOf(key); }

  void push(std::uint64_t key, std::uint32_t index) {
    const std::uint64_t bucket = std::clamp(bucketOf(key), current_, current_ + ring_.size() - 1);
    ring_[bucket & (ring_.size() - 1)].push_back(index);
    ++queued_;
  }

  /// Calls take(index) for everything queued, and for what take() queues, while more(first key of the bucket)
  /// says so.
  template <typename Take, typename More>
  void run(Take take, More more) {
    for (; queued_ > 0 && more(current_ << shift_); ++current_) {
      auto& bucket = ring_[current_ & (ring_.size() - 1)];
      for (std::size_t i = 0; i < bucket.size(); ++i) take(bucket[i]);
      queued_ -= bucket.size();
      bucket.clear();
    }
  }

 private:
  unsigned shift_;
  std::vector<std::vector<std::uint32_t>> ring_;
  std::uint64_t current_ = 0, queued_ = 0;
};

}  // namespace talus::planner
