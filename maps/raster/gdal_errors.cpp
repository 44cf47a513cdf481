#include <cpl_error.h>

#include <talus/maps/raster/gdal_errors.hpp>

namespace talus::maps {

GdalErrors::GdalErrors() {
  CPLErrorReset();
  CPLPushErrorHandler(CPLQuietErrorHandler);
}

GdalErrors::~GdalErrors() {
  CPLPopErrorHandler();
}

std::string GdalErrors::last() const {
  const std::string message = CPLGetLastErrorMsg();
  return message.empty() ? "unknown error" : message.substr(0, message.find('\n'));
}

bool GdalErrors::any() const {
  return CPLGetLastErrorType() >= CE_Failure;
}

}  // namespace talus::maps
