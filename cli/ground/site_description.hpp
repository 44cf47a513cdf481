#pragma once

#include <string>

#include <talus/maps/sites/site_generator.hpp>

namespace talus::cli {

/// The kind of a site by its name: craters, dunes or rocks. Throws InputError with the nearest name.
maps::SiteKind siteKind(const std::string& name);

/// A site as a YAML file describes it: {site: {kind, width, height, resolution_m, seed}}; what is left out
/// takes the default of SiteOptions. Throws InputError with file and line.
maps::SiteOptions loadSite(const std::string& path);

}  // namespace talus::cli
