#pragma once

#include <string>

#include <talus/maps/sites/site_generator.hpp>

namespace talus::cli {

/// Returns the kind of a generated site by its name: craters, dunes or rocks. Throws InputError with the
/// nearest valid name.
maps::SiteKind siteKind(const std::string& name);

/// Returns the options of a generated site from a YAML file {site: {kind, width, height, resolution_m,
/// seed}}; missing fields have the defaults of SiteOptions. Throws InputError with file and line.
maps::SiteOptions loadSite(const std::string& path);

}  // namespace talus::cli
