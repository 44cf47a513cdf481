#include <array>
#include <cmath>
#include <utility>

#include <talus/planner/field/cost_to_go.hpp>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace talus::planner {
namespace {

constexpr std::uint32_t kNoCell = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t kOverhang = 4;  // elements that a vector load reads beyond the last row
constexpr std::size_t kAhead = 12;    // prefetch distance in cells of a bucket

std::array<std::ptrdiff_t, 8> neighbourOffsets(const PaddedGrid& padded) noexcept {
  std::array<std::ptrdiff_t, 8> offsets{};
  for (int heading = 0; heading < 8; ++heading)
    offsets[static_cast<std::size_t>(heading)] = padded.offset(heading);
  return offsets;
}

// Bit mask of the headings whose neighbour is cheaper to reach through the cell at `distance`.
struct ImprovedByScalar {
  static unsigned of(const std::uint32_t* distance, const std::uint16_t* into,
                     std::ptrdiff_t stride) noexcept {
    const std::uint32_t* above = distance + stride;
    const std::uint32_t* below = distance - stride;
    const std::array<std::uint32_t, 8> present{distance[1],  above[1],  above[0], above[-1],
                                               distance[-1], below[-1], below[0], below[1]};
    unsigned better = 0;
    for (unsigned k = 0; k < 8; ++k)
      if (into[k] != EdgeLayer::kBlocked && *distance + into[k] < present[k]) better |= 1U << k;
    return better;
  }
};

#if defined(__x86_64__)
// AVX2 version of ImprovedByScalar, which compares eight neighbours at once.
struct ImprovedByVector {
  __attribute__((target("avx2"))) static unsigned of(const std::uint32_t* distance, const std::uint16_t* into,
                                                     std::ptrdiff_t stride) noexcept {
    const auto load = [](const std::uint32_t* from) __attribute__((target("avx2"))) {
      return _mm_loadu_si128(reinterpret_cast<const __m128i*>(from));
    };
    const __m128i above =
        _mm_shuffle_epi32(load(distance + stride - 1), _MM_SHUFFLE(0, 1, 2, 3));  // . NE N NW
    const __m128i below =
        _mm_shuffle_epi32(load(distance - stride - 1), _MM_SHUFFLE(2, 1, 0, 0));  // . SW S SE
    const __m128i first = _mm_insert_epi32(above, static_cast<int>(distance[1]), 0);
    const __m128i second = _mm_insert_epi32(below, static_cast<int>(distance[-1]), 0);
    const __m256i present = _mm256_set_m128i(second, first);
    const __m128i steps = _mm_loadu_si128(reinterpret_cast<const __m128i*>(into));
    const __m256i edges = _mm256_cvtepu16_epi32(steps);
    const __m256i through = _mm256_add_epi32(edges, _mm256_set1_epi32(static_cast<int>(*distance)));
    const __m256i blocked = _mm256_cmpeq_epi32(edges, _mm256_set1_epi32(EdgeLayer::kBlocked));
    const __m256i no_better = _mm256_cmpeq_epi32(_mm256_min_epu32(through, present), present);
    const __m256i worse = _mm256_or_si256(blocked, no_better);
    return ~static_cast<unsigned>(_mm256_movemask_ps(_mm256_castsi256_ps(worse))) & 0xffU;
  }
};
#else
using ImprovedByVector = ImprovedByScalar;
#endif

// Pointers to the distances and edges around a cell.
struct Surroundings {
  std::uint32_t* distance;
  const std::uint16_t* edges;
  std::ptrdiff_t stride;

  const std::uint16_t* into(std::size_t cell) const noexcept { return edges + 8 * cell; }
  void prefetch(std::size_t cell) const noexcept {
    const std::uint32_t* at = distance + cell;
    __builtin_prefetch(into(cell));
    __builtin_prefetch(at - stride, 1);
    __builtin_prefetch(at, 1);
    __builtin_prefetch(at + stride, 1);
  }
};

template <typename Motion>
std::vector<GridLink> links(const MotionCost& cost, maps::Point place, Motion motion) {
  std::vector<GridLink> found;
  const maps::Grid& grid = cost.map().grid();
  const auto own = grid.cellAt(place);
  if (!own) return found;
  for (int row = own->row - 1; row <= own->row + 1; ++row)
    for (int column = own->column - 1; column <= own->column + 1; ++column) {
      const maps::Cell cell{column, row};
      if (!grid.contains(cell)) continue;
      const double link_J = cost(motion(grid.centre(cell)));
      if (std::isfinite(link_J)) found.push_back({cell, link_J});
    }
  return found;
}

}  // namespace

CostToGo::CostToGo(std::shared_ptr<const EdgeLayer> edges, const std::vector<FieldGoal>& goals,
                   Kernels kernels)
    : edges_(std::move(edges)),
      distance_(makeLargeArray<std::uint32_t>(edges_->padded().size() + kOverhang)),
      vectors_(vectorsRun(kernels)) {
  std::fill_n(distance_.get(), edges_->padded().size() + kOverhang, kUnreached);
  // A bucket is at most as wide as the cheapest edge. Its cells cannot improve each other, so they are final
  // when the bucket is taken and need no order among themselves (Denardo & Fox 1979 [denardo_fox_1979]).
  shift_ = static_cast<unsigned>(std::bit_width(edges_->units().cheapestEdge()) - 1);
  const std::size_t ring = std::bit_ceil((std::size_t{EdgeLayer::kBlocked} >> shift_) + 2);
  buckets_.resize(ring);
  for (const FieldGoal& goal : goals) {
    const double units =
        std::min(std::round(goal.cost_J / edges_->units().unit_J()), double{EdgeLayer::kBlocked});
    goals_.push_back(
        {static_cast<std::uint32_t>(edges_->padded().index(goal.cell)), static_cast<std::uint32_t>(units)});
  }
  seedGoals();
}

void CostToGo::enqueue(std::size_t cell) {
  buckets_[(distance_[cell] >> shift_) & (buckets_.size() - 1)].push_back(static_cast<std::uint32_t>(cell));
  ++queued_;
}

void CostToGo::seedGoals() {
  for (const Goal goal : goals_) {
    if (distance_[goal.index] <= goal.units) continue;
    distance_[goal.index] = goal.units;
    enqueue(goal.index);
  }
}

bool CostToGo::settle(maps::Cell until, const StopCheck& stop) {
  return settleBucketsUntil(static_cast<std::uint32_t>(edges_->padded().index(until)), stop);
}

bool CostToGo::settleAll(const StopCheck& stop) {
  return settleBucketsUntil(kNoCell, stop);
}

bool CostToGo::settleBucketsUntil(std::uint32_t index, const StopCheck& stop) {
  // Cells whose distance would exceed 32 bits are left unreached.
  const std::uint64_t last_bucket = (std::uint64_t{kUnreached} - 2 * EdgeLayer::kBlocked) >> shift_;
  for (; queued_ > 0 && current_ < last_bucket; ++current_) {
    if (index != kNoCell && (distance_[index] >> shift_) < current_) return true;
    if (buckets_[current_ & (buckets_.size() - 1)].empty()) continue;
    if (stop()) return false;
    settleCurrent();
  }
  return true;
}

void CostToGo::settleCurrent() {
  auto& bucket = buckets_[current_ & (buckets_.size() - 1)];
  if (vectors_)
    settleByVector(bucket);
  else
    settleBucket<ImprovedByScalar>(bucket);
}

// The whole loop is compiled for AVX2, so that the kernel is inlined.
#if defined(__x86_64__)
__attribute__((target("avx2"), flatten))
#endif
void CostToGo::settleByVector(Bucket& bucket) {
  settleBucket<ImprovedByVector>(bucket);
}

// Settles the cells of a bucket in order. The scalar and the vector kernel process headings in the same
// order, so that their queues are identical.
template <typename Improved>
void CostToGo::settleBucket(Bucket& bucket) {
  const Surroundings around{distance_.get(), edges_->into(0),
                            static_cast<std::ptrdiff_t>(edges_->padded().stride())};
  const std::array<std::ptrdiff_t, 8> offsets = neighbourOffsets(edges_->padded());
  const std::size_t wrap = buckets_.size() - 1;
  std::uint64_t pushed = 0, settled = 0;
  for (std::size_t i = 0; i < bucket.size(); ++i) {
    if (i + kAhead < bucket.size()) around.prefetch(bucket[i + kAhead]);
    const std::size_t cell = bucket[i];
    std::uint32_t* const distance = around.distance + cell;
    const std::uint32_t here = *distance;
    if ((here >> shift_) != current_) continue;  // settled earlier at a lower cost
    ++settled;
    const std::uint16_t* into = around.into(cell);
    for (unsigned better = Improved::of(distance, into, around.stride); better != 0; better &= better - 1) {
      const auto heading = static_cast<std::size_t>(std::countr_zero(better));
      const std::uint32_t through = here + into[heading], before = distance[offsets[heading]];
      distance[offsets[heading]] = through;
      if (((through ^ before) >> shift_) == 0) continue;  // already queued in the same bucket
      buckets_[(through >> shift_) & wrap].push_back(
          static_cast<std::uint32_t>(cell + static_cast<std::size_t>(offsets[heading])));
      ++pushed;
    }
  }
  settled_ += settled;
  queued_ += pushed;
  queued_ -= bucket.size();
  bucket.clear();
}

std::optional<double> CostToGo::cost_J(maps::Cell cell) const noexcept {
  const std::uint32_t found = units(cell);
  if (found == kUnreached) return std::nullopt;
  return found * edges_->units().unit_J();
}

std::uint32_t CostToGo::atGoal(std::size_t index) const noexcept {
  std::uint32_t least = kUnreached;
  for (const Goal goal : goals_)
    if (goal.index == index) least = std::min(least, goal.units);
  return least;
}

std::vector<maps::Cell> CostToGo::path(maps::Cell from) const {
  const PaddedGrid& padded = edges_->padded();
  std::vector<maps::Cell> path;
  std::size_t at = padded.index(from);
  std::uint32_t left = distance_[at];
  if (left == kUnreached) return path;
  path.push_back(from);
  while (atGoal(at) != left) {
    const std::size_t before = at;
    for (int heading = 0; heading < 8 && at == before; ++heading) {
      const std::size_t next = before + static_cast<std::size_t>(padded.offset(heading));
      const std::uint16_t edge = edges_->into(next)[opposite(heading)];
      if (edge == EdgeLayer::kBlocked || edge > left || distance_[next] != left - edge) continue;
      at = next;
      left -= edge;
    }
    if (at == before) return {};  // not settled
    path.push_back(padded.cell(at));
  }
  return path;
}

// Returns the smallest distance of any cell with a changed step. The paths of nearer cells contain no changed
// step, neither before nor after the change, because the last cell with a changed step leaves by an unchanged
// step.
std::uint32_t CostToGo::leastTouched(CellBox changed) const noexcept {
  const PaddedGrid& padded = edges_->padded();
  const CellBox box = grown(changed, 1, padded);
  std::uint32_t least = kUnreached;
  for (int row = box.first.row; row <= box.last.row; ++row)
    for (int column = box.first.column; column <= box.last.column; ++column)
      least = std::min(least, units({column, row}));
  return least;
}

void CostToGo::repair(CellBox changed) {
  const std::uint64_t front = queued_ > 0 ? current_ << shift_ : kUnreached;
  const std::uint64_t stays = std::min<std::uint64_t>(leastTouched(changed), front);
  if (stays == kUnreached) return;
  for (Bucket& bucket : buckets_) bucket.clear();
  queued_ = settled_ = 0;
  // Cells that keep their values but have steps to reset cells are processed again.
  const std::uint64_t again = stays - std::min<std::uint64_t>(stays, EdgeLayer::kBlocked);
  current_ = again >> shift_;
  for (std::size_t cell = 0; cell < edges_->padded().size(); ++cell) {
    if (distance_[cell] >= stays) distance_[cell] = kUnreached;
    if (distance_[cell] >> shift_ < current_)
      ++settled_;
    else if (distance_[cell] != kUnreached)
      enqueue(cell);
  }
  seedGoals();
}

std::vector<GridLink> linksFrom(const MotionCost& cost, maps::Point place) {
  return links(cost, place, [place](maps::Point centre) { return Segment{place, centre}; });
}

std::vector<GridLink> linksTo(const MotionCost& cost, maps::Point place) {
  return links(cost, place, [place](maps::Point centre) { return Segment{centre, place}; });
}

std::vector<FieldGoal> fieldGoals(const MotionCost& cost, maps::Point goal, double tolerance_m) {
  std::vector<FieldGoal> goals;
  for (const GridLink& link : linksTo(cost, goal)) goals.push_back({link.cell, link.cost_J});
  const maps::Grid& grid = cost.map().grid();
  const double reach = tolerance_m / grid.resolution_m;
  const auto lowest = [reach](double origin, double at, double side) {
    return static_cast<int>(std::max(0.0, std::floor((at - origin) / side - reach - 1)));
  };
  const auto highest = [reach](double origin, double at, double side, int count) {
    return static_cast<int>(std::min(count - 1.0, std::ceil((at - origin) / side + reach + 1)));
  };
  if (!(tolerance_m > 0.0)) return goals;
  const int last_row = highest(grid.south_west.y_m, goal.y_m, grid.resolution_m, grid.height);
  const int last_column = highest(grid.south_west.x_m, goal.x_m, grid.resolution_m, grid.width);
  for (int row = lowest(grid.south_west.y_m, goal.y_m, grid.resolution_m); row <= last_row; ++row)
    for (int column = lowest(grid.south_west.x_m, goal.x_m, grid.resolution_m); column <= last_column;
         ++column) {
      const maps::Point centre = grid.centre({column, row});
      const bool near = std::hypot(centre.x_m - goal.x_m, centre.y_m - goal.y_m) <= tolerance_m;
      if (near && cost.allowed(centre)) goals.push_back({{column, row}, 0.0});
    }
  return goals;
}

}  // namespace talus::planner
