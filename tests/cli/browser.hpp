#pragma once

#include <string>

#include <talus/cli/draw/scene.hpp>

namespace talus::cli {

/// What Chromium makes of a page: its DOM after the scripts ran, and what it wrote on its console.
struct Shown {
  std::string dom;
  std::string console;
};

/// Opens a page without a window, with these switches for its graphics.
Shown show(const std::string& html, const std::string& graphics = "--disable-gpu");

/// Whether the page's scripts ended well.
bool ready(const Shown& shown);

/// The page with a script behind it that plays the user.
std::string played(std::string html, const std::string& script);
std::string played(const Scene& scene, const std::string& script);

}  // namespace talus::cli
