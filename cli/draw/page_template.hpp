#pragma once

#include <string_view>

namespace talus::cli {

/// Returns the HTML page without its data, assembled at build time from cli/page/, Leaflet and Vega. It has
/// the place-holders @TALUS_TITLE@, @TALUS_SUBTITLE@ and @TALUS_DATA@ in this order.
std::string_view pageTemplate();

}  // namespace talus::cli
