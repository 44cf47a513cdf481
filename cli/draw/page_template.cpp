#include <talus/cli/draw/page_template.hpp>

// Embeds the bytes of the file between two symbols in the read-only data.
asm(R"(
  .section .rodata
  talus_page_template: .incbin ")" TALUS_PAGE_TEMPLATE R"("
  talus_page_template_end: .byte 0
  .global talus_page_template
  .global talus_page_template_end
  .text
)");

extern "C" {
extern const char talus_page_template[];      // NOLINT(readability-identifier-naming)
extern const char talus_page_template_end[];  // NOLINT(readability-identifier-naming)
}

namespace talus::cli {

std::string_view pageTemplate() {
  return {talus_page_template, static_cast<std::size_t>(talus_page_template_end - talus_page_template)};
}

}  // namespace talus::cli
