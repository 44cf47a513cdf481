#include <algorithm>
#include <regex>
#include <string>

#include <talus/cli/draw/page_template.hpp>

namespace talus::cli {
namespace page_template_test {

std::size_t count(std::string_view text, std::string_view part) {
  std::size_t found = 0;
  for (auto at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++found;
  return found;
}

// Property: the template contains each placeholder, and the placeholder of the data once and last.
TEST(PageTemplate, TemplateContainsItsPlaceholders) {
  const std::string_view page = pageTemplate();
  EXPECT_TRUE(page.starts_with("<!") || page.starts_with("<html"));
  EXPECT_NE(page.find("</html>"), page.npos);
  EXPECT_EQ(page.find('\0'), page.npos);
  EXPECT_GE(count(page, "@TALUS_TITLE@"), 1U);
  EXPECT_GE(count(page, "@TALUS_SUBTITLE@"), 1U);
  EXPECT_EQ(count(page, "@TALUS_DATA@"), 1U);
  EXPECT_GT(page.find("@TALUS_DATA@"), std::max(page.rfind("@TALUS_TITLE@"), page.rfind("@TALUS_SUBTITLE@")));
}

// Property: the template loads no external script, style sheet or image.
TEST(PageTemplate, TemplateLoadsNoExternalResource) {
  const std::string page(pageTemplate());
  EXPECT_EQ(count(page, "<script src"), 0U);
  EXPECT_EQ(count(page, "<link "), 0U);
  EXPECT_EQ(count(page, "@import"), 0U);
}

}  // namespace page_template_test
}  // namespace talus::cli
