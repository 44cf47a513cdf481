#include <array>
#include <cstdint>
#include <stdexcept>

#include <refused.hpp>

#include <talus/cli/draw/canvas.hpp>

namespace talus::cli {
namespace canvas_test {

using testing::HasSubstr;
using testing::StartsWith;

// Big-endian number of four bytes.
std::uint32_t number(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t k = 0; k < 4; ++k) value = value << 8 | static_cast<unsigned char>(bytes[at + k]);
  return value;
}

// Printed in: PNG specification (ISO/IEC 15948), section 11.2.2: width and height are bytes 16 to 23.
TEST(Canvas, PngHasTheRequestedSize) {
  Canvas canvas({.width = 37, .height = 21});
  const std::string bytes = canvas.bytes();
  ASSERT_THAT(bytes, StartsWith("\x89PNG\r\n\x1a\n"));
  EXPECT_EQ(number(bytes, 16), 37U);
  EXPECT_EQ(number(bytes, 20), 21U);
  const std::string image = png(Image(3, 2));
  EXPECT_EQ(number(image, 16), 3U);
  EXPECT_EQ(number(image, 20), 2U);
}

TEST(Canvas, InvalidSizeIsRejected) {
  EXPECT_REFUSED(Canvas({.width = -1, .height = 5}), std::runtime_error, "invalid value (typically too big)");
  EXPECT_REFUSED(Canvas({.width = 1'000'000, .height = 1'000'000}), std::runtime_error,
                 "invalid value (typically too big)");
}

}  // namespace canvas_test
}  // namespace talus::cli
