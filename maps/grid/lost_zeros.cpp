#include <algorithm>
#include <cmath>
#include <limits>

#include <talus/maps/grid/lost_zeros.hpp>

namespace talus::maps {
namespace {

// True if a value counts as 0, including positive numbers below 1e-37: a number at the edge of a lost byte
// range keeps only its low bytes.
bool isZero(float value) {
  constexpr float kTiny = 1e-37F;
  return !std::signbit(value) && value < kTiny;
}

// Adds the run with a margin of one cell: the number beside a lost byte range may be lost in part. The margin
// of a run at the end of a row includes the first cell of the next row, because the file continues there.
void addAround(const CellRun& run, int width, int height, std::vector<CellRun>& to) {
  const int first = std::max(run.first - 1, 0), last = std::min(run.last + 1, width - 1);
  for (int row = std::max(run.row - 1, 0); row <= std::min(run.row + 1, height - 1); ++row)
    to.push_back({row, first, last});
  if (run.first == 0 && run.row > 0) to.push_back({run.row - 1, width - 1, width - 1});
  if (run.last == width - 1 && run.row + 1 < height) to.push_back({run.row + 1, 0, 0});
}

}  // namespace

LostZeros::LostZeros(int width, bool zero_is_ordinary) : width_(width), zero_is_ordinary_(zero_is_ordinary) {}

float LostZeros::at(int row, int column) const {
  const int oldest = rows_ - static_cast<int>(near_.size());
  if (row < oldest || row >= rows_ || column < 0 || column >= width_)
    return std::numeric_limits<float>::quiet_NaN();
  return near_[static_cast<std::size_t>(row - oldest)][static_cast<std::size_t>(column)];
}

void LostZeros::add(std::span<const float> row) {
  near_.emplace_back(row.begin(), row.end());
  if (near_.size() > 2 * kBehind + 1) near_.pop_front();
  ++rows_;
  if (rows_ > kBehind) search(rows_ - 1 - kBehind);
}

std::uint32_t LostZeros::root(std::uint32_t region) {
  while (regions_[region].parent != region)
    region = regions_[region].parent = regions_[regions_[region].parent].parent;
  return region;
}

// Assigns the run to the region of all touching runs of the previous row, merging their regions, or to a new
// region.
void LostZeros::join(std::size_t run) {
  Run& of = runs_[run];
  of.region = static_cast<std::uint32_t>(regions_.size());
  const auto begin = runs_.begin() + static_cast<std::ptrdiff_t>(above_);
  const auto end = runs_.begin() + static_cast<std::ptrdiff_t>(here_);
  const auto ends_before = [](const Run& above, int column) { return above.cells.last < column; };
  auto above = std::lower_bound(begin, end, of.cells.first, ends_before);
  for (; above != end && above->cells.first <= of.cells.last; ++above) {
    const std::uint32_t other = root(above->region);
    if (of.region == regions_.size()) {
      of.region = other;
    } else if (of.region != other) {
      regions_[of.region].steps += regions_[other].steps;
      regions_[of.region].abrupt += regions_[other].abrupt;
      regions_[other].parent = of.region;
    }
  }
  if (of.region == regions_.size()) regions_.push_back({of.region});
}

void LostZeros::look(const Step& step, Region& region) const {
  float before = at(step.row + step.down, step.column + step.right);
  if (std::isnan(before) || isZero(before)) return;
  const float first = std::abs(before);
  float greatest = 0.0F;
  for (int k = 2; k <= kBehind; ++k) {
    const float next = at(step.row + k * step.down, step.column + k * step.right);
    if (std::isnan(next)) break;
    greatest = std::max(greatest, std::abs(next - before));
    before = next;
  }
  constexpr float kAbrupt = 3.0F;
  ++region.steps;
  region.abrupt += greatest > 0.0F && first > kAbrupt * greatest ? 1U : 0U;
}

// Finds the runs of zeros in a row. The kBehind rows on both sides must have been added before, except beyond
// the map.
void LostZeros::search(int row) {
  above_ = here_;
  here_ = runs_.size();
  const std::vector<float>& values = near_[static_cast<std::size_t>(row - (rows_ - std::ssize(near_)))];
  for (int column = 0; column < width_; ++column) {
    if (!isZero(values[static_cast<std::size_t>(column)])) continue;
    const int first = column;
    while (column + 1 < width_ && isZero(values[static_cast<std::size_t>(column) + 1])) ++column;
    runs_.push_back({{row, first, column}, 0});
    join(runs_.size() - 1);
    Region& region = regions_[runs_.back().region];
    look({row, first, 0, -1}, region);
    look({row, column, 0, 1}, region);
    for (int c = first; c <= column; ++c)
      for (const int down : {-1, 1}) look({row, c, down, 0}, region);
  }
}

// Sets Region::follows: every row of the region must span west to east. The first row may begin later, and
// the last row may end earlier.
void LostZeros::boundRegions() {
  std::vector<bool> seen(regions_.size());
  for (const Run& run : runs_) {
    const std::uint32_t own = root(run.region);
    Region& region = regions_[own];
    if (!seen[own]) region.first_row = run.cells.row, region.west = run.cells.first;
    region.last_row = run.cells.row;
    region.west = std::min(region.west, run.cells.first);
    region.east = seen[own] ? std::max(region.east, run.cells.last) : run.cells.last;
    seen[own] = true;
  }
  std::vector<int> row_before(regions_.size(), -1);
  for (const Run& run : runs_) {
    const std::uint32_t own = root(run.region);
    Region& region = regions_[own];
    const bool begins = run.cells.row == region.first_row || run.cells.first == region.west,
               ends = run.cells.row == region.last_row || run.cells.last == region.east;
    region.follows &= begins && ends && row_before[own] != run.cells.row;
    row_before[own] = run.cells.row;
  }
}

LostCells LostZeros::finish() {
  for (int row = std::max(rows_ - kBehind, 0); row < rows_; ++row) search(row);
  if (zero_is_ordinary_) boundRegions();
  LostCells lost;
  for (const Run& run : runs_) {
    const Region& region = regions_[root(run.region)];
    if (2 * region.abrupt <= region.steps || !region.follows) continue;
    addAround(run.cells, width_, rows_, lost.runs);
    lost.count += static_cast<std::size_t>(run.cells.last - run.cells.first) + 1;
  }
  return lost;
}

}  // namespace talus::maps
