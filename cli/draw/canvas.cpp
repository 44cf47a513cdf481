#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <cairo.h>
#include <fmt/format.h>
#include <nettle/base64.h>
#include <png.h>

#include <talus/cli/draw/canvas.hpp>
#include <talus/planner/route/route_json.hpp>

namespace talus::cli {

std::string hex(Colour c) {
  return fmt::format("#{:06x}", pixel(c) & 0xFFFFFFU);
}

std::uint32_t pixel(Colour c) {
  const auto byte = [](double v) {
    return static_cast<std::uint32_t>(255.0 * std::clamp(v, 0.0, 1.0) + 0.5);
  };
  return byte(c.alpha) << 24 | byte(c.red * c.alpha) << 16 | byte(c.green * c.alpha) << 8 |
         byte(c.blue * c.alpha);
}

Colour colourOf(terramech::Category category) {
  return rgb(planner::categoryColour(category));
}

Colour seriesColour(std::size_t i) {
  static constexpr std::array kColours{rgb(0x0072B2), rgb(0xD55E00), rgb(0x009E73), rgb(0xCC79A7),
                                       rgb(0xE69F00), rgb(0x56B4E9), rgb(0x000000), rgb(0xB8A800)};
  return kColours[i % kColours.size()];
}

Scale viridis() {
  static constexpr std::array kAnchors{rgb(0x440154), rgb(0x472D7B), rgb(0x3B528B),
                                       rgb(0x2C728E), rgb(0x21918C), rgb(0x28AE80),
                                       rgb(0x5EC962), rgb(0xADDC30), rgb(0xFDE725)};
  return kAnchors;
}

Scale blueRed() {
  static constexpr std::array kAnchors{rgb(0x2166AC), rgb(0x67A9CF), rgb(0xD1E5F0), rgb(0xF7F7F7),
                                       rgb(0xFDDBC7), rgb(0xEF8A62), rgb(0xB2182B)};
  return kAnchors;
}

Colour at(Scale scale, double t) {
  constexpr double kSteps = 31.0;
  const double stepped = std::round(std::clamp(t, 0.0, 1.0) * kSteps) / kSteps;
  const double place = stepped * static_cast<double>(scale.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(place), scale.size() - 2);
  const double f = place - static_cast<double>(i);
  const auto mix = [f](double a, double b) { return a + f * (b - a); };
  const Colour a = scale[i];
  const Colour b = scale[i + 1];
  return {mix(a.red, b.red), mix(a.green, b.green), mix(a.blue, b.blue), 1.0};
}

namespace {

void setColour(cairo_t* cairo, Colour c) {
  cairo_set_source_rgba(cairo, c.red, c.green, c.blue, c.alpha);
}

void trace(cairo_t* cairo, std::span<const Spot> spots) {
  cairo_new_path(cairo);
  for (const Spot& s : spots) cairo_line_to(cairo, s.x, s.y);
}

void setFont(cairo_t* cairo, const TextStyle& style) {
  cairo_select_font_face(cairo, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                         style.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cairo, style.size);
}

}  // namespace

Canvas::Canvas(const Options& o) : cairo_(nullptr, cairo_destroy) {
  cairo_surface_t* surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, o.width, o.height);
  cairo_.reset(cairo_create(surface));
  cairo_surface_destroy(surface);  // the context keeps it
  if (const cairo_status_t status = cairo_status(cairo_.get()); status != CAIRO_STATUS_SUCCESS)
    throw std::runtime_error(std::string("cannot draw: ") + cairo_status_to_string(status));
  cairo_set_line_join(cairo_.get(), CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_cap(cairo_.get(), CAIRO_LINE_CAP_ROUND);
  fill({0, 0, static_cast<double>(o.width), static_cast<double>(o.height)}, rgb(0xFFFFFF));
}

void Canvas::fill(const Box& box, Colour colour) {
  setColour(cairo_.get(), colour);
  cairo_rectangle(cairo_.get(), box.x, box.y, box.width, box.height);
  cairo_fill(cairo_.get());
}

void Canvas::line(std::span<const Spot> spots, const Stroke& stroke) {
  cairo_t* c = cairo_.get();
  setColour(c, stroke.colour);
  cairo_set_line_width(c, stroke.width);
  trace(c, spots);
  cairo_stroke(c);
}

void Canvas::polygon(std::span<const Spot> spots, Colour colour) {
  setColour(cairo_.get(), colour);
  trace(cairo_.get(), spots);
  cairo_fill(cairo_.get());
}

void Canvas::disc(Spot centre, double radius, Colour colour) {
  setColour(cairo_.get(), colour);
  cairo_new_path(cairo_.get());
  cairo_arc(cairo_.get(), centre.x, centre.y, radius, 0.0, 2.0 * std::numbers::pi);
  cairo_fill(cairo_.get());
}

void Canvas::text(const std::string& text, Spot spot, const TextStyle& style) {
  cairo_t* c = cairo_.get();
  cairo_save(c);
  setFont(c, style);
  cairo_translate(c, spot.x, spot.y);
  cairo_move_to(c, -style.anchor * textWidth(text, style), 0.0);
  if (style.halo) {
    cairo_text_path(c, text.c_str());
    setColour(c, faded(rgb(0xFFFFFF), 0.85));
    cairo_set_line_width(c, style.size / 4.0);
    cairo_stroke_preserve(c);
    setColour(c, style.colour);
    cairo_fill(c);
  } else {
    setColour(c, style.colour);
    cairo_show_text(c, text.c_str());
  }
  cairo_restore(c);
}

double Canvas::textWidth(const std::string& text, const TextStyle& style) {
  setFont(cairo_.get(), style);
  cairo_text_extents_t extents;
  cairo_text_extents(cairo_.get(), text.c_str(), &extents);
  return extents.x_advance;
}

void Canvas::image(const Image& image, const Box& box) {
  cairo_t* c = cairo_.get();
  auto* data = reinterpret_cast<unsigned char*>(const_cast<std::uint32_t*>(image.argb.data()));  // only read
  cairo_surface_t* source = cairo_image_surface_create_for_data(data, CAIRO_FORMAT_ARGB32, image.width,
                                                                image.height, 4 * image.width);
  cairo_save(c);
  cairo_translate(c, box.x, box.y);
  cairo_scale(c, box.width / image.width, box.height / image.height);
  cairo_set_source_surface(c, source, 0.0, 0.0);
  cairo_pattern_set_filter(cairo_get_source(c),
                           box.width > image.width ? CAIRO_FILTER_NEAREST : CAIRO_FILTER_GOOD);
  cairo_paint(c);
  cairo_restore(c);
  cairo_surface_destroy(source);
}

void Canvas::clip(const Box& box) {
  cairo_save(cairo_.get());
  cairo_rectangle(cairo_.get(), box.x, box.y, box.width, box.height);
  cairo_clip(cairo_.get());
}

void Canvas::unclip() {
  cairo_restore(cairo_.get());
}

std::string Canvas::bytes() {
  cairo_surface_t* from = cairo_get_target(cairo_.get());
  cairo_surface_flush(from);
  Image image(cairo_image_surface_get_width(from), cairo_image_surface_get_height(from));
  const auto* pixels = reinterpret_cast<const std::uint32_t*>(cairo_image_surface_get_data(from));
  for (std::size_t i = 0; i < image.argb.size(); ++i) image.argb[i] = pixels[i] | 0xFF000000U;
  return png(image);
}

std::string png(const Image& image) {
  const bool opaque = std::ranges::all_of(image.argb, [](std::uint32_t p) { return p >= 0xFF000000U; });
  std::vector<std::uint8_t> samples;
  samples.reserve(4 * image.argb.size());
  for (const std::uint32_t p : image.argb) {
    const std::uint32_t alpha = p >> 24;
    for (const unsigned shift : {16U, 8U, 0U})
      samples.push_back(
          static_cast<std::uint8_t>(alpha == 0 ? 0 : ((p >> shift & 255) * 255 + alpha / 2) / alpha));
    if (!opaque) samples.push_back(static_cast<std::uint8_t>(alpha));
  }
  png_image file{};
  file.version = PNG_IMAGE_VERSION;
  file.width = static_cast<png_uint_32>(image.width);
  file.height = static_cast<png_uint_32>(image.height);
  file.format = opaque ? PNG_FORMAT_RGB : PNG_FORMAT_RGBA;
  file.flags = PNG_IMAGE_FLAG_FAST;
  std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(file), ' ');
  png_alloc_size_t size = bytes.size();
  if (png_image_write_to_memory(&file, bytes.data(), &size, 0, samples.data(), 0, nullptr) == 0)
    throw std::runtime_error(std::string("cannot write a PNG image: ") + file.message);
  bytes.resize(size);
  return bytes;
}

std::string base64(const std::string& bytes) {
  std::string text(BASE64_ENCODE_RAW_LENGTH(bytes.size()), ' ');
  base64_encode_raw(text.data(), bytes.size(), reinterpret_cast<const std::uint8_t*>(bytes.data()));
  return text;
}

void outline(Canvas& canvas, const Box& b, const Stroke& stroke) {
  const std::array<Spot, 5> corners{
      {{b.x, b.y}, {b.x + b.width, b.y}, {b.x + b.width, b.y + b.height}, {b.x, b.y + b.height}, {b.x, b.y}}};
  canvas.line(corners, stroke);
}

}  // namespace talus::cli
