#include <algorithm>
#include <cstdint>
#include <string>

#include <talus/common/checksum.hpp>

namespace talus {
namespace checksum_test {

std::uint64_t checksumOf(const std::string& bytes) {
  Checksum sum;
  sum.add(bytes.data(), bytes.size());
  return sum.value();
}

// Printed in: xxHash's specification, XXH3 64 bits of the empty string, seed 0.
TEST(Checksum, EmptyInputMatchesXxh3) {
  EXPECT_EQ(Checksum().value(), 0x2d06800538d394c2ULL);
}

// Property: the checksum is independent of the division of the bytes, also if value() is called in between.
TEST(Checksum, ChecksumIsIndependentOfDivision) {
  std::string bytes;
  for (int i = 0; i < 1000; ++i) bytes += static_cast<char>(i * 31);
  for (const std::size_t piece : {1U, 7U, 8U, 255U, 256U, 257U}) {
    Checksum sum;
    for (std::size_t at = 0; at < bytes.size(); at += piece) {
      sum.add(bytes.data() + at, std::min(piece, bytes.size() - at));
      static_cast<void>(sum.value());
    }
    EXPECT_EQ(sum.value(), checksumOf(bytes)) << piece;
  }
}

// Property: every flipped bit changes the checksum, at all lengths for which the algorithm has a separate
// branch.
TEST(Checksum, EveryFlippedBitChangesTheChecksum) {
  for (const std::size_t size : {1U, 3U, 8U, 16U, 128U, 240U, 300U}) {
    const std::string bytes(size, 'a');
    for (std::size_t bit = 0; bit < 8 * size; ++bit) {
      std::string changed = bytes;
      changed[bit / 8] = static_cast<char>(changed[bit / 8] ^ (1 << bit % 8));
      ASSERT_NE(checksumOf(changed), checksumOf(bytes)) << size << ' ' << bit;
    }
  }
}

}  // namespace checksum_test
}  // namespace talus
