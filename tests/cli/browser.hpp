#pragma once

#include <string>

#include <talus/cli/draw/scene.hpp>

namespace talus::cli {

/// A page loaded in Chromium: its DOM (document tree) after the scripts ran, and the console output.
struct Shown {
  std::string dom;
  std::string console;
};

/// Opens a page in headless Chromium; `graphics` are the command line switches for rendering.
Shown show(const std::string& html, const std::string& graphics = "--disable-gpu");

/// Returns true if the scripts of the page completed.
bool ready(const Shown& shown);

/// Returns the page with an appended script that simulates user input.
std::string played(std::string html, const std::string& script);
std::string played(const Scene& scene, const std::string& script);

}  // namespace talus::cli
