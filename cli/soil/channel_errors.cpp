#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <talus/cli/soil/channel_errors.hpp>

namespace talus::cli {

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

}  // namespace talus::cli
