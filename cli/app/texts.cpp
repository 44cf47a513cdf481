#include <map>
#include <vector>

#include <yaml-cpp/yaml.h>

#include <talus/cli/app/texts.hpp>

// Embeds the bytes of the file and a null character in the read-only data.
asm(R"(
  .section .rodata
  talus_texts: .incbin ")" TALUS_TEXTS R"("
  .byte 0
  .global talus_texts
  .text
)");

extern "C" {
// NOLINTNEXTLINE(readability-identifier-naming)
extern const char talus_texts[];
}

namespace talus::cli {

const YAML::Node& texts() {
  static const YAML::Node all = YAML::Load(talus_texts);
  return all;
}

std::span<const terramech::FileKey> keysOf(const std::string& format) {
  using Keys = std::vector<terramech::FileKey>;
  static const std::map<std::string, Keys> all = [] {
    std::map<std::string, Keys> made;
    for (const YAML::Node& one : texts()["formats"])
      for (const auto& key : one["keys"])
        made[one["title"].as<std::string>()].push_back(
            {key.first.Scalar().c_str(), key.second.Scalar().c_str()});
    return made;
  }();
  return all.at(format);
}

}  // namespace talus::cli
