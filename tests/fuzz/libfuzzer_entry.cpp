// libFuzzer's entry to the targets of one module, TALUS_FUZZ_MODULE: without a name in TALUS_FUZZ_TARGET it prints them; the
// seeds of the one that is named are written into the folder TALUS_FUZZ_SEEDS first.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "targets.hpp"

namespace {

const talus::fuzz::Target& target() {
  static const talus::fuzz::Target found = [] {
    const char* name = std::getenv("TALUS_FUZZ_TARGET");
    for (const talus::fuzz::Target& one : talus::fuzz::TALUS_FUZZ_MODULE())
      if (name != nullptr && one.name == name) return one;
    for (const talus::fuzz::Target& one : talus::fuzz::TALUS_FUZZ_MODULE()) std::puts(one.name.c_str());
    std::exit(name == nullptr ? 0 : 2);
  }();
  return found;
}

}  // namespace

// GDAL keeps its drivers until the process ends.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libgdal\n";
}

extern "C" int LLVMFuzzerInitialize(int* count, char*** words);
extern "C" int LLVMFuzzerInitialize(int*, char***) {
  talus::fuzz::limitMemory();
  const talus::fuzz::Target& chosen = target();
  int number = 0;
  if (const char* folder = std::getenv("TALUS_FUZZ_SEEDS"); folder != nullptr)
    for (const auto* seeds : {&chosen.seeds, &chosen.refused_seeds})
      for (const std::string& seed : *seeds)
        std::ofstream(std::string(folder) + "/seed" + std::to_string(number++), std::ios::binary) << seed;
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  talus::fuzz::accepts(target(), std::string(reinterpret_cast<const char*>(data), size));
  return 0;
}
