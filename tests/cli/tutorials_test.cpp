// Runs the pages of docs/tutorials and the README: a block "LANGUAGE NAME" is a file; a block "console" lists commands after
// "$ ", lines expected in their output in that order, and "exit N" for a command that fails.
#include <filesystem>
#include <map>
#include <regex>
#include <sstream>

#include <fmt/format.h>

#include "run_program.hpp"

namespace talus::cli {
namespace tutorials_test {

namespace fs = std::filesystem;

struct Command {
  std::string line;
  std::vector<std::string> says;
};

/// Writes the files of a page and returns its commands.
std::vector<Command> commandsOf(const fs::path& page, const Folder& folder) {
  std::vector<Command> commands;
  std::istringstream text(fileContent(page.string()));
  std::string line, file, content;
  bool console = false;
  while (std::getline(text, line)) {
    if (line.starts_with("```")) {
      if (!file.empty()) folder.write(file, content);
      console = line == "```console";
      const auto blank = line.find(' ');
      file = blank == std::string::npos ? "" : line.substr(blank + 1);
      content.clear();
    } else if (!file.empty()) {
      content += line + "\n";
    } else if (console && line.starts_with("$ ")) {
      commands.push_back({line.substr(2), {}});
    } else if (console && !commands.empty() && line != "...") {
      commands.back().says.push_back(line);
    }
  }
  return commands;
}

/// Output of a command, followed by "exit N" if the command fails.
std::string outputOf(const Command& command, const Folder& folder) {
  folder.write("command.sh", "cd '" + folder.path().string() + "'\nexport PATH='" + folder.path().string() +
                                 "/bin':$PATH PKG_CONFIG_PATH='" + folder.path().string() + "/bin'\n" +
                                 command.line + "\n");
  const std::string call = "bash '" + (folder / "command.sh") + "' >'" + (folder / "output") + "' 2>&1";
  const int code = std::system(call.c_str());  // NOLINT(cert-env33-c)
  return fileContent(folder / "output") + (code == 0 ? "" : fmt::format("\nexit {}\n", WEXITSTATUS(code)));
}

void expectOutput(const Command& command, const std::string& output) {
  std::size_t from = 0;
  for (const std::string& line : command.says) {
    const std::size_t at = output.find(line, from);
    ASSERT_NE(at, std::string::npos) << command.line << "\nlacks\n" << line << "\nin\n" << output;
    from = at + line.size();
  }
  const bool fails = !command.says.empty() && command.says.back().starts_with("exit ");
  EXPECT_EQ(output.find("\nexit ") != std::string::npos, fails) << command.line << "\n" << output;
}

class Tutorial : public testing::TestWithParam<std::string> {};

TEST_P(Tutorial, CommandsProduceTheStatedOutput) {
  const fs::path source = TALUS_SOURCE_DIR;
  const Folder folder;
  fs::create_directory(folder.path() / "bin");
  fs::create_symlink(TALUS_PROGRAM, folder.path() / "bin/talus");
  const fs::path installed = folder.path() / "share/doc/talus";
  fs::create_directories(installed);
  fs::create_directory_symlink(source / "examples", installed / "examples");
  folder.write("bin/talus.pc",
               "Name: talus\nDescription: of this build\nVersion: 0\nCflags: -I" TALUS_HEADERS "\n");
  const std::vector<Command> commands = commandsOf(source / "docs/tutorials" / (GetParam() + ".md"), folder);
  ASSERT_GE(commands.size(), 3U);
  for (const Command& command : commands) expectOutput(command, outputOf(command, folder));
}

/// The form in which a command of the README is run here. `./dev demo` runs its script without building, `talus bench`
/// one of its runs. Of the other jobs of ./dev the names are looked for: those of the job and of the tests of -R.
std::string shortened(const std::string& line) {
  const std::string source = TALUS_SOURCE_DIR;
  std::smatch found;
  if (line.starts_with("git clone ")) return "true";
  if (line.starts_with("./dev demo")) return "'" + source + "/docs/demo.sh' '" TALUS_PROGRAM "'";
  if (std::regex_match(line, found, std::regex(R"(\./dev test -R (\w+))")))
    return fmt::format("grep -rqE 'TEST(_P|_F)?\\({}' '{}/tests'", found[1].str(), source);
  if (std::regex_search(line, found, std::regex(R"(^\./dev (\w+))")))
    return fmt::format("grep -q '^  {})' '{}/dev'", found[1].str(), source);
  if (line.starts_with("talus bench ")) return line + " --part 1/490";
  return line.starts_with("./") || line.starts_with("tests/") ? source + "/" + line : line;
}

// Whether a text has a number that is `stated` with the digits of `stated`; signs are those of the words around it.
bool hasNumber(const std::string& text, const std::string& stated) {
  const auto point = stated.find('.');
  const auto digits = static_cast<int>(point == std::string::npos ? 0 : stated.size() - point - 1);
  const std::regex number(R"(\d+(\.\d+)?)");
  for (std::sregex_iterator i(text.begin(), text.end(), number), end; i != end; ++i)
    if (fmt::format("{:.{}f}", std::stod(i->str()), digits) == stated) return true;
  return false;
}

// Property: each command of the README runs as it is printed, and prints what stands there; a figure of its table is in
// the output of its command, rounded.
TEST(Readme, CommandsProduceTheStatedOutputAndFigures) {
  const fs::path source = TALUS_SOURCE_DIR;
  const std::string page = fileContent(source / "README.md");
  EXPECT_THAT(fileContent(source / "dev"),
              testing::ContainsRegex("demo\\).*\n.*build release talus_reproduce"));
  const Folder folder;
  fs::create_directory(folder.path() / "bin");
  fs::create_symlink(TALUS_PROGRAM, folder.path() / "bin/talus");
  std::vector<Command> commands = commandsOf(source / "README.md", folder);
  EXPECT_GE(commands.size(), 4U);
  const std::regex row(R"(\|([^|\n]*)\| `([^`\n]+)` \|\n)"), call("[^|] ?`(talus [^`\n]+)`");
  std::map<std::string, std::string> figures;  // by command
  for (std::sregex_iterator i(page.begin(), page.end(), row), end; i != end; ++i) figures[(*i)[2]] += (*i)[1];
  EXPECT_GE(figures.size(), 5U);
  for (const auto& [line, figure] : figures) commands.push_back({line, {}});
  for (std::sregex_iterator i(page.begin(), page.end(), call), end; i != end; ++i)
    if (!figures.contains((*i)[1])) commands.push_back({(*i)[1], {}});
  const std::regex number(R"(\d+(\.\d+)?)");
  for (Command command : commands) {
    const std::string line = command.line;
    command.line = shortened(line);
    const std::string output = outputOf(command, folder), figure = figures[line];
    expectOutput(command, output);
    if (!line.starts_with("talus ") || command.line != line) continue;
    for (std::sregex_iterator i(figure.begin(), figure.end(), number), end; i != end; ++i)
      EXPECT_TRUE(hasNumber(output, i->str())) << line << " does not print " << i->str() << "\n" << output;
  }
}

INSTANTIATE_TEST_SUITE_P(Docs, Tutorial,
                         testing::Values("five_minutes", "three_sites", "wheel_data", "own_planner",
                                         "own_layer", "teaching"),
                         [](const auto& one) { return one.param; });

// Property: --help of a subcommand lists every option with which a page of the repository uses the
// subcommand.
TEST(Documents, DocumentedOptionsExist) {
  const std::regex call("talus ([a-z]+)( [^`\n]*)?"), option("--[a-z][a-z-]*");
  std::map<std::string, std::string> helps;
  int options = 0;
  for (const auto& entry : fs::recursive_directory_iterator(TALUS_SOURCE_DIR)) {
    if (entry.path().extension() != ".md" || entry.path().string().find("/build/") != std::string::npos)
      continue;
    const std::string page = fileContent(entry.path().string());
    for (std::sregex_iterator found(page.begin(), page.end(), call), end; found != end; ++found) {
      const std::string name = (*found)[1], words = (*found)[2];
      if (!helps.contains(name)) helps[name] = runTalus({name, "--help"}).out + runTalus({"--help"}).out;
      if (helps[name].find("talus " + name) == std::string::npos)
        continue;  // not a subcommand: "talus is", "talus program"
      for (std::sregex_iterator one(words.begin(), words.end(), option); one != end; ++one, ++options)
        EXPECT_NE(helps[name].find(one->str()), std::string::npos) << entry.path() << ": " << found->str();
    }
  }
  EXPECT_GT(options, 100);
}

// Property: every page of docs/tutorials is tested.
TEST(Tutorials, EveryTutorialIsTested) {
  EXPECT_EQ(std::distance(fs::directory_iterator(fs::path(TALUS_SOURCE_DIR) / "docs/tutorials"), {}), 6);
}

}  // namespace tutorials_test
}  // namespace talus::cli
