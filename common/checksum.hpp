#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

namespace talus {

/// Incremental 64-bit checksum of a byte sequence: XXH3 of xxHash with seed 0. The checksum detects
/// accidental damage, not deliberate change.
class Checksum {
 public:
  Checksum();
  ~Checksum();
  Checksum(Checksum&&) noexcept;
  Checksum& operator=(Checksum&&) noexcept;

  /// Appends `size` bytes at `data` to the sequence.
  void add(const void* data, std::size_t size) noexcept;
  /// Returns the checksum of all bytes added so far. More bytes may be added afterwards.
  std::uint64_t value() const noexcept;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace talus
