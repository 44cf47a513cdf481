// talus check FILE: runs cases of a test language: operation, input, expect, tolerance.
#include <cmath>
#include <cstdio>
#include <filesystem>

#include <sys/wait.h>

#include <talus/cli/app/command.hpp>
#include <talus/terramech/io/csv_reader.hpp>
#include <talus/terramech/io/yaml_fields.hpp>

namespace talus::cli {
namespace {

using nlohmann::json;
using terramech::YamlFields;

struct CheckOptions {
  std::string file;
};

void bind(CLI::App& command, CheckOptions& options) {
  addOption(command, "file FILE.yaml", options.file)->required();
}

// The call of a case: talus OPERATION ARGUMENTS --KEY=VALUE, for each key of `input`; true is a flag.
std::string callOf(const YamlFields& one) {
  std::string call = shellWord(std::filesystem::read_symlink("/proc/self/exe").string()) +
                     " --json --quiet " + shellWord(one.word("operation"));
  for (const std::string& word : one.texts("arguments")) call += " " + shellWord(word);
  if (!one.has("input")) return call;
  const YamlFields input = one.fields("input");
  for (const std::string& key : input.names())
    for (const std::string& value : input.texts(key))
      call += " " + shellWord("--" + key + (value == "true" ? "" : "=" + value));
  return call;
}

struct Answer {
  int exit_code = 0;
  std::string text;  // stdout and stderr: JSON, or the line of an error
};

Answer answerTo(const std::string& call, const std::filesystem::path& folder) {
  const std::string shell =
      "cd " + shellWord(folder.empty() ? "." : folder.string()) + " && " + call + " 2>&1";
  Answer answer;
  FILE* pipe = popen(shell.c_str(), "r");  // NOLINT(cert-env33-c): every word is quoted
  if (pipe == nullptr) throw InputError({"talus check", "cannot start a program", "free some memory"});
  char part[4096];
  for (std::size_t n = 0; (n = std::fread(part, 1, sizeof part, pipe)) > 0;) answer.text.append(part, n);
  answer.exit_code = WEXITSTATUS(pclose(pipe));
  return answer;
}

// The value under a name, in which dots and numbers lead into objects and lists.
json found(const Answer& answer, const std::string& name) {
  if (name == "exit") return answer.exit_code;
  if (name == "error") return oneLine(answer.text);
  std::string path = "/" + name;
  for (char& c : path) c = c == '.' ? '/' : c;
  const json all = json::parse(answer.text, nullptr, false);
  const json::json_pointer at(path);
  return !all.is_discarded() && all.contains(at) ? all[at] : json();
}

// True if a value is as expected: a number within the tolerance, a text that is equal or, of an error, contained.
bool agrees(const json& value, const std::string& name, const std::string& expected, double tolerance,
            double relative) {
  if (double number = 0.0; terramech::parseNumber(expected, number))
    return value.is_number() &&
           std::abs(value.get<double>() - number) <= std::max(tolerance, relative * std::abs(number));
  if (!value.is_string()) return expected == value.dump();
  const auto& text = value.get_ref<const std::string&>();
  return name == "error" ? text.find(expected) != std::string::npos : text == expected;
}

struct Outcome {
  std::string name, source;
  bool known_failure = false;
  std::vector<json> wrong{};  // {key, expect, found}
};

Outcome outcomeOf(const YamlFields& one, const std::filesystem::path& folder) {
  one.only({"name", "operation", "arguments", "input", "expect", "tolerance", "relative", "source",
            "known_failure"});
  Outcome out{one.word("name"), one.word("source", ""), one.flag("known_failure", false)};
  if (one.word("operation") == "check")
    one.refuse("operation", "a case cannot run check", "list its cases here");
  if (one.fields("expect").names().empty())
    one.refuse("expect", "expect is empty", "name what must be answered");
  const Answer answer = answerTo(callOf(one), folder);
  const YamlFields expect = one.fields("expect");
  for (const std::string& key : expect.names()) {
    const std::string expected = expect.word(key);
    const json value = found(answer, key);
    if (!agrees(value, key, expected, one.number("tolerance", 0.0), one.number("relative", 1e-9)))
      out.wrong.push_back({{"key", key},
                           {"expect", expected},
                           {"found", value.is_null() ? json(oneLine(answer.text)) : value}});
  }
  return out;
}

int run(const CheckOptions& options, Context& context) {
  const YamlFields file = YamlFields::file(options.file);
  file.only({"cases"});
  const auto cases = file.list("cases");
  if (cases.empty()) file.refuse("", "contains no case", "list them under cases");
  int passed = 0;
  auto failed = nlohmann::ordered_json::array(), known = failed;
  std::string text;
  const ProgressMonitor watch = context.watch("check");
  for (std::size_t k = 0; k < cases.size(); ++k) {
    if (context.stop.stop_requested()) return Exit::kCancelled;
    const Outcome out = outcomeOf(cases[k], std::filesystem::path(options.file).parent_path());
    const bool good = out.wrong.empty() != out.known_failure;
    passed += good && !out.known_failure ? 1 : 0;
    nlohmann::ordered_json line{{"name", out.name}, {"source", out.source}, {"wrong", out.wrong}};
    if (out.known_failure && out.wrong.empty()) line["reason"] = "known_failure, but it passes";
    if (out.known_failure && good) known.push_back(line);
    if (!good) failed.push_back(line);
    text += fmt::format("{:<14}{}\n",
                        !good               ? "failed"
                        : out.known_failure ? "known failure"
                                            : "passed",
                        out.name);
    for (const json& wrong : out.wrong)
      text += fmt::format("  {}: {}, must be {}\n", wrong["key"].get<std::string>(), wrong["found"].dump(),
                          wrong["expect"].get<std::string>());
    watch.report(static_cast<double>(k + 1) / static_cast<double>(cases.size()));
  }
  context.answer(
      {{"passed", passed}, {"failed", failed}, {"known_failures", known}},
      text + fmt::format("{} passed, {} failed, {} known failures\n", passed, failed.size(), known.size()));
  return failed.empty() ? Exit::kDone : Exit::kNo;
}

}  // namespace

void addCheck(CLI::App& app, Context& context) {
  addCommand<CheckOptions>(app, context, "check", bind, run);
}

}  // namespace talus::cli
