/* Preloaded: call number IO_FAIL of write, fsync, rename and truncate on a regular file above descriptor 2 fails with the errno
   IO_ERRNO; with IO_ALL, each later call, too. With IO_LOG, each call is printed to stderr. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

static int fails(const char* call, int file) {
  static int count = 0;
  struct stat status;
  if (file >= 0 && (file <= 2 || fstat(file, &status) != 0 || !S_ISREG(status.st_mode))) return 0;
  ++count;
  if (getenv("IO_LOG")) dprintf(2, "%s\n", call);
  const char* number = getenv("IO_FAIL");
  const int chosen = number ? atoi(number) : 0;
  if (chosen == 0 || count < chosen || (count > chosen && !getenv("IO_ALL"))) return 0;
  errno = atoi(getenv("IO_ERRNO"));
  return 1;
}

#define WRAP(type, name, file, parameters, ...)                    \
  type name parameters {                                           \
    static type(*real) parameters;                                 \
    if (!real) real = (type(*) parameters)dlsym(RTLD_NEXT, #name); \
    return fails(#name, file) ? -1 : real(__VA_ARGS__);            \
  }
WRAP(ssize_t, write, file, (int file, const void* bytes, size_t size), file, bytes, size)
WRAP(ssize_t, writev, file, (int file, const struct iovec* parts, int count), file, parts, count)
WRAP(ssize_t, pwrite, file, (int file, const void* bytes, size_t size, off_t at), file, bytes, size, at)
WRAP(ssize_t, pwrite64, file, (int file, const void* bytes, size_t size, off64_t at), file, bytes, size, at)
WRAP(int, fsync, file, (int file), file)
WRAP(int, fdatasync, file, (int file), file)
WRAP(int, ftruncate, file, (int file, off_t size), file, size)
WRAP(int, ftruncate64, file, (int file, off64_t size), file, size)
WRAP(int, truncate, -1, (const char* path, off_t size), path, size)
WRAP(int, rename, -1, (const char* from, const char* to), from, to)
WRAP(int, renameat, -1, (int a, const char* from, int b, const char* to), a, from, b, to)
