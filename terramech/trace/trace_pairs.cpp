#include <algorithm>
#include <set>

#include <talus/terramech/trace/spline_basis.hpp>
#include <talus/terramech/trace/trace_search.hpp>

namespace talus::terramech {

namespace {

constexpr int kFirsts = 6, kSeconds = 4, kPairs = 6;

/// Share of what is to be replaced that a pair must promise to first order.
constexpr double kHopeful = 0.6;

std::string nameOf(const Effect& e) {
  return e.name + "|" + e.covariate + "|" + e.only_value;
}

}  // namespace

void TraceSearch::setModel(const RefinedModel& model) {
  model_ = model;
  level_ = predictRows(model_, trial_, solved_);
  residual_ = trial_.measured - level_;
  white_ = whitening_.apply(residual_);
}

void TraceSearch::addPairs(const Explanation& first, const std::vector<Screened>& screened,
                           std::vector<Screened>& pairs) const {
  TraceSearch beside = *this;
  RefinedModel grown = model_;
  grown.effects.push_back(first.candidate.parts.front());
  beside.setModel(grown);
  const Eigen::MatrixXd known = orthonormal(beside.derivativeOf(grown, beside.solved_));
  const std::size_t begin = pairs.size();
  for (const Screened& s : screened) {
    const Effect &a = first.candidate.parts.front(), &b = s.candidate.parts.front();
    if (s.candidate.empirical() || s.candidate.parts.size() > 1 || nameOf(a) == nameOf(b)) continue;
    const Eigen::MatrixXd own = orthonormal(s.direction - known * (known.transpose() * s.direction));
    const double gain = first.chi2_gain + (own.transpose() * beside.white_).squaredNorm();
    pairs.push_back({{{a, b}, "pair", first.candidate.parameters + s.candidate.parameters}, {}, 0.0});
    pairs.back().score = 0.5 * gain - penalty(pairs.back().candidate);
  }
  const auto from = pairs.begin() + static_cast<long>(begin);
  std::stable_sort(from, pairs.end(), [](const Screened& a, const Screened& b) { return a.score > b.score; });
  std::set<std::string> seen;
  pairs.erase(std::remove_if(from, pairs.end(),
                             [&](const Screened& s) {
                               return static_cast<int>(seen.size()) >= kSeconds ||
                                      !seen.insert(nameOf(s.candidate.parts.back())).second;
                             }),
              pairs.end());
}

std::vector<Explanation> TraceSearch::firsts(const std::vector<Screened>& screened) const {
  std::vector<Explanation> all;
  std::set<std::string> families;
  for (const Screened& s : screened) {
    if (static_cast<int>(all.size()) == kFirsts) break;
    if (s.candidate.empirical() || s.candidate.parts.size() > 1 || s.score < -2.0) continue;
    if (!families.insert(s.candidate.family).second) continue;
    RefinedModel grown = model_;
    grown.effects.push_back(s.candidate.parts.front());
    SolvedContacts solved = solved_;
    FitPlan plan = planFor(grown);
    plan.iterations = 10;
    const Fit fit = fitModel(grown, trial_, whitening_, plan, solved);
    Explanation e;
    e.candidate = s.candidate;
    e.candidate.parts = {fit.model.effects.back()};
    e.chi2_gain = chi2() - fit.cost();
    all.push_back(std::move(e));
  }
  return all;
}

std::vector<Explanation> TraceSearch::pairs(double gain, Held& held) {
  const std::vector<Screened> screened = screen();
  std::vector<Screened> all;
  for (const Explanation& first : firsts(screened)) addPairs(first, screened, all);
  std::stable_sort(all.begin(), all.end(),
                   [](const Screened& a, const Screened& b) { return a.score > b.score; });
  std::vector<Explanation> ranked;
  std::set<std::set<std::string>> tried;
  for (const Screened& s : all) {
    if (static_cast<int>(ranked.size()) == kPairs || s.score < 0.5 * kHopeful * gain) break;
    if (tried.insert({nameOf(s.candidate.parts.front()), nameOf(s.candidate.parts.back())}).second)
      ranked.push_back(fitted(s.candidate, held));
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const Explanation& a, const Explanation& b) { return a.score > b.score; });
  return ranked;
}

std::vector<Explanation> TraceSearch::pairsInPlaceOf(std::vector<std::size_t> members, Explanation& present) {
  TraceSearch without = *this;
  Candidate all;
  std::sort(members.rbegin(), members.rend());
  for (std::size_t k : members) {
    const std::size_t first = firstPart(k);
    for (std::size_t part = first; part < first + part_count_[k]; ++part) {
      all.parts.push_back(model_.effects[part]);
      all.parameters += static_cast<int>(parametersOf(model_, static_cast<int>(part)).size());
    }
    without.leaveOut(k);
  }
  // A curve in front makes the whole empirical: no bonus for a known form.
  std::stable_partition(all.parts.begin(), all.parts.end(), [](const Effect& e) { return e.empirical(); });
  Held rows = without.held();
  present = without.fitted(all, rows);
  return without.pairs(present.chi2_gain, rows);
}

void TraceSearch::replaceByPair(std::vector<std::size_t> members, const Candidate& pair) {
  std::sort(members.rbegin(), members.rend());
  for (std::size_t k : members) leaveOut(k);
  accept(pair);
  part_count_.back() = 1;
  part_count_.push_back(1);
}

}  // namespace talus::terramech
