#include <algorithm>
#include <set>
#include <string>
#include <string_view>

#include <talus/terramech/calibration/fit/effect_candidates.hpp>
#include <talus/terramech/calibration/search/rival_causes.hpp>

namespace talus::terramech {
namespace {

constexpr std::size_t kRivals = 3;

/// Key of a cause: name, column and group of the candidate.
std::string causeOf(const Candidate& c) {
  return c.parts.front().name + '|' + c.covariate() + '|' + c.parts.front().only_value;
}

/// Returns true if two effects are the same cause: the same column, and curves or forms of one family. Drifts
/// of one column are the same cause if they differ in their time course only.
bool isOneCause(const Effect& other, const Effect& own) {
  const Candidate a{{other}, "", 0}, b{{own}, "", 0};
  if (a.covariate() != b.covariate()) return false;
  const EffectForm *of_other = findEffect(other.name), *of_own = findEffect(own.name);
  if (!of_other || !of_own) return true;
  return std::string_view(of_other->family) == of_own->family &&
         (std::string_view(of_own->family) != "drift" || other.name.starts_with(own.name) ||
          own.name.starts_with(other.name));
}

/// Returns true if the candidate includes the constant sensor offset `own`: a curve or a drift of the same
/// sensor.
bool holdsOffset(const Candidate& other, const Effect& own) {
  const EffectForm* form = findEffect(own.name);
  return form && form->of_sensor && own.parameters.size() == 1 &&
         other.parts.front().channel == own.channel && (other.empirical() || other.family == "drift");
}

/// Returns true if the candidate is another cause than the effects `own`. A product represents both of its
/// columns; product candidates are therefore rivals of products only.
bool isOther(const Candidate& other, const std::vector<Effect>& own) {
  if (isProduct(other.covariate()) && !isProduct(own.front().covariate)) return false;
  return std::none_of(own.begin(), own.end(), [&](const Effect& part) {
    return isOneCause(other.parts.front(), part) || holdsOffset(other, part);
  });
}

std::vector<RivalCause> best(const TraceSearch& search, std::vector<Explanation> ranked,
                             const std::string& in_place_of) {
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const Explanation& a, const Explanation& b) { return a.gain > b.gain; });
  std::vector<RivalCause> rivals;
  std::set<std::string> seen;
  for (Explanation& e : ranked) {
    if (rivals.size() == kRivals || e.gain <= 0.0) break;
    if (!seen.insert(causeOf(e.candidate)).second) continue;
    RefinedModel model = search.modelWith(e.candidate);
    // Skips curves that are constant over their column.
    if (search.dependsOn(model, e.candidate.covariate()))
      rivals.push_back({in_place_of, e, std::move(model)});
  }
  return rivals;
}

}  // namespace

Replacements replacementsOf(const TraceSearch& search, std::size_t k) {
  Replacements in{search, {}, {}};
  in.without.leaveOut(k);
  in.promises = in.without.screen(0).promises;
  in.ranked = in.without.fitBest(in.promises);
  return in;
}

std::vector<RivalCause> rivalsOf(const Replacements& in, const std::vector<Effect>& own) {
  constexpr std::size_t kFits = 6;
  // At most one curve per column, and each named form once.
  const auto kindOf = [](const Candidate& c) { return c.empirical() ? c.covariate() : causeOf(c); };
  std::set<std::string> tried;
  std::vector<Explanation> ranked;
  for (const Explanation& e : in.ranked)
    if ((e.candidate.parts.size() == 1 || e.candidate.empirical()) && isOther(e.candidate, own) &&
        tried.insert(kindOf(e.candidate)).second)
      ranked.push_back(e);
  for (const Promise& p : in.promises) {
    if (tried.size() >= kFits || p.gain <= 0.0) break;
    if ((p.candidate.parts.size() > 1 && !p.candidate.empirical()) || !isOther(p.candidate, own)) continue;
    if (tried.insert(kindOf(p.candidate)).second) ranked.push_back(in.without.fitted(p.candidate));
  }
  return best(in.without, std::move(ranked), own.front().name);
}

std::vector<RivalCause> rivalsOf(const TraceSearch& search, const std::vector<Explanation>& ranked) {
  return best(search, ranked, "");
}

}  // namespace talus::terramech
