#pragma once

#include <string_view>

namespace talus::cli {

/// The page without its data, assembled at build time from cli/page/, Leaflet and Vega. Place-holders in
/// order: @TALUS_TITLE@, @TALUS_SUBTITLE@, @TALUS_DATA@.
std::string_view pageTemplate();

}  // namespace talus::cli
