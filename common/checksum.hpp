#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace talus {

/// A 64-bit checksum of bytes given in any pieces; guards against damage, not malice. Each step is one to one in the
/// word and in what came before, so that damage within one 8-byte word is always seen (ours, after FNV-1a).
class Checksum {
 public:
  void add(const void* data, std::size_t size) noexcept {
    const auto* bytes = static_cast<const unsigned char*>(data);
    length_ += size;
    for (; size > 0 && held_ > 0; ++bytes, --size) addByte(*bytes);
    for (; size >= 8; bytes += 8, size -= 8) {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes, 8);
      mix(word);
    }
    for (; size > 0; ++bytes, --size) addByte(*bytes);
  }

  std::uint64_t value() const noexcept {
    Checksum end = *this;
    end.mix(word_);
    end.mix(length_);
    return end.state_;
  }

 private:
  void addByte(unsigned char byte) noexcept {
    word_ |= std::uint64_t{byte} << (8 * held_);
    if (++held_ < 8) return;
    mix(word_);
    word_ = 0;
    held_ = 0;
  }
  void mix(std::uint64_t word) noexcept {
    state_ = (state_ ^ word) * 0x100000001b3ULL;
    state_ ^= state_ >> 32;
  }

  std::uint64_t state_ = 0xcbf29ce484222325ULL;
  std::uint64_t length_ = 0;
  std::uint64_t word_ = 0;
  unsigned held_ = 0;  // bytes in word_
};

}  // namespace talus
