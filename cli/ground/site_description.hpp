#pragma once

#include <string>

#include <talus/maps/sites/site_generator.hpp>

namespace talus::cli {

/// Site kind by its name: craters, dunes or rocks. Throws InputError with the nearest valid name.
maps::SiteKind siteKind(const std::string& name);

/// Reads a site from a YAML file {site: {kind, width, height, resolution_m, seed}}; missing fields take the
/// defaults of SiteOptions. Throws InputError with file and line.
maps::SiteOptions loadSite(const std::string& path);

}  // namespace talus::cli
