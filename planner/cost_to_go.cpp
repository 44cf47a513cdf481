#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include <planner/cost_to_go.hpp>

namespace talus::planner {
namespace {

constexpr std::uint32_t kNoCell = std::numeric_limits<std::uint32_t>::max();

}  // namespace

CostToGo::CostToGo(std::shared_ptr<const EdgeLayer> edges, const std::vector<FieldGoal>& goals)
    : edges_(std::move(edges)), distance_(edges_->padded().size(), kUnreached) {
  // A bucket no wider than the cheapest edge: its cells cannot improve each other, so they are final when its
  // turn comes and need no order among themselves (Denardo & Fox 1979 [denardo_fox_1979]).
  shift_ = static_cast<unsigned>(std::bit_width(edges_->units().cheapestEdge()) - 1);
  const std::size_t ring = std::bit_ceil((std::size_t{EdgeLayer::kBlocked} >> shift_) + 2);
  buckets_.resize(ring);
  for (const FieldGoal& goal : goals) {
    const auto index = static_cast<std::uint32_t>(edges_->padded().index(goal.cell));
    const double units =
        std::min(std::round(goal.cost_J / edges_->units().unit_J()), double{EdgeLayer::kBlocked});
    goals_.push_back(index);
    at_goals_.push_back(static_cast<std::uint32_t>(units));
    if (distance_[index] <= at_goals_.back()) continue;
    distance_[index] = at_goals_.back();
    buckets_[distance_[index] >> shift_].push_back(index);
    ++queued_;
  }
}

bool CostToGo::settle(maps::Cell until, const StopCheck& stop) {
  return settleBucketsUntil(static_cast<std::uint32_t>(edges_->padded().index(until)), stop);
}

bool CostToGo::settleAll(const StopCheck& stop) {
  return settleBucketsUntil(kNoCell, stop);
}

bool CostToGo::settleBucketsUntil(std::uint32_t index, const StopCheck& stop) {
  const auto done = [&] {
    return queued_ == 0 || (index != kNoCell && (distance_[index] >> shift_) < current_);
  };
  for (; !done(); ++current_) {
    auto& bucket = buckets_[current_ & (buckets_.size() - 1)];
    if (bucket.empty()) continue;
    if (stop()) return false;
    settleBucket(bucket);
  }
  return true;
}

void CostToGo::settleBucket(std::vector<std::uint32_t>& bucket) {
  const PaddedGrid& padded = edges_->padded();
  for (std::size_t i = 0; i < bucket.size(); ++i) {
    const std::size_t cell = bucket[i];
    if ((distance_[cell] >> shift_) != current_) continue;  // it was reached cheaper, and settled then
    ++settled_;
    const std::uint16_t* into = edges_->into(cell);
    for (int heading = 0; heading < 8; ++heading) {
      if (into[heading] == EdgeLayer::kBlocked) continue;
      const std::size_t neighbour = cell + static_cast<std::size_t>(padded.offset(heading));
      const std::uint32_t through = distance_[cell] + into[heading];
      if (through >= distance_[neighbour]) continue;
      distance_[neighbour] = through;
      buckets_[(through >> shift_) & (buckets_.size() - 1)].push_back(static_cast<std::uint32_t>(neighbour));
      ++queued_;
    }
  }
  queued_ -= bucket.size();
  bucket.clear();
}

std::optional<double> CostToGo::cost_J(maps::Cell cell) const noexcept {
  const std::uint32_t found = units(cell);
  if (found == kUnreached) return std::nullopt;
  return found * edges_->units().unit_J();
}

bool CostToGo::endsAt(std::size_t index) const noexcept {
  for (std::size_t k = 0; k < goals_.size(); ++k)
    if (goals_[k] == index && at_goals_[k] == distance_[index]) return true;
  return false;
}

std::vector<maps::Cell> CostToGo::path(maps::Cell from) const {
  const PaddedGrid& padded = edges_->padded();
  std::vector<maps::Cell> path;
  if (units(from) == kUnreached) return path;
  std::size_t at = padded.index(from);
  path.push_back(from);
  while (!endsAt(at)) {
    const std::size_t before = at;
    for (int heading = 0; heading < 8 && at == before; ++heading) {
      const std::size_t next = at + static_cast<std::size_t>(padded.offset(heading));
      const std::uint16_t edge = edges_->into(next)[opposite(heading)];
      if (edge != EdgeLayer::kBlocked && distance_[next] != kUnreached &&
          distance_[next] + edge == distance_[at])
        at = next;
    }
    if (at == before) return {};  // not settled
    path.push_back(padded.cell(at));
  }
  return path;
}

}  // namespace talus::planner
