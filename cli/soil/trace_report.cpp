#include <algorithm>
#include <cmath>
#include <filesystem>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <talus/cli/app/context.hpp>
#include <talus/cli/soil/trace_report.hpp>
#include <talus/terramech/calibration.hpp>
#include <talus/terramech/io/csv_reader.hpp>

namespace talus::cli {

using namespace terramech;

namespace {

bool same(const Candidate& a, const Candidate& b) {
  const Effect &x = a.parts.front(), &y = b.parts.front();
  return x.name == y.name && a.covariate() == b.covariate() && x.only_value == y.only_value;
}

/// Returns true if the model's predictions for the trial's rows equal `a` within 1e-5.
bool agree(const Eigen::MatrixXd& a, const RefinedModel& model, const Trial& trial) {
  SolvedContacts solved;
  const Eigen::MatrixXd difference = a - predictRows(model, trial, solved);
  return difference.array().isNaN().select(0.0, difference).cwiseAbs().maxCoeff() <= 1e-5;
}

struct Term {
  const char* name;
  double Soil::*field;
};

/// Terms of the base model that an effect of the library may replace.
constexpr Term kTerms[] = {{"slip_sinkage_exponent", &Soil::slip_sinkage_exponent},
                           {"digging_exponent", &Soil::digging_exponent},
                           {"side_bulldozing", &Soil::side_bulldozing}};

EffectRole roleOf(const RefinedModel& refined, std::size_t effect, const Trial& trial) {
  SolvedContacts solved;
  const Eigen::MatrixXd with = predictRows(refined, trial, solved);
  RefinedModel without = refined;
  without.effects.erase(without.effects.begin() + static_cast<long>(effect));
  if (agree(with, without, trial)) return {.adds = false};
  for (const Term& term : kTerms) {
    RefinedModel less = without;
    less.soil.*term.field = 0.0;
    if (agree(with, less, trial)) return {.adds = false, .takes_back = {term.name}};
  }
  return {};
}

std::string strainedText(const StrainedSensor& s) {
  return fmt::format("{} would have to err {:.1f} times as declared ({:.3g} in place of {:.3g})", s.column,
                     s.fitted / s.declared, s.fitted, s.declared);
}

/// Returns the name and the column of a cause.
std::string causeText(const Explanation& e) {
  return fmt::format("{} ({})", e.candidate.parts.front().name, e.candidate.covariate());
}

/// Returns the causes of an effect if there are several that are equal.
std::string equalCauses(const TracedEffect& e) {
  return e.equal.empty() ? ""
                         : fmt::format("; {} causes are equal: {}, {}", e.equal.size() + 1,
                                       causeText(e.chosen), listText(e.equal, causeText));
}

}  // namespace

std::string refusal(const TraceResult& result, const Explanation& rejected) {
  if (rejected.gain <= result.threshold) return "gains no more than noise would";
  if (!result.effects.empty()) return "explains less than the selected effect";
  if (!result.trial.moment.empty())
    return "gains more than noise would, but carries less than an effect of a drive must";
  return "gains more than noise would, but not beside the others";
}

std::string refusal(const TraceResult& result) {
  if (result.last_promises.empty() || result.last_promises.front().gain <= 0.0) return "";
  const Promise& promise = result.last_promises.front();
  if (promise.gain <= result.threshold)
    return fmt::format("gain {:.1f}, below the {:.1f} that would be evidence", promise.gain,
                       result.threshold);
  const std::string first = fmt::format("gain {:.1f} to first order", promise.gain);
  const auto is_it = [&](const auto& e) { return same(e.candidate, promise.candidate); };
  const auto fitted = std::find_if(result.rejected.begin(), result.rejected.end(), is_it);
  if (fitted == result.rejected.end()) {
    const bool found = std::any_of(result.effects.begin(), result.effects.end(),
                                   [&](const TracedEffect& e) { return is_it(e.chosen); });
    return first + (found ? ", of which an effect was accepted; no further one was searched"
                          : "; accepted first, and left out as it gained too little beside the others");
  }
  if (fitted->gain <= result.threshold)
    return fmt::format("{}, {:.1f} when fitted, below the {:.1f} that would be evidence", first, fitted->gain,
                       result.threshold);
  return fmt::format("{}, {:.1f} when fitted: {}", first, fitted->gain, refusal(result, *fitted));
}

std::string verdictText(const TraceResult& result, const Answer& a) {
  const std::string rest = fmt::format("rms of {} on held-out rows {:.4f}, of the sensors alone {:.4f}",
                                       name(a.channel), a.rest, a.floor);
  if (a.verdict == Verdict::NothingMissing)
    return "nothing missing: the residuals are consistent with noise; " + rest;
  const std::string found =
      result.effects.empty()
          ? ""
          : fmt::format(
                "explained by {} effect{}, {}: {} on held-out rows from {:.2f} to {:.2f} noise floors{}",
                result.effects.size(), result.effects.size() == 1 ? "" : "s",
                listText(
                    result.effects,
                    [](const TracedEffect& e) { return causeText(e.chosen) + " in " + name(e.channel); }),
                name(a.channel), a.base / a.floor, a.rest / a.floor,
                listText(result.effects, equalCauses, ""));
  if (a.verdict == Verdict::Explained) return found;
  if (!a.inapplicable.empty())
    return "unexplained: the model does not apply: " + a.inapplicable + "; " + rest;
  const std::string start = found.empty() ? "unexplained: " + rest : "partly " + found;
  if (!a.strained.empty()) return start + "; " + listText(a.strained, strainedText, "; ");
  if (!a.at_bound.empty())
    return fmt::format("{}; at a bound of its range: {}", start, fmt::join(a.at_bound, ", "));
  if (a.strength_scatter + a.stiffness_scatter > 0.0)
    return fmt::format(
        "{}; the soil's strength scatters by {:.0f} % and its stiffness by {:.0f} % from {} to {}; {} would "
        "decide",
        start, 100.0 * a.strength_scatter, 100.0 * a.stiffness_scatter, a.unit, a.unit, a.measure);
  const std::string where = a.column.empty()
                                ? "it follows no column"
                                : fmt::format("it varies most with {} ({})", a.column, refusal(result));
  return fmt::format("{}; {}; {} would decide", start, where, a.measure);
}

std::vector<EffectRole> rolesOf(const TraceResult& result) {
  std::vector<EffectRole> roles;
  std::size_t at = result.base.effects.size();
  for (const TracedEffect& effect : result.effects) {
    const auto parts = effect.chosen.candidate.parts.size();
    const bool one = parts == 1 && at < result.refined.effects.size() &&
                     result.refined.effects[at].name == effect.chosen.candidate.parts.front().name;
    roles.push_back(one ? roleOf(result.refined, at, result.trial) : EffectRole{});
    at += parts;
  }
  return roles;
}

std::string roleText(const EffectRole& role) {
  if (role.adds) return "";
  if (role.takes_back.empty()) return "adds nothing, the refined model predicts the same without it";
  return fmt::format("takes back the base's {} and adds nothing in its place",
                     fmt::join(role.takes_back, ", "));
}

nlohmann::ordered_json errorsJson(const terramech::ChannelErrors& errors) {
  nlohmann::ordered_json out = nlohmann::ordered_json::object();
  for (terramech::Channel c : terramech::kAllChannels)
    if (const double e = errors[static_cast<std::size_t>(c)]; std::isfinite(e)) out[name(c)] = e;
  return out;
}

std::string changeText(const terramech::ChannelErrors& base, const terramech::ChannelErrors& refined) {
  std::string text;
  for (terramech::Channel c : terramech::kAllChannels)
    if (const auto k = static_cast<std::size_t>(c); std::isfinite(base[k]))
      text += fmt::format(" {} {:.4f} -> {:.4f}", name(c), base[k], refined[k]);
  return text;
}

Plot overSlip(terramech::Channel channel, const terramech::Trial& trial,
              const std::vector<NamedPredictions>& predictions) {
  Plot plot{.title = std::string(name(channel)) + " over slip",
            .x = {.label = "slip [-]"},
            .y = {.label = std::string(name(channel)) + " [-]"},
            .series = {}};
  const auto c = static_cast<Eigen::Index>(channel);
  const auto add = [&](const std::string& who, const Eigen::MatrixXd& values) {
    Series series{.name = who, .x = {}, .y = {}, .mark = Series::Mark::Points};
    for (Eigen::Index row = 0; row < values.rows(); ++row) {
      const double slip = trial.slip[static_cast<std::size_t>(row)];
      if (!std::isfinite(slip + trial.measured(row, c) + values(row, c))) continue;
      series.x.push_back(slip);
      series.y.push_back(values(row, c));
    }
    plot.series.push_back(std::move(series));
  };
  add("measured", trial.measured);
  for (const auto& [who, predicted] : predictions) add(who, predicted);
  return plot;
}

namespace {

nlohmann::ordered_json searchedJson(const terramech::TraceResult& r) {
  return {{"rows", r.trial.rows()},
          {"rows_not_searched", r.unsearched.rows},
          {"base_rmse_there", errorsJson(r.unsearched.base_rmse)},
          {"refined_rmse_there", errorsJson(r.unsearched.refined_rmse)},
          {"columns_dropped", r.trial.dropped}};
}

void addSearched(Report& report, const terramech::TraceResult& result) {
  if (const terramech::UnsearchedRows& rest = result.unsearched; rest.rows > 0) {
    report.paragraph(fmt::format(
        "searched a sample of {} of {} rows; rmse on the {} others (base -> refined):{}", result.trial.rows(),
        result.trial.rows() + rest.rows, rest.rows, changeText(rest.base_rmse, rest.refined_rmse)));
  }
  if (const auto& dropped = result.trial.dropped; !dropped.empty()) {
    constexpr std::size_t kShown = 5;
    report.paragraph(fmt::format(
        "{} further columns not searched, those least related to the residuals: {}{}", dropped.size(),
        fmt::join(dropped.begin(), dropped.begin() + static_cast<long>(std::min(kShown, dropped.size())),
                  ", "),
        dropped.size() > kShown ? ", ... (--json lists them)" : ""));
  }
}

/// Named errors by channel as a table, whose first column is `what`; channels without a first error are omitted.
Table errorTable(const std::string& what,
                 const std::vector<std::pair<std::string, const ChannelErrors&>>& errors) {
  Table table{{what}};
  for (const auto& [title, of] : errors) table.front().push_back(title);
  for (Channel c : kAllChannels) {
    const auto k = static_cast<std::size_t>(c);
    if (!std::isfinite(errors.front().second[k])) continue;
    table.push_back({name(c)});
    for (const auto& [title, of] : errors) table.back().push_back(fmt::format("{:.4f}", of[k]));
  }
  return table;
}

/// Channels in which the refined model has larger errors than the base.
nlohmann::ordered_json worse(const LeftOutErrors& part) {
  auto out = nlohmann::ordered_json::array();
  for (Channel c : kAllChannels)
    if (const auto k = static_cast<std::size_t>(c); part.refined[k] > part.base[k]) out.push_back(name(c));
  return out;
}

}  // namespace

std::string leftOutText(const std::vector<LeftOutErrors>& all) {
  Report report("");
  for (const LeftOutErrors& part : all) {
    report.paragraph(
        fmt::format("traced without {} ({} rows): {}", part.what, part.rows,
                    part.effects.empty() ? "no effect" : fmt::format("{}", fmt::join(part.effects, ", "))));
    report.table(errorTable("rmse", {{"base", part.base},
                                     {"refined", part.refined},
                                     {"noise floor", part.floor},
                                     {"regression", part.regression}}));
    for (const std::string channel : worse(part)) report.paragraph(channel + ": refined is worse than base");
  }
  return report.text();
}

nlohmann::ordered_json leftOutJson(const std::vector<LeftOutErrors>& all) {
  return jsonList(all, [](const LeftOutErrors& part) -> nlohmann::ordered_json {
    return {{"left_out", part.what},
            {"rows", part.rows},
            {"effects", part.effects},
            {"base_rmse", errorsJson(part.base)},
            {"refined_rmse", errorsJson(part.refined)},
            {"worse_than_base", worse(part)},
            {"noise_floor", errorsJson(part.floor)},
            {"regression_rmse", errorsJson(part.regression)}};
  });
}

namespace {

using nlohmann::ordered_json;

std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.9g}", value) : "";
}

}  // namespace

std::string proposalTable(const std::vector<ProposedRun>& runs, const TraceResult& result) {
  if (runs.empty()) return "";
  Table table(1);
  std::vector<std::pair<std::string, std::string>> row;  // column, value
  const auto eachChannel = [&](auto add) {
    for (const Channel c : kAllChannels)
      if (result.trial.has(c)) add(static_cast<std::size_t>(c), kAnswers[static_cast<std::size_t>(c)]);
  };
  for (std::size_t k = 0; k < runs.size(); ++k)
    for (std::size_t at = 0; at < runs[k].slip.size(); ++at) {
      row = {{"run", fmt::format("proposed {}", k + 1)}, {"slip", number(runs[k].slip[at])}};
      for (const auto& [column, value] : runs[k].columns) row.emplace_back(column, number(value));
      row.insert(row.end(), runs[k].groups.begin(), runs[k].groups.end());
      eachChannel([&](std::size_t, const char* answer) { row.emplace_back(answer, ""); });
      for (std::size_t i = 0; const RunPrediction& p : runs[k].row_predictions[at]) {
        const std::string cause = fmt::format("predicted_{}_", ++i);
        row.emplace_back(cause + "cause", p.cause);
        eachChannel([&](std::size_t c, const char* answer) {
          row.emplace_back(cause + answer, number(p.mean[c]));
          row.emplace_back(cause + answer + "_std", number(p.std[c]));
        });
      }
      const bool first = table.front().empty();
      table.emplace_back();
      for (const auto& [column, value] : row) {
        if (first) table.front().push_back(column);
        table.back().push_back(value);
      }
    }
  return csvText(table);
}

ordered_json proposalsJson(const std::vector<ProposedRun>& runs) {
  ordered_json all = ordered_json::array();
  for (const ProposedRun& run : runs) {
    ordered_json columns{{"slip", run.slip}};
    for (const auto& [column, value] : run.columns) columns[column] = value;
    for (const auto& [column, text] : run.groups) columns[column] = text;
    ordered_json predictions = ordered_json::array();
    for (const RunPrediction& p : run.predictions) {
      ordered_json one{{"cause", p.cause}};
      for (std::size_t c = 0; c < kChannels; ++c) {
        if (!std::isfinite(p.mean[c])) continue;
        one[kAnswers[c]] = p.mean[c];
        one[c == 0 ? "std" : std::string(kAnswers[c]) + "_std"] = p.std[c];
      }
      predictions.push_back(one);
    }
    all.push_back({{"columns", columns}, {"predictions", predictions}});
  }
  return all;
}

ordered_json scoresJson(const std::vector<CauseScore>& scores) {
  return jsonList(scores, [](const CauseScore& s) -> ordered_json {
    return {{"cause", s.cause}, {"log_likelihood", s.log_likelihood}, {"probability", s.probability}};
  });
}

std::string proposalText(const std::vector<ProposedRun>& runs, const Trial& trial) {
  if (runs.empty()) return "no run is proposed: no second cause gains anything\n";
  std::string text;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    text += fmt::format("proposed run {}: slip {:.3g} to {:.3g}", k + 1, runs[k].slip.front(),
                        runs[k].slip.back());
    for (const auto& [column, value] : runs[k].columns)
      if (std::find(trial.covariates.begin(), trial.covariates.end(), column) != trial.covariates.end())
        text += fmt::format(", {} {:.4g}", column, value);
    for (const auto& [column, word] : runs[k].groups) text += fmt::format(", {} {}", column, word);
    text += '\n';
    for (const RunPrediction& p : runs[k].predictions) {
      text += "  " + p.cause + ':';
      for (std::size_t c = 0; c < kChannels; ++c)
        if (std::isfinite(p.mean[c]))
          text += fmt::format(" {} {:.4g} +- {:.2g}", kAnswers[c], p.mean[c], p.std[c]);
      text += '\n';
    }
  }
  return text;
}

std::string causeScoreText(const std::vector<CauseScore>& scores) {
  std::string text;
  for (const CauseScore& s : scores)
    text += fmt::format("{}: log-likelihood {:.1f} of the measured runs, probability {:.3g}\n", s.cause,
                        s.log_likelihood, s.probability);
  return text;
}

namespace {

/// Parameters of an effect by name; curves as knots and values per channel.
ordered_json parametersJson(const Candidate& candidate) {
  ordered_json out = ordered_json::object();
  for (const Effect& part : candidate.parts) {
    if (part.empirical()) {
      out[name(part.channel)] = {{"knots", part.knots}, {"values", part.parameters}};
      continue;
    }
    const EffectForm* form = findEffect(part.name);
    for (std::size_t k = 0; k < part.parameters.size(); ++k)
      out[form->parameters[k].name] = part.parameters[k];
  }
  return out;
}

ordered_json stdJson(const TracedEffect& effect) {
  if (effect.chosen.candidate.parts.front().empirical()) return effect.parameter_std;
  ordered_json out = ordered_json::object();
  for (const FittedNumber& p : fittedNumbers(effect)) out[p.name] = p.std;
  return out;
}

ordered_json rivalJson(const Explanation& e) {
  const Effect& part = e.candidate.parts.front();
  ordered_json out{{"name", part.name}, {"covariate", covariateOf(part)}};
  if (!part.only_column.empty()) out["only"] = {{part.only_column, part.only_value}};
  out["log_likelihood_gain"] = 0.5 * e.chi2_gain;
  out["gain"] = e.gain;
  return out;
}

ordered_json evidenceJson(const TableTrace& trace, const TracedEffect& effect) {
  return {{"log_likelihood_gain", 0.5 * effect.chosen.chi2_gain},
          {"gain", effect.chosen.gain},
          {"alternatives", jsonList(effect.equal, rivalJson)},
          {"confounded_with", confounded(trace.result.trial, effect.chosen.candidate.covariate())},
          {"to_tell_apart", separatingMeasurement(trace.result.trial, effect)}};
}

ordered_json effectJson(const TableTrace& trace, const TracedEffect& effect, const EffectRole& role) {
  const Effect& part = effect.chosen.candidate.parts.front();
  ordered_json out{{"name", part.name},
                   {"family", effect.chosen.candidate.family},
                   {"covariate", covariateOf(part)},
                   {"channel", name(effect.channel)}};
  if (!part.only_column.empty()) out["only"] = {{part.only_column, part.only_value}};
  out["parameters"] = parametersJson(effect.chosen.candidate);
  out["parameters_std"] = stdJson(effect);
  out["at_bound"] = atBounds(part);
  out["adds"] = role.adds;
  out["takes_back"] = role.takes_back;
  out["p_value"] = effect.p_value;
  out["equal_to"] = jsonList(effect.equal, [](const Explanation& e) -> ordered_json {
    return {{"name", e.candidate.parts.front().name}, {"covariate", e.candidate.covariate()}};
  });
  out["evidence"] = evidenceJson(trace, effect);
  if (const EffectForm* form = findEffect(part.name)) {
    out["formula"] = form->formula;
    out["source"] = form->source;
    out["signature"] = form->signature;
  } else {
    out["formula"] = "natural cubic spline through (knots, values), fitted; no physical cause is claimed";
  }
  return out;
}

ordered_json rejectedJson(const TraceResult& result) {
  return jsonList(result.rejected, [&](const Explanation& e) {
    ordered_json one = rivalJson(e);
    one["reason"] = refusal(result, e);
    return one;
  });
}

/// Correlation over the rows in which both columns are known; 0 for a constant column.
double correlation(const Eigen::VectorXd& x, const Eigen::VectorXd& y) {
  const Eigen::Array<bool, Eigen::Dynamic, 1> known = (x + y).array().isFinite();
  const auto centred = [&](const Eigen::VectorXd& v) -> Eigen::VectorXd {
    const double mean = known.select(v.array(), 0.0).sum() / static_cast<double>(known.count());
    return known.select(v.array() - mean, 0.0);
  };
  const Eigen::VectorXd a = centred(x), b = centred(y);
  const double norms = a.norm() * b.norm();
  return norms > 0.0 ? a.dot(b) / norms : 0.0;
}

std::string effectLine(const Trial& trial, const TracedEffect& effect, const EffectRole& role) {
  const Effect& part = effect.chosen.candidate.parts.front();
  std::string line =
      fmt::format("{} in {} (covariate {}{})", part.name, name(effect.channel), covariateOf(part),
                  part.only_column.empty() ? "" : ", only for the value " + part.only_value);
  if (!role.adds) line += ": " + roleText(role);
  if (const EffectForm* form = findEffect(part.name)) {
    line += fmt::format("\n    {}   [{}]", form->formula, form->source);
    for (const FittedNumber& p : fittedNumbers(effect))
      line += fmt::format("\n    {} = {:.4g} +- {:.2g} [{}]{}", p.name, p.value, p.std, p.unit,
                          p.at_bound ? ", at its bound" : "");
  } else {
    line += "\n    curve fitted to the residual; it matches no known effect";
  }
  line += fmt::format("\n    p {}, log-likelihood gain {:.1f}", pText(effect.p_value),
                      0.5 * effect.chosen.chi2_gain);
  if (!effect.equal.empty())
    line += fmt::format("\n    these rows cannot separate it from {}: {}",
                        listText(effect.equal, causeText, " or "), separatingMeasurement(trial, effect));
  return line;
}

}  // namespace

std::vector<FittedNumber> fittedNumbers(const TracedEffect& effect) {
  const Effect& part = effect.chosen.candidate.parts.front();
  const EffectForm* form = findEffect(part.name);
  const std::vector<std::string> bounds = atBounds(part);
  std::vector<FittedNumber> numbers;
  for (std::size_t k = 0; form && k < form->parameters.size(); ++k) {
    const EffectParameter& p = form->parameters[k];
    if (!p.fitted) continue;
    numbers.push_back({.name = p.name,
                       .unit = p.unit,
                       .value = part.parameters[k],
                       .std = effect.parameter_std.at(numbers.size()),
                       .at_bound = std::find(bounds.begin(), bounds.end(), p.name) != bounds.end()});
  }
  return numbers;
}

std::string pText(double p) {
  const double least = 1.0 / (TraceOptions{}.draws + 1.0);
  if (p <= least * (1.0 + 1e-9)) return fmt::format("< {:.2g}", std::max(0.001, 1.01 * least));
  return fmt::format("= {:.2g}", p);
}

const std::string& covariateOf(const Effect& effect) {
  return effect.only_column.empty() ? effect.covariate : effect.only_column;
}

std::vector<std::string> confounded(const Trial& trial, const std::string& covariate) {
  std::vector<std::string> close;
  const Eigen::VectorXd x = covariateValues(trial, covariate, Eigen::VectorXd::Zero(trial.rows()));
  for (const std::string& other : trial.covariates)
    if (other != covariate &&
        std::abs(correlation(x, covariateValues(trial, other, Eigen::VectorXd::Zero(trial.rows())))) > 0.9)
      close.push_back(other);
  return close;
}

std::string separatingMeasurement(const Trial& trial, const TracedEffect& effect) {
  const std::string& own = effect.chosen.candidate.covariate();
  for (const Explanation& rival : effect.equal)
    if (rival.candidate.covariate() != own)
      return "measure rows in which " + own + " and " + rival.candidate.covariate() +
             " vary independently, to discriminate " + effect.chosen.candidate.parts.front().name + " from " +
             rival.candidate.parts.front().name;
  const auto close = confounded(trial, own);
  if (!close.empty())
    return own + " is correlated with " + close.front() +
           " in these rows; vary one and keep the other constant";
  if (!effect.equal.empty())
    return "measure rows over a wider range of " + own + ", to discriminate " +
           effect.chosen.candidate.parts.front().name + " from " +
           effect.equal.front().candidate.parts.front().name;
  return "no close alternative";
}

namespace {

ordered_json schemeJson(const HeldOut& held) {
  return {{"scheme", held.scheme},
          {"base_rmse", errorsJson(held.base_rmse)},
          {"refined_rmse", errorsJson(held.refined_rmse)}};
}

ordered_json heldOutJson(const TableTrace& trace) {
  ordered_json out = schemeJson(trace.held_out.front());
  out["noise_floor"] = errorsJson(trace.result.noise_floor);
  out["others"] = jsonList(std::span(trace.held_out).subspan(1), schemeJson);
  out["end_levels"] = jsonList(trace.result.ends, [](const EndLevel& end) -> ordered_json {
    return {{"column", end.column},
            {"end", end.high ? "high" : "low"},
            {"rows", end.rows},
            {"distance", end.distance},
            {"base_rmse", errorsJson(end.base_rmse)},
            {"refined_rmse", errorsJson(end.refined_rmse)}};
  });
  return out;
}

/// Errors of base and refined model beside the noise floor.
Table heldOutTable(const std::string& what, const HeldOut& held, const TraceResult& result) {
  return errorTable(
      what, {{"base", held.base_rmse}, {"refined", held.refined_rmse}, {"noise floor", result.noise_floor}});
}

/// Errors at the end levels, predicted from the other levels.
void addEnds(Report& report, const TraceResult& r) {
  if (!r.ends.empty()) report.paragraph("held out: end levels, predicted from the others (base -> refined)");
  for (const EndLevel& end : r.ends)
    report.paragraph(fmt::format("  {:26s} {:3d} rows:{}", (end.high ? "greatest " : "least ") + end.column,
                                 end.rows, changeText(end.base_rmse, end.refined_rmse)));
}

ordered_json answerJson(const TraceResult& result, const Answer& a) {
  const auto moved = jsonList(movedSoil(result), [](const MovedParameter& p) -> ordered_json {
    return {{"name", p.name},
            {"value", p.value},
            {"prior", p.prior},
            {"prior_std", p.prior_std},
            {"standard_deviations", p.away()}};
  });
  const auto strained = jsonList(a.strained, [](const StrainedSensor& s) -> ordered_json {
    return {{"column", s.column}, {"declared", s.declared}, {"fitted", s.fitted}};
  });
  return {{"channel", name(a.channel)},
          {"base_rmse", a.base},
          {"rmse", a.rest},
          {"noise_floor", a.floor},
          {"varies_with", a.column},
          {"gain", a.gain},
          {"threshold", result.threshold},
          {"refused", refusal(result)},
          {"rows_that_decide", a.measure},
          {"soil_scatter", {{"strength", a.strength_scatter}, {"stiffness", a.stiffness_scatter}}},
          {"sensors_beyond_declared", strained},
          {"sensors_undeclared", a.unstated},
          {"soil_off_prior", moved},
          {"at_bound", a.at_bound},
          {"soil_at_bound", soilAtBounds(result.refined)}};
}

ordered_json beyondAxleJson(const TableTrace& trace) {
  if (trace.beyond_axle == 0) return {{"rows", 0}};
  return {{"rows", trace.beyond_axle}, {"refined_rmse", errorsJson(trace.beyond_axle_rmse)}};
}

}  // namespace

ordered_json traceJson(const TableTrace& trace) {
  const TraceResult& r = trace.result;
  ordered_json effects = ordered_json::array();
  const std::vector<EffectRole> roles = rolesOf(r);
  for (std::size_t k = 0; k < roles.size(); ++k) effects.push_back(effectJson(trace, r.effects[k], roles[k]));
  const auto first = std::span(r.first_promises).first(std::min<std::size_t>(12, r.first_promises.size()));
  const auto tests = jsonList(first, [](const Promise& p) -> ordered_json {
    return {{"what", p.candidate.parts.front().name},
            {"covariate", p.candidate.covariate()},
            {"channel", name(p.candidate.parts.front().channel)},
            {"gain", p.gain},
            {"p_value", p.p_value}};
  });
  return {{"verdict", name(trace.answer.verdict)},
          {"answer", answerJson(r, trace.answer)},
          {"base", {{"rmse", errorsJson(r.base_rmse)}}},
          {"effects", effects},
          {"rejected", rejectedJson(r)},
          {"refined", {{"rmse", errorsJson(r.refined_rmse)}}},
          {"held_out", heldOutJson(trace)},
          {"tests", tests},
          {"applies", trace.applies.applies},
          {"applies_reason", trace.applies.reason},
          {"rows_used", trace.rowsUsed()},
          {"rows_rejected", trace.rejected.size()},
          {"searched", searchedJson(r)},
          {"beyond_axle", beyondAxleJson(trace)}};
}

std::string beyondAxleText(const TableTrace& trace) {
  std::string errors;
  for (Channel c : kAllChannels)
    if (const double e = trace.beyond_axle_rmse[static_cast<std::size_t>(c)]; std::isfinite(e))
      errors += fmt::format("{}{} {:.3f}", errors.empty() ? "" : ", ", name(c), e);
  return fmt::format(
      "{} rows with sinkage at or above the axle are excluded, outside the range of the contact model; rmse "
      "of the refined model on them: {}",
      trace.beyond_axle, errors);
}

namespace {

/// Residuals without one effect, and the contribution of that effect, row by row over its column (over the
/// row index if no two rows differ in it, as for the effect of a group).
Plot effectPlot(const TraceResult& r, const TracedEffect& effect, std::size_t at,
                const Eigen::MatrixXd& level, const Eigen::VectorXd& sinkage) {
  RefinedModel without = r.refined;
  without.effects.erase(without.effects.begin() + static_cast<long>(at));
  SolvedContacts solved;
  const Eigen::MatrixXd rest = predictRows(without, r.trial, solved);
  const std::string column = effect.chosen.candidate.covariate();
  const Eigen::VectorXd x = covariateValues(r.trial, column, sinkage);
  const bool by_row = !(x.minCoeff<Eigen::PropagateNumbers>() < x.maxCoeff<Eigen::PropagateNumbers>());
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

void curves(Report& page, const TraceResult& r, const Eigen::MatrixXd& level,
            const Eigen::VectorXd& sinkage) {
  std::vector<Plot> plots;
  std::size_t at = r.base.effects.size();
  for (const TracedEffect& effect : r.effects) {
    if (at < r.refined.effects.size()) plots.push_back(effectPlot(r, effect, at, level, sinkage));
    at += effect.chosen.candidate.parts.size();
  }
  if (!plots.empty()) page.charts(plots);
}

void tests(Report& page, const TraceResult& r) {
  page.heading("Gain of each candidate over the base model");
  page.paragraph(fmt::format(
      "The strongest of {} candidates, each to first order: log-likelihood gained on held-out rows. p: "
      "probability that the largest gain in a table of the base model's noise is at least that large.",
      r.first_promises.size()));
  Table rows{{"candidate", "column", "channel", "gain", "p"}};
  for (std::size_t k = 0; k < r.first_promises.size() && k < 15; ++k) {
    const Promise& p = r.first_promises[k];
    const Effect& front = p.candidate.parts.front();
    rows.push_back({front.name, p.candidate.covariate(), name(front.channel), fmt::format("{:.1f}", p.gain),
                    pText(p.p_value)});
  }
  page.table(rows);
}

// Charts of each channel over slip and of each effect.
void addCharts(Report& report, const TraceResult& r) {
  SolvedContacts solved;
  const Eigen::MatrixXd base = predictRows(r.base, r.trial, solved);
  const Eigen::MatrixXd level = predictRows(r.refined, r.trial, solved);
  Eigen::VectorXd sinkage(level.rows());
  for (int row = 0; row < r.trial.rows(); ++row)
    sinkage[row] = level(row, 1) * r.trial.denominator(row, Channel::Sinkage);
  std::vector<NamedPredictions> predictions{{"base", base}};
  if (!r.effects.empty()) predictions.emplace_back("refined", level);  // otherwise the same
  std::vector<Plot> plots;
  for (Channel c : kAllChannels)
    if (r.trial.has(c)) plots.push_back(overSlip(c, r.trial, predictions));
  report.charts(plots);
  curves(report, r, level, sinkage);
}

}  // namespace

Report traceReport(const TableTrace& trace, bool page) {
  const TraceResult& r = trace.result;
  Report report("Residuals of " + std::filesystem::path(trace.source).filename().string());
  report.paragraph(verdictText(r, trace.answer));
  report.paragraph(
      fmt::format("{}: {} rows used, {} rejected", trace.source, trace.rowsUsed(), trace.rejected.size()));
  addSearched(report, r);
  if (!trace.answer.unstated.empty())
    report.paragraph(
        fmt::format("no standard deviation declared under sensors: in the base file; fitted instead: {}",
                    fmt::join(trace.answer.unstated, ", ")));
  for (const MovedParameter& p : movedSoil(r))
    report.paragraph(fmt::format(
        "warning: {} of the soil is fitted {:.1f} standard deviations from its prior ({:.4g}, prior {:.4g} "
        "+- {:.2g})",
        p.name, p.away(), p.value, p.prior, p.prior_std));
  for (const std::string& name : soilAtBounds(r.refined))
    report.paragraph("warning: " + name + " (soil) is at the bound of its range");
  if (page) addCharts(report, r);
  const std::vector<EffectRole> roles = rolesOf(r);
  for (std::size_t k = 0; k < roles.size(); ++k)
    report.paragraph(effectLine(r.trial, r.effects[k], roles[k]));
  report.table(heldOutTable("rmse of the fit", {"", r.base_rmse, r.refined_rmse}, r));
  for (const HeldOut& held : trace.held_out) report.table(heldOutTable("held out: " + held.scheme, held, r));
  addEnds(report, r);
  if (trace.beyond_axle > 0) report.paragraph(beyondAxleText(trace));
  if (page) tests(report, r);
  return report;
}

}  // namespace talus::cli
