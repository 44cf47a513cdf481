#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

namespace talus {

/// A 64-bit checksum of bytes given in any pieces: XXH3 of xxHash, seed 0. It detects damage, not malice.
class Checksum {
 public:
  Checksum();
  ~Checksum();
  Checksum(Checksum&&) noexcept;
  Checksum& operator=(Checksum&&) noexcept;

  void add(const void* data, std::size_t size) noexcept;
  /// Of all bytes so far; more may be added.
  std::uint64_t value() const noexcept;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace talus
