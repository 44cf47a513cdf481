#pragma once

#include <string>

namespace talus::maps {

/// Suppresses GDAL's error output during the lifetime of the object, and gives access to the last error of
/// this thread.
class GdalErrors {
 public:
  GdalErrors();
  GdalErrors(const GdalErrors&) = delete;
  GdalErrors& operator=(const GdalErrors&) = delete;
  ~GdalErrors();

  /// Returns the first line of GDAL's last message; "unknown error" if GDAL has reported no error.
  std::string last() const;
  /// Returns true if the last error since construction has class CE_Failure or worse.
  bool any() const;
};

}  // namespace talus::maps
