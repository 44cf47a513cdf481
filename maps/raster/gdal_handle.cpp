#include <cpl_error.h>
#include <gdal_priv.h>

#include <talus/maps/raster/gdal_handle.hpp>

namespace talus::maps {

void CloseDataset::operator()(GDALDataset* dataset) const noexcept {
  if (dataset != nullptr) dataset->ReleaseRef();
}

GdalErrors::GdalErrors() {
  CPLErrorReset();
  const auto keep = [](CPLErr kind, CPLErrorNum, const char* message) {
    auto& self = *static_cast<GdalErrors*>(CPLGetErrorHandlerUserData());
    if (kind < CE_Warning || (kind == CE_Warning && self.failed_)) return;
    self.last_ = message;
    self.last_ = self.last_.substr(0, self.last_.find('\n'));
    self.failed_ = self.failed_ || kind >= CE_Failure;
  };
  CPLPushErrorHandlerEx(keep, this);
}

GdalErrors::~GdalErrors() {
  CPLPopErrorHandler();
}

std::string GdalErrors::last() const {
  return last_.empty() ? "unknown error" : last_;
}

}  // namespace talus::maps
