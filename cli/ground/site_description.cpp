#include <array>
#include <utility>

#include <talus/cli/ground/site_description.hpp>
#include <talus/common/input_error.hpp>
#include <talus/common/nearest_name.hpp>
#include <talus/terramech/io/yaml_fields.hpp>

namespace talus::cli {
namespace {

constexpr std::array<std::pair<const char*, maps::SiteKind>, 3> kKinds{{{"craters", maps::SiteKind::Craters},
                                                                        {"dunes", maps::SiteKind::Dunes},
                                                                        {"rocks", maps::SiteKind::Rocks}}};

}  // namespace

maps::SiteKind siteKind(const std::string& name) {
  for (const auto& [word, kind] : kKinds)
    if (name == word) return kind;
  const std::string near = nearestName(name, {"craters", "dunes", "rocks"});
  throw InputError({"site '" + name + "'", "is not a kind of site",
                    near.empty() ? "choose craters, dunes or rocks" : "did you mean '" + near + "'?"});
}

maps::SiteOptions loadSite(const std::string& path) {
  const terramech::YamlFields file = terramech::YamlFields::file(path);
  file.only({"site"});
  const terramech::YamlFields fields = file.fields("site");
  fields.only({"kind", "width", "height", "resolution_m", "seed"});
  maps::SiteOptions site;
  site.kind = siteKind(fields.word("kind"));
  site.width = fields.integer("width", site.width);
  site.height = fields.integer("height", site.width);
  site.resolution_m = fields.number("resolution_m", site.resolution_m);
  const int seed = fields.integer("seed", 1);
  if (seed < 0) fields.refuse("seed", "seed = " + std::to_string(seed) + ", must be >= 0", "");
  site.seed = static_cast<std::uint64_t>(seed);
  return site;
}

}  // namespace talus::cli
