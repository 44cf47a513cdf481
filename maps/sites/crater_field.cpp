#include <algorithm>
#include <cmath>
#include <numbers>

#include <talus/maps/sites/crater_field.hpp>
#include <talus/maps/sites/value_noise.hpp>

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

}  // namespace talus::maps
