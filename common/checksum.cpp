// Compiles xxHash into this source file alone, so that no xxHash library needs to be linked.
#define XXH_INLINE_ALL
#include <xxhash.h>

#include <talus/common/checksum.hpp>

namespace talus {

struct Checksum::State {
  XXH3_state_t hash;
};

Checksum::Checksum() : state_(std::make_unique<State>()) {
  XXH3_64bits_reset(&state_->hash);
}

Checksum::~Checksum() = default;
Checksum::Checksum(Checksum&&) noexcept = default;
Checksum& Checksum::operator=(Checksum&&) noexcept = default;

void Checksum::add(const void* data, std::size_t size) noexcept {
  XXH3_64bits_update(&state_->hash, data, size);
}

std::uint64_t Checksum::value() const noexcept {
  return XXH3_64bits_digest(&state_->hash);
}

}  // namespace talus
