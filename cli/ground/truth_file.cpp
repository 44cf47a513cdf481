#include <algorithm>
#include <cmath>

#include <talus/cli/ground/truth_file.hpp>
#include <talus/common/common.hpp>
#include <talus/terramech/io/terramech_io.hpp>
#include <talus/terramech/io/yaml_fields.hpp>

namespace talus::cli {

using terramech::Soil;
using terramech::YamlFields;

const char* const kTruthFormat =
    "TRUTH.yaml, all parts optional (docs/simulation.md):\n"
    "  classes: {1: dry_sand, 2: SOIL}   true soils of terrain classes, if different from the map\n"
    "  patches:                          soft patches in every world, not in the class raster\n"
    "    - {x_m: 40, y_m: 25, radius_m: 4, soil: mars_drift}\n"
    "  random:                           variation between worlds\n"
    "    spread: 0.1                     relative std of cohesion, tan(friction) and moduli\n"
    "    as_believed: true               departures of the ground as the map believes (mean and places)\n"
    "    patches: 8                      number of random patches, away from start and goal\n"
    "    patch_radius_m: 3               mean patch radius; each varies by +-50 %\n"
    "    patch_soil: mars_drift\n"
    "  effects:                          effects on all soils, unknown to the planner\n"
    "    - {name: slip_sinkage_ding, parameters: [0.4]}\n"
    "  second_slip: true                 the rover measures rim speed and odometry, too\n"
    "  soils:                            soils defined in this file\n"
    "    - {name: SOIL, cohesion_kPa: 0.2, friction_angle_deg: 24, ...}\n"
    "SOIL: a name in the library or in `soils:`, a YAML file, or the fields of a soil in braces.\n";

namespace {

Soil soilUnder(const YamlFields& fields, const std::string& name, const YamlFields& file,
               const std::string& path) {
  if (fields.isMapping(name)) return terramech::readSoil(fields.fields(name)).mean;
  const std::string word = fields.word(name);
  if (file.has("soils")) {
    const auto own = terramech::loadSoils(path);
    const auto found =
        std::find_if(own.begin(), own.end(), [&](const auto& soil) { return soil.mean.name == word; });
    if (found != own.end()) return found->mean;
  }
  try {
    return terramech::loadSoil(word);
  } catch (const InputError& error) {
    fields.refuse(name, word + ": " + error.parts().reason, error.parts().remedy);
  }
}

double positive(const YamlFields& fields, const std::string& name, double fallback) {
  const double value = fields.number(name, fallback);
  if (!(value > 0.0)) fields.refuse(name, name + " must be > 0", "");
  return value;
}

planner::SoilPatch patchOf(const YamlFields& fields, const YamlFields& file, const std::string& path) {
  fields.only({"x_m", "y_m", "radius_m", "soil"});
  planner::SoilPatch patch{{fields.number("x_m"), fields.number("y_m")}, 0.0, {}};
  if (!std::isfinite(patch.centre.x_m)) fields.refuse("x_m", "x_m is not a finite number", "");
  if (!std::isfinite(patch.centre.y_m)) fields.refuse("y_m", "y_m is not a finite number", "");
  patch.radius_m = positive(fields, "radius_m", 0.0);
  patch.soil = soilUnder(fields, "soil", file, path);
  return patch;
}

void readRandom(const YamlFields& random, const YamlFields& file, const std::string& path,
                planner::Truth& truth) {
  random.only({"spread", "as_believed", "patches", "patch_radius_m", "patch_soil"});
  truth.spread = random.number("spread", 0.0);
  if (!(truth.spread >= 0.0 && truth.spread <= 1.0)) random.refuse("spread", "spread must lie in [0, 1]", "");
  truth.as_believed = random.flag("as_believed", false);
  truth.random_patches = random.integer("patches", 0);
  if (truth.random_patches < 0 || truth.random_patches > 10000)
    random.refuse("patches", "patches must lie in [0, 10000]", "");
  truth.patch_radius_m = positive(random, "patch_radius_m", truth.patch_radius_m);
  if (random.has("patch_soil")) truth.patch_soil = soilUnder(random, "patch_soil", file, path);
}

}  // namespace

planner::Truth readTruth(const std::string& path) {
  const YamlFields file = YamlFields::file(path);
  const std::vector<std::string> more{"patches", "random", "effects", "second_slip"};
  std::vector<std::string> known = more;
  known.insert(known.end(), {"classes", "terrain_classes", "soils"});
  file.only(known);
  planner::Truth truth;
  if (file.has("classes") || file.has("terrain_classes"))
    for (const auto& [number, prior] : terramech::loadTerrainClasses(path, more))
      truth.classes[number] = prior.mean;
  for (const YamlFields& patch : file.list("patches")) truth.patches.push_back(patchOf(patch, file, path));
  truth.patch_soil = terramech::loadSoil("mars_drift");
  truth.effects = terramech::readEffects(file);
  truth.second_slip = file.flag("second_slip", true);
  if (file.has("random")) readRandom(file.fields("random"), file, path, truth);
  return truth;
}

}  // namespace talus::cli
