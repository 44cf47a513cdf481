#pragma once

#include <memory>
#include <string>

class GDALDataset;

namespace talus::maps {

struct CloseDataset {
  void operator()(GDALDataset* dataset) const noexcept;
};

/// An owned reference to a GDAL dataset. The dataset closes when its last reference is released; a virtual
/// raster derived from the dataset holds a reference, too.
using Dataset = std::unique_ptr<GDALDataset, CloseDataset>;

/// Suppresses GDAL's error output of this thread during the lifetime of the object, and keeps it. Errors of an
/// inner object of the same thread are not kept by the outer one.
class GdalErrors {
 public:
  GdalErrors();
  GdalErrors(const GdalErrors&) = delete;
  GdalErrors& operator=(const GdalErrors&) = delete;
  ~GdalErrors();

  /// Returns the first line of GDAL's last failure, or else of its last warning; "unknown error" if GDAL has
  /// reported neither.
  std::string last() const;
  /// Returns true if an error of class CE_Failure or worse was reported since construction.
  bool any() const { return failed_; }
  /// Returns true if a warning or an error was reported since construction.
  bool anyWarning() const { return !last_.empty(); }

 private:
  std::string last_{};
  bool failed_ = false;
};

}  // namespace talus::maps
