#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>

#include <talus/common/common.hpp>
#include <talus/common/parallel_for.hpp>
#include <talus/maps/sites/site_generator.hpp>

namespace talus::maps {
namespace {

constexpr double kReach = 3.0;  // extent of the ejecta [radii]
constexpr int kBinCells = 32;

// Depth below the rim and height of the rim above the surroundings [diameters]. Fresh craters: depth 0.2, rim
// 0.036 [pike_1977]. Degradation reduces the depth of small craters to a few hundredths
// [fassett_thomson_2014].
double depth(double age) {
  return 0.2 - 0.16 * age;
}
double rim(double age) {
  return 0.036 * (1 - 0.75 * age);
}

// Smooth minimum of two numbers, rounded over a width of about w.
double smoothMinimum(double a, double b, double w) {
  const double d = (a - b) / w;
  return std::min(a, b) - w * std::log1p(std::exp(-std::abs(d)));
}

}  // namespace

double Crater::height_m(double distance_m) const {
  const double r = distance_m / radius_m;
  if (r >= kReach) return 0.0;
  const double diameter_m = 2 * radius_m;
  // Paraboloid inside the rim. Ejecta thickness outside decreases with the cube of the distance
  // [mcgetchin_1973].
  const double bowl = depth(age) * (r * r - 1) + rim(age);
  const double cube = std::pow(std::max(r, 0.5), -3.0) - std::pow(kReach, -3.0);
  const double ejecta = rim(age) * cube;
  return diameter_m * smoothMinimum(bowl, ejecta, 0.004 + 0.016 * age) * std::min(1.0, 4 * (kReach - r));
}

double Crater::freshness(double distance_m) const {
  const double r = distance_m / radius_m;
  if (r >= kReach) return 0.0;
  return (1 - age) * std::min(1.0, std::pow(std::max(r, 0.3), -2.0)) * std::min(1.0, kReach - r);
}

std::vector<Crater> craterField(const Grid& grid, const CraterOptions& options) {
  // Margin for craters outside the grid whose rim or ejecta extend into the grid. Ejecta of the largest
  // craters beyond one diameter (of 1.5) are neglected.
  const double margin_m = options.greatest_diameter_m;
  const double width_m = grid.width * grid.resolution_m + 2 * margin_m;
  const double height_m = grid.height * grid.resolution_m + 2 * margin_m;
  const double least = 1 / std::pow(options.least_diameter_m, 2);
  const double greatest = 1 / std::pow(options.greatest_diameter_m, 2);
  const auto count =
      static_cast<std::size_t>(options.density * width_m * height_m * std::max(0.0, least - greatest));
  RandomSequence random(options.seed);
  std::vector<Crater> craters(count);
  for (Crater& c : craters) {
    c.centre = {grid.south_west.x_m - margin_m + width_m * random(),
                grid.south_west.y_m - margin_m + height_m * random()};
    c.radius_m = 0.5 / std::sqrt(greatest + (least - greatest) * random());
    c.age = std::cbrt(random());
  }
  std::stable_sort(craters.begin(), craters.end(),
                   [](const Crater& a, const Crater& b) { return a.radius_m > b.radius_m; });
  return craters;
}

CraterBins::CraterBins(const Grid& grid, std::vector<Crater> craters)
    : craters_(std::move(craters)),
      south_west_(grid.south_west),
      side_m_(kBinCells * grid.resolution_m),
      columns_((grid.width + kBinCells - 1) / kBinCells),
      rows_((grid.height + kBinCells - 1) / kBinCells),
      bins_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {
  for (std::size_t i = 0; i < craters_.size(); ++i) enter(i);
}

int CraterBins::place(double offset_m, int count) const {
  return static_cast<int>(std::clamp(std::floor(offset_m / side_m_), 0.0, count - 1.0));
}

std::size_t CraterBins::index(int column, int row) const {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
         static_cast<std::size_t>(column);
}

std::size_t CraterBins::bin(Point p) const {
  return index(place(p.x_m - south_west_.x_m, columns_), place(p.y_m - south_west_.y_m, rows_));
}

void CraterBins::enter(std::size_t crater) {
  const Crater& c = craters_[crater];
  const double reach = kReach * c.radius_m;
  const double x = c.centre.x_m - south_west_.x_m;
  const double y = c.centre.y_m - south_west_.y_m;
  if (x + reach < 0 || y + reach < 0 || x - reach > columns_ * side_m_ || y - reach > rows_ * side_m_) return;
  for (int row = place(y - reach, rows_); row <= place(y + reach, rows_); ++row)
    for (int column = place(x - reach, columns_); column <= place(x + reach, columns_); ++column)
      bins_[index(column, row)].push_back(crater);
}

DuneField::DuneField(const DuneOptions& options)
    : options_(options), bend_(options.seed), supply_(mixed(options.seed)) {}

Sand DuneField::at(double x_m, double y_m) const {
  const double along = x_m * std::cos(options_.wind_rad) + y_m * std::sin(options_.wind_rad);
  const double across = y_m * std::cos(options_.wind_rad) - x_m * std::sin(options_.wind_rad);
  const double w = options_.wavelength_m;
  // The crest line varies across the wind only, so that slip faces keep the angle of repose.
  const double phase =
      along / w + 0.45 * bend_(across / (3.0 * w), 0.5) + 0.15 * bend_(across / (0.9 * w), 7.5);
  const double dune = std::floor(phase);
  // The sand supply varies along the crest, independently for each dune.
  const double supply = 0.45 + 1.2 * supply_(across / (4 * w), 1.7 * dune + 0.5);
  const double crest_m = options_.height_m * std::clamp(supply, 0.0, 1.0);
  if (crest_m <= 0) return {};
  const double lee_m = crest_m / std::tan(options_.repose_rad);
  const double stoss_m = 0.92 * w - lee_m;
  const double s = (phase - dune) * w;
  if (s > stoss_m + lee_m) return {};
  if (s > stoss_m) return {.height_m = crest_m * (stoss_m + lee_m - s) / lee_m, .slip_face = true};
  // Cosine profile of the stoss slope.
  const double t = s / stoss_m;
  return {.height_m = crest_m * (0.5 - 0.5 * std::cos(std::numbers::pi * t)), .slip_face = false};
}

namespace {

constexpr double kPatch_m = 8.0;  // side of a square with constant abundance
constexpr int kSizes = 12;        // number of diameter intervals, in geometric progression

// Random integer with the given mean: floor(mean) or floor(mean) + 1.
int chance(double mean, RandomSequence& random) {
  return static_cast<int>(mean + random());
}

}  // namespace

double Rock::height_m(double distance_m) const {
  const double r = distance_m / radius_m;
  return r < 1 ? radius_m * std::sqrt(1 - r * r) : 0.0;
}

double rockDecay_per_m(double total_share) {
  return 1.79 + 0.152 / total_share;
}

std::vector<Rock> rockField(const Grid& grid, const std::function<double(Point)>& abundance,
                            const RockOptions& options) {
  std::vector<Rock> rocks;
  RandomSequence random(options.seed);
  const double width_m = grid.width * grid.resolution_m;
  const double height_m = grid.height * grid.resolution_m;
  const double step = std::pow(options.greatest_diameter_m / options.least_diameter_m, 1.0 / kSizes);
  for (double y = 0; y < height_m; y += kPatch_m)
    for (double x = 0; x < width_m; x += kPatch_m) {
      const Point corner{grid.south_west.x_m + x, grid.south_west.y_m + y};
      const double k = abundance({corner.x_m + kPatch_m / 2, corner.y_m + kPatch_m / 2});
      if (k <= 0) continue;
      const double q = rockDecay_per_m(k);
      double d = options.least_diameter_m;
      for (int i = 0; i < kSizes; ++i, d *= step) {
        // Area fraction of the rocks in this diameter interval, and the radius of a rock.
        const double share = k * (std::exp(-q * d) - std::exp(-q * d * step));
        const double radius_m = 0.5 * d * std::sqrt(step);
        const int count =
            chance(share * kPatch_m * kPatch_m / (std::numbers::pi * radius_m * radius_m), random);
        for (int n = 0; n < count; ++n)
          rocks.push_back({{corner.x_m + kPatch_m * random(), corner.y_m + kPatch_m * random()}, radius_m});
      }
    }
  return rocks;
}

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

namespace {

// Transverse Mercator on the body, true at the centre of the site; x and y are zero at the south-west corner.
Georeference georeference(const SiteOptions& options) {
  const bool moon = options.kind == SiteKind::Craters;
  return Georeference({.name = "generated site",
                       .ellipsoid = moon ? kMoon : kMars,
                       .projection = {.method = ProjectionMethod::TransverseMercator,
                                      .latitude_of_origin_rad = (moon ? -9.0 : -4.6) * kDegree,
                                      .central_meridian_rad = (moon ? 15.5 : 137.4) * kDegree,
                                      .false_easting_m = 0.5 * options.width * options.resolution_m,
                                      .false_northing_m = 0.5 * options.height * options.resolution_m}});
}

void require(bool holds, const char* field, double value, const char* bound) {
  if (!holds)
    throw std::invalid_argument(std::string("site: ") + field + " = " + std::to_string(value) + ", must be " +
                                bound);
}

void check(const SiteOptions& o) {
  require(o.width >= 8 && o.width <= 20000, "width", o.width, "8 to 20000 cells");
  require(o.height >= 8 && o.height <= 20000, "height", o.height, "8 to 20000 cells");
  require(o.resolution_m >= 0.01 && o.resolution_m <= 1000, "resolution_m", o.resolution_m, "0.01 to 1000");
  require(o.threads >= 1, "threads", o.threads, ">= 1");
}

void raise(Site& site, const Rock& rock) {
  const Grid& grid = site.map.grid();
  const auto cell = [&](double offset_m, int count) {
    return std::clamp(static_cast<int>(std::floor(offset_m / grid.resolution_m)), 0, count - 1);
  };
  const double x = rock.centre.x_m - grid.south_west.x_m;
  const double y = rock.centre.y_m - grid.south_west.y_m;
  const double r = rock.radius_m;
  for (int row = cell(y - r, grid.height); row <= cell(y + r, grid.height); ++row)
    for (int column = cell(x - r, grid.width); column <= cell(x + r, grid.width); ++column) {
      const Point p = grid.centre({column, row});
      const double height = rock.height_m(std::hypot(p.x_m - rock.centre.x_m, p.y_m - rock.centre.y_m));
      if (height <= 0) continue;
      site.map.elevation_m[{column, row}] += static_cast<float>(height);
      site.classes[{column, row}] = static_cast<std::uint8_t>(SiteClass::Rock);
    }
}

// Adds the rocks that are large enough for the cell size.
void setRocks(Site& site, const SiteOptions& options) {
  constexpr double kGreatest_m = 4.0;
  const double least_m = std::max(0.3, 1.5 * options.resolution_m);
  if (least_m >= kGreatest_m) return;
  const Grid& grid = site.map.grid();
  const auto abundance = [&](Point p) {
    const auto cell = grid.cellAt(p);
    return cell ? static_cast<double>(site.rock_abundance[*cell]) : 0.0;
  };
  for (const Rock& rock : rockField(grid, abundance,
                                    {.seed = mixed(options.seed + 9),
                                    .least_diameter_m = least_m,
                                    .greatest_diameter_m = kGreatest_m}))
    raise(site, rock);
}

}  // namespace

Site generateSite(const SiteOptions& options, const ProgressMonitor& watch) {
  check(options);
  const Grid grid{.width = options.width, .height = options.height, .resolution_m = options.resolution_m};
  Site site{.map = {.elevation_m = Raster<float>(grid),
                    .georeference = georeference(options),
                    .source = "generated site, seed " + std::to_string(options.seed),
                    .notes = {}},
            .classes = Raster<std::uint8_t>(grid),
            .rock_abundance = Raster<float>(grid)};
  const auto ground = makeLandscape(grid, options);
  forEachStrip({.rows = grid.height, .threads = options.threads}, watch, [&](Rows rows) {
    for (int row = rows.first; row < rows.past; ++row)
      for (int column = 0; column < grid.width; ++column) {
        const Cell cell{column, row};
        const Ground here = ground->at(grid.centre(cell));
        site.map.elevation_m[cell] = static_cast<float>(here.height_m);
        site.classes[cell] = static_cast<std::uint8_t>(here.soil);
        site.rock_abundance[cell] = static_cast<float>(here.rock_share);
      }
  });
  if (watch.stopped()) return {};
  setRocks(site, options);
  return site;
}

}  // namespace talus::maps
