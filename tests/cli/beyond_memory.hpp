#pragma once

namespace talus::cli {

/// Message about a plugin that exceeds the memory limit. The allocator of a sanitizer ends the process
/// instead.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr const char* kBeyondMemory = "ended its process";
#else
inline constexpr const char* kBeyondMemory = "takes more than 4096 MB of memory";
#endif

}  // namespace talus::cli
