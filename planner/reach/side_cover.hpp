#pragma once

#include <algorithm>
#include <vector>

#include <talus/planner/reach/cell_side.hpp>

namespace talus::planner {

/// Union of the ranges of one side of a cell that were reached so far, called the covered part.
class SideCover {
 public:
  /// Returns the parts of `range` that are longer than `least` [cell sides, >= 0] and not covered yet, and
  /// adds them to the covered part. Shorter parts are not added; therefore several short parts are returned
  /// once their total length exceeds `least`.
  std::vector<SideRange> added(const SideRange& range, double least) {
    std::vector<SideRange> fresh;
    double at = range.from;
    for (const SideRange& part : parts_) {
      if (part.to < at) continue;
      if (part.from >= range.to) break;
      if (part.from - at > least) fresh.push_back({at, part.from});
      at = part.to;
    }
    if (range.to - at > least) fresh.push_back({at, range.to});
    for (const SideRange& part : fresh) cover(part);
    return fresh;
  }

 private:
  void cover(SideRange range) {
    const auto touches = [](const SideRange& part, const SideRange& other) {
      return part.to >= other.from && part.from <= other.to;
    };
    const auto first =
        std::ranges::find_if(parts_, [&](const SideRange& part) { return part.to >= range.from; });
    auto end = first;
    for (; end != parts_.end() && touches(*end, range); ++end) range = range.hull(*end);
    parts_.insert(parts_.erase(first, end), range);
  }

  std::vector<SideRange> parts_;  // sorted, disjoint
};

}  // namespace talus::planner
