#include "validation_page.hpp"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <talus/cli/app/commands.hpp>
#include <talus/cli/app/context.hpp>
#include <talus/common/common.hpp>
#include <talus/common/output_file.hpp>

#include "goal_study.hpp"
#include "published.hpp"
#include "thesis_figures.hpp"

namespace talus::reproduce {

using namespace cli;

namespace {

std::string goalTable(const std::vector<GoalLine>& lines) {
  std::string text = "| quantity | reached | goal |\n|---|---|---|\n";
  for (const GoalLine& l : lines)
    text += fmt::format("| {} | {} | {} |\n", l.quantity, l.reached, l.goal.empty() ? "-" : l.goal);
  return text;
}

std::vector<PublishedCase> publishedCases(const std::string& name, const ProgressMonitor& watch) {
  std::vector<PublishedCase> cases = publishedWheels(name, watch);
  for (PublishedCase& of : publishedRoutes(name, watch)) cases.push_back(std::move(of));
  if (cases.empty() && !watch.stopped())
    throw InputError({"--published " + name, "is no published result", "leave the name out for a list"});
  return cases;
}

std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.4g}", value) : "-";
}

std::string errorText(const PublishedLine& line) {
  if (!std::isfinite(line.error())) return "-";
  return line.relative ? fmt::format("{:+.2f} %", 100.0 * line.error())
                       : fmt::format("{:+.3f}", line.error());
}

std::string publishedTable(const std::vector<PublishedCase>& cases) {
  std::string text = "| case | quantity | theirs | ours | error |\n|---|---|---|---|---|\n";
  for (const PublishedCase& of : cases)
    for (const PublishedLine& l : of.lines)
      text += fmt::format("| {} | {} | {} | {} | {} |\n", of.name, l.quantity, number(l.theirs),
                          number(l.ours), errorText(l));
  text += "\n| case | source | inputs and remarks |\n|---|---|---|\n";
  for (const PublishedCase& of : cases)
    text += fmt::format("| {} | {} | {} |\n", of.name, of.source, of.remark);
  return text;
}

nlohmann::ordered_json publishedJson(const std::vector<PublishedCase>& cases) {
  auto list = nlohmann::ordered_json::array();
  for (const PublishedCase& of : cases) {
    for (const PublishedLine& l : of.lines)
      list.push_back({{"case", of.name},
                      {"quantity", l.quantity},
                      {"theirs", l.theirs},
                      {"ours", l.ours},
                      {"error", l.error()},
                      {"relative", l.relative},
                      {"source", of.source}});
    if (of.lines.empty())
      list.push_back({{"case", of.name},
                      {"theirs", nullptr},
                      {"ours", nullptr},
                      {"error", nullptr},
                      {"source", of.source},
                      {"remark", of.remark}});
  }
  return list;
}

std::string pictureName(const ThesisFigure& figure) {
  std::string name = "validation/figure_" + figure.number + ".png";
  std::replace(name.begin(), name.end() - 4, '.', '_');
  return name;
}

// The errata that tests/terramech/errata_test.cpp checks, in our words.
constexpr const char* kErrata =
    "## Errata of the thesis\n"
    "\n"
    "Each erratum has a test (`ctest -R Errata`); the corrected form is implemented.\n"
    "\n"
    "| where | printed | correct |\n"
    "|---|---|---|\n"
    "| Eq. 2.3, offset term | cos(theta_m) - sin(theta_m)/theta_m + theta_m | 1 - sin(theta_m)/theta_m; Eq. "
    "2.10 follows from this one only |\n"
    "| before Eq. 3.12 | theta_1 = arctan(1 - z/r) | arccos(1 - z/r) |\n"
    "| Eqs. 3.6, 3.15 and Fig. 3.6 | z/r ~ theta_1 | z/r ~ theta_1^2/2 |\n"
    "| Eq. 3.3 | (W - A sin theta)/cos theta | (W - X sin theta)/cos theta |\n"
    "| Eq. 3.7, first integral | from 0 to theta_1 | from 0 to theta_m |\n"
    "| Eqs. 3.8, B.4, first line | T is the integral of tau | T is r times it; the last line is right |\n"
    "| Eq. 3.12 | four trigonometric brackets | is exactly (sin q/q)^2/cos(2q) T/r - tan(2q) W, q = "
    "theta_1/4 |\n"
    "| Eq. 3.14 | factor 1 + theta_1^2/4 of T/r | 1 + 5 theta_1^2/48 to second order |\n"
    "| Eq. B.5, second member | r b before the first bracket only | before both |\n"
    "| App. B.3 | c1 + c2 i between 0.4 and 0.6 | 0.49 to 0.69 with Table 2.1 and slip 0.2 to 0.8 |\n"
    "| App. D.2 | A near 1 at high slip, B near 1 | A is 0.6 to 0.75 at slip 0.8 over Table 2.1 |\n"
    "| Sec. 3.5 | topsoil (0.3, 0.4) is safe at 10 deg | Eq. 3.21 gives DP/W = -0.20: dangerous |\n"
    "\n";

constexpr const char* kNotes =
    "The prior of each line:\n"
    "\n"
    "- \"four classes\", and DP/W of the soil of ten samples: the four rows of Table 2.1, equally likely, "
    "each "
    "normal with the mean and standard deviation of its ranges; the soils are drawn uniformly from the "
    "ranges.\n"
    "- \"class known\": the one row of Table 2.1 that the soil was drawn from.\n"
    "- \"K given\": no prior except the true K.\n"
    "- Single force and the equations of chapter 3: no prior.\n"
    "\n"
    "Each class is normal about its most likely soil, with the weight of its evidence.\n"
    "\n"
    "Measured rows were read off printed curves, with an error of some 0.02 in DP/W, so that a goal of "
    "0.020 is at that error.\n"
    "The line in T/(rW) is one of about ten forms that were tried on six rows, so that its figure is "
    "optimistic.\n"
    "\n";

// The picture of a case: its own, or theirs and ours line by line.
std::vector<Plot> picturesOf(const PublishedCase& of) {
  if (!of.plots.empty() || of.lines.empty()) return of.plots;
  Series theirs{.name = "theirs", .mark = Series::Mark::Points},
      ours{.name = "ours", .mark = Series::Mark::Points};
  for (const PublishedLine& line : of.lines) {
    const auto place = static_cast<double>(theirs.x.size() + 1);
    theirs.x.push_back(place), theirs.y.push_back(line.theirs);
    ours.x.push_back(place), ours.y.push_back(line.ours);
  }
  return {{.title = of.name, .x = {"line of the table"}, .y = {"value"}, .series = {theirs, ours}}};
}

std::string pictureName(const PublishedCase& of) {
  return "validation/published_" + of.name + ".png";
}

std::string page(const std::vector<ThesisFigure>& figures, const std::vector<GoalLine>& goals,
                 const std::vector<PublishedCase>& published, const ReproduceOptions& options,
                 std::uint64_t seed) {
  const std::string call =
      fmt::format("talus reproduce -o DIR --soils {} --seed {}{}", options.soils, seed,
                  options.measured.empty()
                      ? ""
                      : " --measured " + std::filesystem::path(options.measured).filename().string());
  std::string text =
      "# Held against published results\n"
      "\n"
      "Every number and figure on this page comes from one command, `" +
      call +
      "`, which also writes this page.\n"
      "The thesis is kang_2003 in REFERENCES.bib.\n"
      "Deviations are marked and explained.\n"
      "No number is tuned to a line: soils and rovers are those published, and what was fitted is named.\n"
      "\n"
      "## Published results\n"
      "\n"
      "`talus reproduce --published [NAME]`, with TALUS_MEASURED_DATA and TALUS_REAL_MAPS for cases of "
      "measured data and "
      "real maps.\n"
      "The error is ours less theirs, or a share of theirs (%).\n"
      "\n" +
      publishedTable(published) +
      "\n"
      "## Figures of the thesis\n"
      "\n"
      "| figure | thesis | result | verdict |\n"
      "|---|---|---|---|\n";
  for (const ThesisFigure& f : figures)
    text += fmt::format("| {} {} | {} | {} | {} |\n", f.number, f.title, f.claim, f.found, f.verdict);
  text +=
      "\n"
      "## Accuracy of the estimators\n"
      "\n"
      "Soils uniform over Table 2.1, ten samples in the thesis' slip pattern, loads 60 to 100 N, relative "
      "Gaussian errors on W, T, z and i.\n"
      "Measured by `talus reproduce --goals` with the same seed; times depend on the machine.\n"
      "\n";
  text += kNotes;
  text += goalTable(goals) + "\n" + kErrata + "## Pictures\n\n";
  for (const PublishedCase& of : published)
    if (!of.lines.empty()) text += fmt::format("### {}\n\n![{}]({})\n\n", of.name, of.name, pictureName(of));
  for (const ThesisFigure& f : figures)
    text += fmt::format("### Figure {}: {}\n\n![{}]({})\n\n", f.number, f.title, f.title, pictureName(f));
  return text;
}

std::filesystem::path madeFolder(const ReproduceOptions& options) {
  std::filesystem::path folder = options.output;
  std::error_code failed;
  std::filesystem::create_directories(folder / "validation", failed);
  if (failed) {
    throw InputError(
        {.where = options.output, .reason = failed.message(), .remedy = "name a folder that can be created"});
  }
  return folder;
}

}  // namespace

int run(const ReproduceOptions& options, Context& context) {
  if (options.published) {
    const ProgressMonitor watch = context.watch("published");
    const auto cases = publishedCases(options.published_name, watch);
    if (watch.stopped()) return Exit::kCancelled;
    if (context.json)
      printJson(publishedJson(cases));
    else
      print(publishedTable(cases));
    return Exit::kDone;
  }
  const auto folder = options.goals_only ? std::filesystem::path() : madeFolder(options);
  const GoalOptions study{.seed = context.seed, .soils = options.soils, .measured = options.measured};
  const ProgressMonitor watch = context.watch("soils");
  const std::vector<GoalLine> goals = measureGoals(study, watch);
  if (watch.stopped()) return Exit::kCancelled;
  if (options.goals_only) {
    if (!context.json) return print(goalTable(goals)), Exit::kDone;
    auto list = nlohmann::ordered_json::array();
    for (const GoalLine& l : goals)
      list.push_back({{"quantity", l.quantity}, {"reached", l.reached}, {"goal", l.goal}});
    return printJson(list), Exit::kDone;
  }
  std::vector<ThesisFigure> figures = estimationFigures(context.seed);
  for (ThesisFigure& f : traversabilityFigures(context.seed)) figures.push_back(std::move(f));
  for (ThesisFigure& f : appendixFigures(context.seed)) figures.push_back(std::move(f));
  for (const ThesisFigure& f : figures) saveFigure(folder / pictureName(f), f.plots);
  const auto published = publishedCases("", context.watch("published"));
  if (watch.stopped()) return Exit::kCancelled;
  for (const PublishedCase& of : published)
    if (!of.lines.empty()) saveFigure(folder / pictureName(of), picturesOf(of));
  writeFile(folder / "validation.md", page(figures, goals, published, options, context.seed));
  if (context.json) {
    printJson({{"page", (folder / "validation.md").string()}, {"figures", figures.size()}});
  } else {
    print(fmt::format("{}: {} figures, {} measured lines\n", (folder / "validation.md").string(),
                      figures.size(), goals.size()));
  }
  return Exit::kDone;
}

}  // namespace talus::reproduce
