#pragma once

#include <string>

namespace talus::maps {

/// Keeps GDAL from printing while it lives, and remembers the last error of this thread.
class GdalErrors {
 public:
  GdalErrors();
  GdalErrors(const GdalErrors&) = delete;
  GdalErrors& operator=(const GdalErrors&) = delete;
  ~GdalErrors();

  /// GDAL's last message, or "unknown error".
  std::string last() const;
  /// Whether an error, not a warning, came since construction.
  bool any() const;
};

}  // namespace talus::maps
