#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <talus/maps/sites/crater_field.hpp>
#include <talus/maps/sites/dune_field.hpp>
#include <talus/maps/sites/landscape.hpp>
#include <talus/maps/sites/value_noise.hpp>

namespace talus::maps {
namespace {

double shorterSide(const Grid& grid) {
  return std::min(grid.width, grid.height) * grid.resolution_m;
}

FractalGround rollingGround(const Grid& grid, std::uint64_t seed, double steepness) {
  const double longest = 0.6 * shorterSide(grid);
  return FractalGround({.seed = seed,
                        .longest_m = longest,
                        .shortest_m = 2 * grid.resolution_m,
                        .amplitude_m = steepness * longest,
                        .hurst = 0.9});
}

// Cratered regolith: loose on ejecta and on the floors of degraded craters, rocky around fresh craters.
class CrateredPlain final : public Landscape {
 public:
  CrateredPlain(const Grid& grid, std::uint64_t seed)
      : ground_(rollingGround(grid, mixed(seed), 0.02)),
        patches_(mixed(seed + 1)),
        craters_(grid, craterField(grid, {.seed = mixed(seed + 2),
                                          .least_diameter_m = 4 * grid.resolution_m,
                                          .greatest_diameter_m = 0.35 * shorterSide(grid)})),
        patch_m_(0.12 * shorterSide(grid)) {}

  Ground at(Point p) const override {
    Ground out{.height_m = ground_(p.x_m, p.y_m)};
    double freshness = 0;
    double fill = 0;
    craters_.forEachNear(p, [&](const Crater& c, double distance_m) {
      out.height_m += c.height_m(distance_m);
      freshness = std::max(freshness, c.freshness(distance_m));
      if (distance_m < 0.6 * c.radius_m) fill = std::max(fill, c.age);
    });
    const double softness =
        std::max(freshness, 0.5 * fill) + 0.25 * patches_(p.x_m / patch_m_, p.y_m / patch_m_);
    out.soil = softness > 0.6 ? SiteClass::VeryLoose : softness > 0.35 ? SiteClass::Loose : SiteClass::Firm;
    out.rock_share = std::clamp(0.004 + 0.3 * freshness * freshness, 0.0, 0.3);
    return out;
  }

 private:
  FractalGround ground_;
  GradientNoise patches_;
  CraterBins craters_;
  double patch_m_;
};

// Dunes over bedrock, which is exposed between the dunes.
class DunePlain final : public Landscape {
 public:
  DunePlain(const Grid& grid, std::uint64_t seed)
      : ground_(rollingGround(grid, mixed(seed), 0.008)),
        outcrop_(mixed(seed + 1)),
        dunes_({.seed = mixed(seed + 2),
                .wavelength_m = wavelength(grid),
                .height_m = wavelength(grid) / 10,
                .wind_rad = 2 * std::numbers::pi * RandomSequence(mixed(seed + 3))()}),
        outcrop_m_(1.5 * wavelength(grid)) {}

  Ground at(Point p) const override {
    const Sand sand = dunes_.at(p.x_m, p.y_m);
    Ground out{.height_m = ground_(p.x_m, p.y_m) + sand.height_m};
    if (sand.slip_face) {
      out.soil = SiteClass::VeryLoose;
    } else if (sand.height_m > 0.15) {
      out.soil = SiteClass::Loose;
    } else if (const double rock = outcrop_(p.x_m / outcrop_m_, p.y_m / outcrop_m_); rock > 0.1) {
      out.soil = SiteClass::Rock;
      out.rock_share = std::min(0.25, 0.5 * (rock - 0.1));
    }
    return out;
  }

 private:
  static double wavelength(const Grid& grid) { return std::max(40.0, 30 * grid.resolution_m); }

  FractalGround ground_;
  GradientNoise outcrop_;
  DuneField dunes_;
  double outcrop_m_;
};

// Rolling duricrust with drifts of loose sand and patches of rocks.
class RockyPlain final : public Landscape {
 public:
  RockyPlain(const Grid& grid, std::uint64_t seed)
      : ground_(rollingGround(grid, mixed(seed), 0.03)),
        rocks_(mixed(seed + 1)),
        drifts_(mixed(seed + 2)),
        patch_m_(0.15 * shorterSide(grid)) {}

  Ground at(Point p) const override {
    const double u = p.x_m / patch_m_;
    const double v = p.y_m / patch_m_;
    Ground out{.height_m = ground_(p.x_m, p.y_m)};
    // 1 to 35 % rock abundance, the range at the Viking and Pathfinder landing sites [golombek_rapp_1997].
    out.rock_share = std::clamp(0.06 * std::exp(2.2 * rocks_(u, v)), 0.01, 0.35);
    const double drift = drifts_(0.7 * u + 31.7, 0.7 * v);
    if (out.rock_share > 0.2)
      out.soil = SiteClass::Rock;
    else if (drift > 0.3)
      out.soil = SiteClass::VeryLoose;
    else if (drift > 0.1)
      out.soil = SiteClass::Loose;
    return out;
  }

 private:
  FractalGround ground_;
  GradientNoise rocks_;
  GradientNoise drifts_;
  double patch_m_;
};

}  // namespace

std::unique_ptr<const Landscape> makeLandscape(const Grid& grid, const SiteOptions& options) {
  switch (options.kind) {
    case SiteKind::Craters:
      return std::make_unique<CrateredPlain>(grid, options.seed);
    case SiteKind::Dunes:
      return std::make_unique<DunePlain>(grid, options.seed);
    case SiteKind::Rocks:
      return std::make_unique<RockyPlain>(grid, options.seed);
  }
  throw std::invalid_argument("site: unknown kind");
}

}  // namespace talus::maps
