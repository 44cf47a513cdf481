#include <talus/cli/draw/image.hpp>

namespace talus::cli {
namespace image_test {

TEST(Base64, EncodingMatchesTheRfcTestVectors) {
  // Printed in: RFC 4648, section 10.
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foob"), "Zm9vYg==");
  EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
}

}  // namespace image_test
}  // namespace talus::cli
