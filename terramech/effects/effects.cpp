#include <algorithm>
#include <cmath>
#include <unordered_map>

#include <talus/terramech/effects/effects.hpp>

namespace talus::terramech {

double Effect::sense(double slip_angle_rad) const {
  return channel == Channel::SideForce ? std::sin(slip_angle_rad) : 1.0;
}

bool knowsPasses(std::span<const Effect> effects) {
  return std::any_of(effects.begin(), effects.end(),
                     [](const Effect& e) { return e.covariate == "pass_index"; });
}

const std::vector<EffectForm>& effectLibrary() {
  static const std::vector<EffectForm> library = [] {
    std::vector<EffectForm> all;
    for (auto part : {detail::contactEffects, detail::diggingEffects, detail::forceEffects,
                      detail::sensorEffects, detail::driftEffects})
      for (EffectForm& form : part()) all.push_back(std::move(form));
    return all;
  }();
  return library;
}

const EffectForm* findEffect(std::string_view name) {
  static const std::unordered_map<std::string_view, const EffectForm*> by_name = [] {
    std::unordered_map<std::string_view, const EffectForm*> all;
    for (const EffectForm& form : effectLibrary()) all.emplace(form.name, &form);
    return all;
  }();
  for (const std::string_view word : {"moisture_", "temperature_"})  // prefixes in model files of version 0.1
    if (name.starts_with(word)) name.remove_prefix(word.size());
  const auto found = by_name.find(name);
  return found == by_name.end() ? nullptr : found->second;
}

}  // namespace talus::terramech
