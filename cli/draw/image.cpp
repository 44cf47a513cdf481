#include <algorithm>
#include <cmath>

#include <nettle/base64.h>

#include <talus/cli/draw/image.hpp>

namespace talus::cli {

std::uint32_t pixel(Colour c) {
  const auto byte = [](double v) {
    return static_cast<std::uint32_t>(std::lround(255.0 * std::clamp(v, 0.0, 1.0)));
  };
  return byte(c.alpha) << 24 | byte(c.red * c.alpha) << 16 | byte(c.green * c.alpha) << 8 |
         byte(c.blue * c.alpha);
}

std::string base64(const std::string& bytes) {
  std::string text(BASE64_ENCODE_RAW_LENGTH(bytes.size()), ' ');
  base64_encode_raw(text.data(), bytes.size(), reinterpret_cast<const std::uint8_t*>(bytes.data()));
  return text;
}

}  // namespace talus::cli
