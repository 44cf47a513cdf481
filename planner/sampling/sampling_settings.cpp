#include <sstream>
#include <stdexcept>

#include <talus/planner/route/planner_names.hpp>
#include <talus/planner/sampling/ompl_planner.hpp>
#include <talus/planner/sampling/sampling_settings.hpp>

namespace talus::planner {

SamplingSettings samplingSettings(const std::string& words) {
  std::istringstream parts(words);
  std::string word;
  std::getline(parts, word, ':');
  SamplingSettings settings{.planner = plannerName(word)};
  while (std::getline(parts, word, ':')) {
    const std::size_t equals = word.find('=');
    if (word == "cold")
      settings.cold = true;
    else if (equals != std::string::npos && equals > 0)
      settings.parameters[word.substr(0, equals)] = word.substr(equals + 1);
    else
      throw std::invalid_argument("planner '" + words + "': '" + word + "' is neither cold nor NAME=VALUE");
  }
  if (settings.cold || !settings.parameters.empty()) checkParameters(settings.planner, settings.parameters);
  return settings;
}

std::vector<std::string> warmAndCold() {
  std::vector<std::string> all = plannerNames();
  for (const std::string& name : plannerNames())
    if (isOmpls(name)) all.push_back(name + ":cold");
  return all;
}

std::string wordsOf(const SamplingSettings& settings) {
  std::string words = settings.planner + (settings.cold ? ":cold" : "");
  for (const auto& [name, value] : settings.parameters) words += ":" + name + "=" + value;
  return words;
}

}  // namespace talus::planner
