#include <cstdlib>

#include <unistd.h>

// A library whose loading or, by TALUS_WHEN, unloading never ends. The library writes a byte to the
// descriptor that the environment variable TALUS_ENDLESS_PLUGIN names, if any.
__attribute__((TALUS_WHEN)) static void waitForEver() {
  if (const char* descriptor = std::getenv("TALUS_ENDLESS_PLUGIN"))
    if (write(std::atoi(descriptor), "w", 1) != 1) return;
  for (;;) pause();
}
