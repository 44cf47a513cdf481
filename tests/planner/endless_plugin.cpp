#include <cstdlib>

#include <unistd.h>

// A library that never ends being loaded or, by TALUS_WHEN, unloaded. It tells by a byte to the descriptor that the
// environment names, if it does.
__attribute__((TALUS_WHEN)) static void waitForEver() {
  if (const char* descriptor = std::getenv("TALUS_ENDLESS_PLUGIN"))
    if (write(std::atoi(descriptor), "w", 1) != 1) return;
  for (;;) pause();
}
