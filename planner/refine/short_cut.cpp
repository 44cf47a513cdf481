#include <algorithm>
#include <limits>

#include <talus/planner/refine/short_cut.hpp>

namespace talus::planner {
namespace {

constexpr std::size_t kBeginnings = 8;  // starting points of motions of one length, per that length
constexpr double kMarkPieces = 8.0;     // smallest distance of marks [pieces]

// Best choice from the beginning of a piece to the end of the route.
struct ShortCutChoice {
  double cost_J = 0.0;
  std::size_t next = 0;   // next piece
  bool straight = false;  // straight to the next piece, else along the route
};

// Pieces of a route, and the number of pieces from each to the next mark. A change elsewhere on the route
// affects neither.
struct Pieces {
  std::vector<Polyline> all{};
  std::vector<std::size_t> to_mark{};
};

Pieces piecesOf(const Polyline& route, double piece_m) {
  Pieces pieces;
  for (const Polyline& stretch : cutAtMarks(route, kMarkPieces * piece_m)) {
    auto cut = cutFromEnd(stretch, piece_m, piece_m);
    for (std::size_t k = 0; k < cut.size(); ++k) {
      pieces.to_mark.push_back(cut.size() - k);
      pieces.all.push_back(std::move(cut[k]));
    }
  }
  return pieces;
}

// Chooses at the beginning of piece i; all later choices are known.
ShortCutChoice chooseAt(const MotionCost& cost, const std::vector<Polyline>& pieces, std::size_t to_mark,
                        const std::vector<ShortCutChoice>& choices, std::size_t i) {
  const std::size_t to_end = pieces.size() - i;
  ShortCutChoice best{cost.ofLegs(pieces[i]) + choices[i + 1].cost_J, i + 1, false};
  const auto consider = [&](std::size_t count) {
    if (count > to_end || !(choices[i + count].cost_J < best.cost_J)) return;
    const double through =
        cost({pieces[i].front(), pieces[i + count - 1].back()}) + choices[i + count].cost_J;
    if (through < best.cost_J) best = {through, i + count, true};
  };
  consider(1);
  for (std::size_t count = 2; count <= to_end; count *= 2) {
    const bool begins_here = to_mark % std::max<std::size_t>(1, count / kBeginnings) == 0;
    if (!begins_here && i > 0) continue;
    consider(count);
    consider(count + count / 2);
  }
  return best;
}

}  // namespace

Polyline shortCut(const MotionCost& cost, const Polyline& route, double piece_m, const StopCheck& stop) {
  const auto [pieces, to_mark] = piecesOf(route, piece_m);
  std::vector<ShortCutChoice> choices(pieces.size() + 1);
  for (std::size_t i = pieces.size(); i-- > 0;) {
    if (stop()) return route;
    choices[i] = chooseAt(cost, pieces, to_mark[i], choices, i);
  }
  Polyline made;
  for (std::size_t i = 0; i < pieces.size(); i = choices[i].next)
    append(made,
           choices[i].straight ? Polyline{pieces[i].front(), pieces[choices[i].next - 1].back()} : pieces[i]);
  return made;
}

Polyline withoutIdleTurns(const MotionCost& cost, const Polyline& route) {
  if (route.size() < 3) return route;
  Polyline kept{route.front()};
  for (std::size_t i = 1; i + 1 < route.size(); ++i) {
    const double bent = cost({kept.back(), route[i]}) + cost({route[i], route[i + 1]});
    if (cost({kept.back(), route[i + 1]}) > bent * (1.0 + 1e-12)) kept.push_back(route[i]);
  }
  kept.push_back(route.back());
  return kept;
}

}  // namespace talus::planner
