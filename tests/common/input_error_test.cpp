#include <talus/common/common.hpp>

namespace talus {
namespace input_error_test {

TEST(InputError, MessageHasPlaceReasonAndRemedyOnOneLine) {
  EXPECT_STREQ(InputError({"a.csv:3", "no slip", "add it"}).what(), "a.csv:3: no slip; add it");
  EXPECT_STREQ(InputError({"a.csv", "is empty", ""}).what(), "a.csv: is empty");
}

}  // namespace input_error_test
}  // namespace talus
