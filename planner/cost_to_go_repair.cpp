// Repair of a field after edges changed: first those cells are found, in the order of their old distance,
// that no neighbour supports any longer; then they, and the cells that gain, are settled again from what
// still stands.
#include <algorithm>
#include <utility>

#include <planner/cost_to_go.hpp>

namespace talus::planner {
namespace {

// Cells whose steps out may have changed: two around the box, clipped to the map.
std::vector<std::uint32_t> cellsAround(CellBox box, const PaddedGrid& padded) {
  std::vector<std::uint32_t> cells;
  for (int row = std::max(box.first.row - 2, 0); row <= std::min(box.last.row + 2, padded.height - 1); ++row)
    for (int column = std::max(box.first.column - 2, 0);
         column <= std::min(box.last.column + 2, padded.width - 1); ++column)
      cells.push_back(static_cast<std::uint32_t>(padded.index({column, row})));
  return cells;
}

}  // namespace

// The least that a way through a neighbour costs now; kUnreached without one.
std::uint32_t CostToGo::throughNeighbours(std::size_t index) const noexcept {
  std::uint32_t best = kUnreached;
  for (int heading = 0; heading < 8; ++heading) {
    const std::size_t next = index + static_cast<std::size_t>(edges_->padded().offset(heading));
    const std::uint16_t edge = edges_->into(next)[opposite(heading)];
    if (edge != EdgeLayer::kBlocked && distance_[next] != kUnreached)
      best = std::min(best, distance_[next] + edge);
  }
  for (std::size_t k = 0; k < goals_.size(); ++k)
    if (goals_[k] == index) best = std::min(best, at_goals_[k]);
  return best;
}

bool CostToGo::supported(std::size_t index) const noexcept {
  return throughNeighbours(index) <= distance_[index];
}

// Cells without support, with their old distances; their distance is kUnreached afterwards. A cell's support
// is nearer to the goal by at least a bucket, so it is decided before the cell's turn comes.
std::vector<CostToGo::Seed> CostToGo::cellsThatLostTheirWay(const std::vector<std::uint32_t>& suspects) {
  std::vector<Seed> waiting, lost;
  for (const std::uint32_t cell : suspects)
    if (distance_[cell] != kUnreached) waiting.push_back({distance_[cell], cell});
  std::sort(waiting.begin(), waiting.end(), fartherFirst);
  std::vector<Bucket> ring(buckets_.size());
  const std::size_t mask = ring.size() - 1;
  std::size_t queued = 0;
  for (std::uint64_t turn = waiting.empty() ? 0 : waiting.back().distance >> shift_;
       queued + waiting.size() > 0; ++turn) {
    if (queued == 0) turn = waiting.back().distance >> shift_;
    Bucket& bucket = ring[turn & mask];
    for (; !waiting.empty() && waiting.back().distance >> shift_ == turn; waiting.pop_back(), ++queued)
      bucket.push_back(waiting.back().index);
    for (const std::uint32_t cell : bucket) {
      const std::uint32_t old = distance_[cell];
      if (old == kUnreached || supported(cell)) continue;
      const std::uint16_t* into = edges_->into(cell);
      for (int heading = 0; heading < 8; ++heading) {
        const std::size_t next = cell + static_cast<std::size_t>(edges_->padded().offset(heading));
        const bool relies = into[heading] != EdgeLayer::kBlocked && distance_[next] != kUnreached &&
                            distance_[next] >= old + into[heading];
        if (!relies) continue;
        const std::uint64_t its_turn = distance_[next] >> shift_;
        if (its_turn - turn >= ring.size()) {  // farther than the ring reaches
          const Seed far{distance_[next], static_cast<std::uint32_t>(next)};
          waiting.insert(std::upper_bound(waiting.begin(), waiting.end(), far, fartherFirst), far);
          continue;
        }
        ring[its_turn & mask].push_back(static_cast<std::uint32_t>(next));
        ++queued;
      }
      distance_[cell] = kUnreached;
      lost.push_back({old, cell});
    }
    queued -= bucket.size();
    bucket.clear();
  }
  return lost;
}

// Settles from the seeds up to where the field stood before; what lies beyond joins the queue.
void CostToGo::plant(std::vector<Seed> seeds) {
  std::vector<Bucket> before(buckets_.size());
  before.swap(buckets_);
  const std::uint64_t stood = current_, queued_before = std::exchange(queued_, 0);
  std::vector<Seed> waiting = std::move(seeds_);
  seeds.insert(seeds.end(), waiting.begin(), waiting.end());
  std::sort(seeds.begin(), seeds.end(), fartherFirst);
  seeds_ = std::move(seeds);
  current_ = std::min(stood, std::uint64_t{seeds_.back().distance} >> shift_);
  settleBelow(stood);
  for (std::size_t k = 0; k < before.size(); ++k)
    buckets_[k].insert(buckets_[k].end(), before[k].begin(), before[k].end());
  queued_ += queued_before;
  current_ = stood;
}

void CostToGo::repair(CellBox changed) {
  const auto suspects = cellsAround(changed, edges_->padded());
  std::vector<Seed> seeds;
  for (const Seed lost : cellsThatLostTheirWay(suspects)) seeds.push_back(lost);
  for (const std::uint32_t cell : suspects) seeds.push_back({0, cell});
  std::vector<Seed> planted;
  for (const Seed seed : seeds) {
    const std::uint32_t found = throughNeighbours(seed.index);
    if (found >= distance_[seed.index]) continue;
    distance_[seed.index] = found;
    planted.push_back({found, seed.index});
  }
  if (!planted.empty()) plant(std::move(planted));
}

}  // namespace talus::planner
