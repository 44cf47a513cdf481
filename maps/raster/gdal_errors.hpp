#pragma once

#include <string>

namespace talus::maps {

/// Suppresses GDAL's error output during its lifetime and gives access to the last error of this thread.
class GdalErrors {
 public:
  GdalErrors();
  GdalErrors(const GdalErrors&) = delete;
  GdalErrors& operator=(const GdalErrors&) = delete;
  ~GdalErrors();

  /// GDAL's last message, first line; "unknown error" if there is none.
  std::string last() const;
  /// Whether an error of class CE_Failure or worse is the last error since construction.
  bool any() const;
};

}  // namespace talus::maps
