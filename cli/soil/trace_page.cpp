#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include <talus/cli/draw/plot.hpp>
#include <talus/cli/soil/trace_answer.hpp>
#include <talus/cli/soil/trace_report.hpp>

namespace talus::cli {
namespace {

using namespace terramech;

/// Residuals without one effect, and the contribution of that effect, row by row over its column (over the
/// row index if the effect acts on a constant or text).
Plot effectPlot(const TraceResult& r, const TracedEffect& effect, std::size_t at,
                const Eigen::MatrixXd& level, const Eigen::VectorXd& sinkage) {
  RefinedModel without = r.refined;
  without.effects.erase(without.effects.begin() + static_cast<long>(at));
  SolvedContacts solved;
  const Eigen::MatrixXd rest = predictRows(without, r.trial, solved);
  const std::string column = effect.chosen.candidate.covariate();
  const Eigen::VectorXd x = covariateValues(r.trial, column, sinkage);
  const bool by_row = !x.array().isFinite().any();
  Series left{.name = "residual without it", .x = {}, .y = {}, .mark = Series::Mark::Points};
  Series added{.name = "what it adds", .x = {}, .y = {}, .mark = Series::Mark::Points};
  const auto c = static_cast<Eigen::Index>(effect.channel);
  for (Eigen::Index row = 0; row < level.rows(); ++row) {
    const double at_x = by_row ? static_cast<double>(row + 1) : x[row];
    if (!std::isfinite(at_x) || !std::isfinite(r.trial.measured(row, c))) continue;
    left.x.push_back(at_x);
    left.y.push_back(r.trial.measured(row, c) - rest(row, c));
    added.x.push_back(at_x);
    added.y.push_back(level(row, c) - rest(row, c));
  }
  return {.title = effect.chosen.candidate.parts.front().name + ": " + name(effect.channel),
          .x = {.label = by_row ? "row, as read" : column},
          .y = {.label = std::string(name(effect.channel)) + " [-]"},
          .series = {left, added}};
}

void curves(HtmlReport& page, const TraceResult& r, const Eigen::MatrixXd& level,
            const Eigen::VectorXd& sinkage) {
  std::vector<Plot> plots;
  std::size_t at = r.base.effects.size();
  for (const TracedEffect& effect : r.effects) {
    if (at < r.refined.effects.size()) plots.push_back(effectPlot(r, effect, at, level, sinkage));
    at += effect.chosen.candidate.parts.size();
  }
  if (!plots.empty()) page.charts(plots);
}

// The fitted parameters with their standard deviations.
std::string sizes(const TracedEffect& effect) {
  std::string text;
  for (const FittedNumber& p : fittedNumbers(effect)) {
    text += fmt::format("{}{} = {:.4g} ± {:.2g}", text.empty() ? "" : "; ", p.name, p.value, p.std);
    if (p.unit != "-") text += " " + p.unit;
    if (p.at_bound) text += ", at its bound";
  }
  return text;
}

void effects(HtmlReport& page, const TableTrace& trace) {
  page.heading("Effects missing from the base model");
  if (trace.result.effects.empty()) {
    page.paragraph("No effect found: no candidate gains more than noise would.");
    return;
  }
  std::vector<std::vector<std::string>> found, forms;
  const std::vector<EffectRole> roles = rolesOf(trace.result);
  for (std::size_t k = 0; k < roles.size(); ++k) {
    const TracedEffect& e = trace.result.effects[k];
    const Effect& part = e.chosen.candidate.parts.front();
    const EffectForm* form = findEffect(part.name);
    found.push_back({part.name, covariateOf(part) + (part.only_column.empty() ? "" : " = " + part.only_value),
                     name(e.channel), sizes(e), pText(e.p_value),
                     fmt::format("{:.1f}", 0.5 * e.chosen.chi2_gain)});
    const std::string role = roleText(roles[k]);
    forms.push_back({part.name,
                     std::string(form ? form->formula : "curve fitted to the residual") +
                         (role.empty() ? "" : "; it " + role),
                     e.equal.empty() ? "" : equalText(e), separatingMeasurement(trace.result.trial, e)});
  }
  page.table({"effect", "covariate", "channel", "parameters (standard deviation)", "p (all tests)",
              "log-likelihood gain"},
             found);
  page.table({"effect", "form", "equal causes", "how to discriminate"}, forms);
}

std::vector<std::string> errorRow(const std::string& rows, Channel c, const ChannelErrors& base,
                                  const ChannelErrors& refined, const ChannelErrors& floor) {
  const auto k = static_cast<std::size_t>(c);
  return {rows, name(c), fmt::format("{:.4f}", base[k]), fmt::format("{:.4f}", refined[k]),
          fmt::format("{:.4f}", floor[k])};
}

const std::vector<std::string> kErrorColumns{"rows", "channel", "base", "refined", "noise floor"};

void errors(HtmlReport& page, const TraceResult& r) {
  std::vector<std::vector<std::string>> rows;
  for (Channel c : kAllChannels)
    if (r.trial.has(c)) rows.push_back(errorRow("of the fit", c, r.base_rmse, r.refined_rmse, r.noise_floor));
  page.table(kErrorColumns, rows);
}

void heldOut(HtmlReport& page, const TableTrace& trace) {
  if (trace.held_out.empty()) return;
  page.heading("Error of the base and the refined model on rows that are held out");
  const TraceResult& r = trace.result;
  std::vector<std::vector<std::string>> rows;
  for (const HeldOut& held : trace.held_out)
    for (Channel c : kAllChannels)
      if (r.trial.has(c))
        rows.push_back(errorRow(held.scheme, c, held.base_rmse, held.refined_rmse, r.noise_floor));
  page.paragraph("Root mean square errors. The noise floor is the error from sensor noise alone.");
  page.table(kErrorColumns, rows);
}

void tests(HtmlReport& page, const TraceResult& r) {
  page.heading("Gain of each candidate over the base model");
  page.paragraph(fmt::format(
      "The strongest of {} candidates, each to first order: log-likelihood gained on held-out rows. p: "
      "probability that the largest gain in a table of the base model's noise is at least that large.",
      r.first_promises.size()));
  std::vector<std::vector<std::string>> rows;
  for (std::size_t k = 0; k < r.first_promises.size() && k < 15; ++k) {
    const Promise& p = r.first_promises[k];
    const Effect& front = p.candidate.parts.front();
    rows.push_back({front.name, p.candidate.covariate(), name(front.channel), fmt::format("{:.1f}", p.gain),
                    pText(p.p_value)});
  }
  page.table({"candidate", "column", "channel", "gain", "p"}, rows);
}

}  // namespace

std::string tracePage(const TableTrace& trace) {
  const TraceResult& r = trace.result;
  HtmlReport page("Residuals of " + std::filesystem::path(trace.source).filename().string());
  page.paragraph("Verdict: " + verdictText(r, trace.answer) + ".");
  for (const MovedParameter& p : movedSoil(r)) page.paragraph(movedText(p) + ".");
  page.paragraph(fmt::format("{} rows used, {} rejected.", trace.rowsUsed(), trace.rejected.size()));
  if (const std::string searched = searchedText(r); !searched.empty()) page.paragraph(searched);
  if (trace.beyond_axle > 0) page.paragraph(beyondAxleText(trace) + ".");
  terramech::SolvedContacts solved;
  const Eigen::MatrixXd base = predictRows(r.base, r.trial, solved);
  const Eigen::MatrixXd level = predictRows(r.refined, r.trial, solved);
  Eigen::VectorXd sinkage(level.rows());
  for (int row = 0; row < r.trial.rows(); ++row)
    sinkage[row] = level(row, 1) * r.trial.denominator(row, Channel::Sinkage);
  errors(page, r);
  std::vector<Plot> plots;
  for (Channel c : kAllChannels)
    if (r.trial.has(c)) plots.push_back(overSlip(c, r.trial, {{"base", base}, {"refined", level}}));
  page.charts(plots);
  curves(page, r, level, sinkage);
  effects(page, trace);
  heldOut(page, trace);
  tests(page, r);
  return page.html();
}

}  // namespace talus::cli
