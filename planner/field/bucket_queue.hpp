#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace talus::planner {

/// Priority queue of indices with integer keys, sorted into buckets of 2^shift consecutive keys. Buckets are
/// taken in increasing order, indices of one bucket in the order of insertion. The buckets form a ring of
/// limited length: an index with a key beyond the ring is taken too early, and an index with a key below the
/// current bucket is taken next. Therefore the caller must look up the true key of each index that is taken.
class BucketQueue {
 public:
  /// `shift` is the binary logarithm of the bucket width, `reach` the largest difference of two queued keys.
  BucketQueue(unsigned shift, std::uint64_t reach)
      : shift_(shift), ring_(std::bit_ceil((reach >> shift) + 2)) {}

  /// Returns the index of the bucket of a key.
  std::uint64_t bucketOf(std::uint64_t key) const noexcept { return key >> shift_; }

  /// Returns the index of the current bucket.
  std::uint64_t current() const noexcept { return current_; }

  /// Returns the number of queued indices.
  std::uint64_t queued() const noexcept { return queued_; }

  /// Sets the current bucket to the bucket of `key`.
  void startAt(std::uint64_t key) noexcept { current_ = bucketOf(key); }

  /// Adds an index with a key.
  void push(std::uint64_t key, std::uint32_t index) {
    const std::uint64_t bucket = std::clamp(bucketOf(key), current_, current_ + ring_.size() - 1);
    ring_[bucket & (ring_.size() - 1)].push_back(index);
    ++queued_;
  }

  /// Calls take(index) for every queued index, including the indices that take() adds, as long as more(first
  /// key of the bucket) returns true.
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
