#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <talus/cli/draw/colour.hpp>

namespace talus::cli {

/// An image of pixels, top row first.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint32_t> argb;  ///< pixels with premultiplied alpha, in cairo's format ARGB32

  Image() = default;
  Image(int w, int h)
      : width(w), height(h), argb(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}

  std::uint32_t& at(int x, int y) noexcept {
    return argb[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }
};

/// Returns a colour as a pixel.
std::uint32_t pixel(Colour colour);

/// Returns bytes in Base64 encoding, for data URIs.
std::string base64(const std::string& bytes);

}  // namespace talus::cli
