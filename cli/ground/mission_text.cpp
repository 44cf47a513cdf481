#include <map>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <talus/cli/ground/mission.hpp>
#include <talus/cli/ground/mission_text.hpp>

namespace talus::cli {
namespace {

// Keys with a value as entries; keys without a value as YAML comments.
std::string keysText(std::span<const terramech::FileKey> keys,
                     const std::map<std::string, std::string>& values, const std::string& indent) {
  std::string text;
  for (const terramech::FileKey& key : keys) {
    const auto value = values.find(key.name);
    text += value == values.end()
                ? fmt::format("{}# {}:  # {}\n", indent, key.name, key.meaning)
                : fmt::format("{}{}: {}  # {}\n", indent, key.name, value->second, key.meaning);
  }
  return text;
}

}  // namespace

std::string missionText(const MissionDraft& draft) {
  const auto quoted = [](const std::string& word) { return nlohmann::json(word).dump(); };
  std::map<std::string, std::string> maps{{"dem", quoted(draft.dem)}};
  if (draft.resolution_m > 0.0) maps["resolution_m"] = fmt::format("{:.10g}", draft.resolution_m);
  if (draft.ignore_crs) maps["ignore_crs"] = "true";
  const std::map<std::string, std::string> values{{"rover", quoted(draft.rover)},
                                                  {"soil", quoted(draft.soil)},
                                                  {"start", quoted(draft.start)},
                                                  {"goal", quoted(draft.goal)},
                                                  {"output", quoted(draft.output)}};
  std::string text =
      "# talus plan FILE.yaml; paths are relative to this file. Take the # off what you need.\nmaps:\n";
  text += keysText(missionMapKeys(), maps, "  ");
  for (const terramech::FileKey& key : missionKeys()) {
    if (std::string(key.name) == "maps") continue;
    if (std::string(key.name) == "thresholds")
      text +=
          "# thresholds:  # uncomment with the keys that you need\n" + keysText(thresholdKeys(), {}, "#   ");
    else
      text += keysText({&key, 1}, values, "");
  }
  return text;
}

}  // namespace talus::cli
