#include <algorithm>
#include <array>
#include <string_view>

#include <nlohmann/json.hpp>

#include <talus/cli/app/context.hpp>
#include <talus/cli/draw/scene.hpp>
#include <talus/cli/ground/ground_options.hpp>
#include <talus/cli/route/provenance.hpp>

namespace talus::cli {
namespace {

using nlohmann::ordered_json;

std::string quoted(const std::string& word) {
  constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=.,:/@%";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

bool decidesNothing(std::string_view word) {
  constexpr std::array<std::string_view, 3> kFlags{"--json", "--quiet", "--force"};
  return std::find(kFlags.begin(), kFlags.end(), word) != kFlags.end();
}

bool namesOutput(std::string_view word) {
  constexpr std::array<std::string_view, 6> kOptions{"-o",    "--output",  "--html",
                                                     "--png", "--threads", "--telemetry"};
  return std::find(kOptions.begin(), kOptions.end(), word) != kOptions.end();
}

std::string textOf(const ordered_json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_array()) return value.is_null() ? "" : value.dump();
  std::string text;
  for (const ordered_json& one : value) text += (text.empty() ? "" : ", ") + textOf(one);
  return text;
}

}  // namespace

std::string callText(const char* const* argv) {
  if (argv == nullptr || *argv == nullptr) return "";
  std::string text = "talus";
  for (const char* const* word = argv + 1; *word != nullptr; ++word) {
    const std::string_view whole = *word;
    const std::string_view name = whole.substr(0, whole.find('='));
    if (decidesNothing(whole)) continue;
    if (namesOutput(name)) {
      if (name == whole && word[1] != nullptr) ++word;
      continue;
    }
    text += " " + quoted(std::string(whole));
  }
  return text;
}

std::vector<std::pair<std::string, std::string>> provenanceOf(const ordered_json& inputs) {
  std::vector<std::pair<std::string, std::string>> facts;
  if (!inputs.is_object()) return facts;
  for (const auto& [key, label] : {std::pair{"command", "command"},
                                   {"rover", "rover"},
                                   {"soils", "soil"},
                                   {"seed", "seed"},
                                   {"reading", "map read"},
                                   {"version", "version"}})
    if (inputs.contains(key)) facts.emplace_back(label, textOf(inputs.at(key)));
  if (inputs.contains("files") && inputs.at("files").is_array())
    for (const ordered_json& file : inputs.at("files"))
      if (file.is_object() && file.contains("file") && file.contains("sha256"))
        facts.emplace_back("SHA-256", textOf(file.at("file")) + " " + textOf(file.at("sha256")));
  return facts;
}

planner::RouteOrigin originOf(const Ground& ground, const Context& context) {
  planner::RouteOrigin origin = planner::originOf(ground.map, ground.files, context.seed);
  origin.command = callText(context.argv);
  return origin;
}

void addProvenance(Scene& scene, const planner::RouteOrigin& origin) {
  scene.provenance = provenanceOf(planner::originJson(origin));
  std::erase_if(scene.facts, [](const Fact& fact) { return fact.first == "rover" || fact.first == "soil"; });
}

}  // namespace talus::cli
