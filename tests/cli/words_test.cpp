// Texts for users are plain technical English: replaced words must not return in messages, pages, documents
// or --help.
#include <algorithm>
#include <regex>
#include <set>
#include <sstream>

#include "public_headers.hpp"
#include "run_program.hpp"
#include "string_literals.hpp"

namespace talus::cli {
namespace words_test {

namespace fs = std::filesystem;

/// A replaced word as a regular expression, and the term to use instead.
struct Replaced {
  const char* word;
  const char* term;
};

constexpr Replaced kReplaced[] = {
    {"pull to spare|spare pull", "drawbar-pull margin"},
    {"sinks [^ ]+ mm at most", "sinkage max"},
    {"cheapest there can be|cheapest possible", "proven optimality gap"},
    {"get stuck on the way", "immobilisation probability"},
    {"times the straight line", "detour factor"},
    {"ground 100|hillshade alone|its uncertainty \\(std",
     "traversability; hillshade only; standard deviation"},
    {"point at (a|the) ", "hover over"},
    {"asks? for|asked for|the (ground|soil) (can )?gives?|ask of", "required DP/W, available DP/W"},
    {"nobody (drove|has seen|declared)|prior speaks|speaks alone", "no telemetry; prior only"},
    {"that will do", "traversable"},
    {"(is|are|be) taken (for|as|over|\\b)", "using default, assumed, computed"},
    {"\\bdoubts?\\b", "uncertainty"},
    {"whose wheel", "rover that supplies wheel dimensions"},
    {"rank is lost|keeps the rank", "the category drops one level"},
    {"seeds a case", "runs per case"},
    {"rover looks|looks there|which way", "heading"},
    {"climbs deg", "maximum climbable slope"},
    {"(told|tell|tells|telling) [^.]*apart", "listed separately; discriminate"},
    {"(cannot|can|would|could) tell\\b", "distinguish; show"},
    {"measured less|less model", "residual (measured - model)"},
    {"were asked|strongest questions|all questions", "hypothesis tests"},
    {"(nothing|comes?) near\\b", "no close alternative"},
    {"normal score", "z-score"},
    {"readings allow", "posterior samples"},
    {"of a reading off", "mean residual"},
    {"believed anew|\\bbreach", "reclassified; invalid"},
    {"clairvoyan", "perfect knowledge"},
    {"\\b(gave|gives?|given) up\\b", "no feasible route"},
    {"says? nothing|\\bsays\\b", "insufficient measurements; states"},
    {"\\bmend(s|ed)?\\b", "fix"},
    {"rehears", "traverse simulation"},
    {"\\banew\\b", "again; replaced"},
    {"beliefs? map|maps? of beliefs?", "traversability map"},
    {"\\bbelieved?\\b", "estimated; build the traversability map"},
    {"who plans|goes by\\b", "planner; soil knowledge"},
    {"\\bfor ever\\b", "unbounded"},
    {"to look at\\b", "page"},
    {"\\bunlike\\b|\\balike\\b", "different; equal"},
    {"ways? around|no way\\b", "no detour; no route found"},
    {"pulls? it takes|takes the pull", "required drawbar pull"},
    {"steals?|\\bblind(ly|s)?\\b", "without telemetry"},
    {"\\bworth\\b", "cost"},
    {"\\bwrong at\\b|\\bsure of wrong\\b|\\bunsure\\b", "overconfident; uncertain"},
    {"how far from (the )?(best|cheapest)", "optimality gap"},
    {"\\bhouse\\b", "architecture"},
};

/// Names of JSON fields in the stable interface, which are exempt.
const std::set<std::string>& promised() {
  static const std::set<std::string> names{"clairvoyant", "breached", "to_tell_apart", "gave_up"};
  return names;
}

std::string complaint(const std::string& text) {
  for (const Replaced& r : kReplaced) {
    std::smatch found;
    if (std::regex_search(text, found, std::regex(r.word, std::regex::icase)))
      return "'" + found.str() + "' in \"" + text.substr(0, 200) + "\"; write: " + r.term;
  }
  return "";
}

std::vector<fs::path> filesBelow(const std::string& folder, const std::set<std::string>& endings) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(TALUS_SOURCE_DIR) / folder))
    if (entry.is_regular_file() && endings.contains(entry.path().extension())) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

void expectPlainLines(const fs::path& file) {
  std::istringstream lines(fileContent(file));
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    // Code spans contain stable names or names of tests.
    const std::string why = complaint(std::regex_replace(line, std::regex("`[^`]*`"), "``"));
    EXPECT_EQ(why, "") << file << ":" << number;
  }
}

TEST(Words, WordCheckDetectsFigurativePhrases) {
  EXPECT_NE(complaint("found by field, within 10.4 % of the cheapest there can be"), "");
  EXPECT_NE(complaint("k_c and k_phi cannot be told apart"), "");
  EXPECT_EQ(complaint("found by field; proven optimality gap <= 10.4 %"), "");
  EXPECT_THAT(stringLiterals("a(\"one \"\n  \"two\"); // \"three\"\n b('\"', R\"(four)\");"),
              testing::ElementsAre("one two", "four"));
}

TEST(Words, MessagesContainNoFigurativeWords) {
  for (const std::string module : {"terramech", "maps", "costmap", "planner", "cli", "tests/reproduce"})
    for (const fs::path& file : filesBelow(module, {".cpp", ".hpp"}))
      for (const std::string& literal : stringLiterals(fileContent(file)))
        EXPECT_EQ(promised().contains(literal) ? "" : complaint(literal), "") << file;
}

TEST(Words, PagesAndDocumentsContainNoFigurativeWords) {
  for (const fs::path& file : filesBelow("cli", {".js", ".html", ".yaml"})) expectPlainLines(file);
  for (const std::string folder :
       {"docs", "common", "terramech", "maps", "costmap", "planner", "cli", "examples", "tests"})
    for (const fs::path& file : filesBelow(folder, {".md"})) expectPlainLines(file);
  for (const auto& entry : fs::directory_iterator(TALUS_SOURCE_DIR))
    if (entry.path().extension() == ".md") expectPlainLines(entry.path());
}

/// Public headers whose comments still contain replaced words; remove a name when its comments are rewritten.
const std::set<std::string>& toBeRewritten() {
  static const std::set<std::string> headers{
      "costmap/evidence/block_evidence.hpp",  "costmap/evidence/evidence_bricks.hpp",
      "costmap/evidence/evidence_field.hpp",  "costmap/evidence/observation_fault.hpp",
      "costmap/telemetry/drive_evidence.hpp",
  };
  return headers;
}

// Comment part of a header line; the whole line in the C header, whose comments span several lines.
std::string commentOf(const std::string& line, bool is_c) {
  const auto at = line.find("//");
  if (is_c) return line;
  return at == std::string::npos ? std::string() : line.substr(at);
}

std::string firstComplaint(const std::string& source, bool is_c) {
  std::istringstream lines(source);
  for (std::string line; std::getline(lines, line);) {
    const std::string comment = std::regex_replace(commentOf(line, is_c), std::regex("`[^`]*`"), "``");
    if (const std::string why = complaint(comment); !why.empty()) return why;
  }
  return "";
}

TEST(Words, OfPublicHeadersArePlain) {
  EXPECT_NE(firstComplaint("int a;\n/// What is believed of a cell.\n", false), "");
  EXPECT_EQ(firstComplaint("bool believed;\n/// The estimate of a cell.\n", false), "");
  for (const std::string& header : test::publicHeaders(TALUS_SOURCE_DIR)) {
    if (toBeRewritten().contains(header)) continue;
    const std::string source = fileContent(fs::path(TALUS_SOURCE_DIR) / header);
    EXPECT_EQ(firstComplaint(source, header.ends_with(".h")), "") << header;
  }
}

/// Names of the subcommands that `talus --help` lists.
std::vector<std::string> calls() {
  const std::string help = runTalus({"--help"}).out;
  const std::regex line(R"(\n  ([a-z]+) {2,})");
  std::vector<std::string> names;
  for (std::sregex_iterator i(help.begin(), help.end(), line), end; i != end; ++i) names.push_back((*i)[1]);
  return names;
}

void expectHelp(const std::string& help, const std::string& call) {
  std::istringstream lines(help);
  std::string purpose, usage;
  std::getline(lines, purpose);
  std::getline(lines, usage);
  EXPECT_LE(purpose.size(), 70U) << call;
  EXPECT_THAT(usage, testing::StartsWith("Usage: talus")) << call;
  int examples = 0;
  bool under = false;
  for (std::string line; std::getline(lines, line);) {
    EXPECT_LE(line.size(), 100U) << call << ": " << line;
    under = under || line == "Examples:";
    examples += under && line.starts_with("  talus " + call + " ") ? 1 : 0;
    examples += under && line == "  talus " + call ? 1 : 0;
  }
  EXPECT_GE(examples, call.empty() ? 0 : 2) << call;
  EXPECT_EQ(complaint(help), "") << call;
}

TEST(Words, HelpFitsTheLineWidthWithTwoExamples) {
  const auto names = calls();
  EXPECT_EQ(names.size(), 21U);
  expectHelp(runTalus({"--help"}).out, "");
  for (const std::string& call : names) expectHelp(runTalus({call, "--help"}).out, call);
}

}  // namespace words_test
}  // namespace talus::cli
