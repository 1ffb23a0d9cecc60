// Preloaded into a program: one of its writes to regular files fails.
//   TOPPLE_FAILING_WRITE  which, from 1
//   TOPPLE_FAILURE        EIO: this one alone; ENOSPC: this one and all after it; short: half of it is written
// Everything that changes a file counts: write, pwrite, writev, fwrite, fclose, ftruncate, fsync, rename. What
// has no bytes to be short of is done when the failure is "short".
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <unistd.h>

enum Fate { goes_well, fails, is_short };

static enum Fate next_fate(void) {
  static atomic_long count;
  const char* const which = getenv("TOPPLE_FAILING_WRITE");
  const char* const failure = getenv("TOPPLE_FAILURE");
  if (!which || !failure) return goes_well;
  const long now = atomic_fetch_add(&count, 1) + 1, at = atol(which);
  const int full = strcmp(failure, "ENOSPC") == 0;
  if (now < at || (now > at && !full)) return goes_well;
  if (strcmp(failure, "short") == 0) return is_short;
  errno = full ? ENOSPC : EIO;
  return fails;
}

static enum Fate fate_of(int file) {
  struct stat status;
  const int saved = errno;
  const int counts = file > STDERR_FILENO && fstat(file, &status) == 0 && S_ISREG(status.st_mode);
  errno = saved;
  return counts ? next_fate() : goes_well;
}

#define REAL(name) (__extension__(__typeof__(&name)) dlsym(RTLD_NEXT, #name))

static size_t half(enum Fate fate, size_t size) {
  return fate == is_short && size > 1 ? size / 2 : size;
}

ssize_t write(int file, const void* bytes, size_t size) {
  const enum Fate fate = fate_of(file);
  return fate == fails ? -1 : REAL(write)(file, bytes, half(fate, size));
}

ssize_t pwrite(int file, const void* bytes, size_t size, off_t at) {
  const enum Fate fate = fate_of(file);
  return fate == fails ? -1 : REAL(pwrite)(file, bytes, half(fate, size), at);
}

ssize_t pwrite64(int file, const void* bytes, size_t size, off64_t at) {
  return pwrite(file, bytes, size, at);
}

ssize_t writev(int file, const struct iovec* parts, int count) {
  const enum Fate fate = fate_of(file);
  if (fate == is_short) return REAL(write)(file, parts[0].iov_base, half(fate, parts[0].iov_len));
  return fate == fails ? -1 : REAL(writev)(file, parts, count);
}

// Short counts of fwrite are errors: it goes on by itself.
size_t fwrite(const void* items, size_t size, size_t count, FILE* file) {
  return fate_of(fileno(file)) == fails ? 0 : REAL(fwrite)(items, size, count, file);
}

int fclose(FILE* file) {
  const int fate = fate_of(fileno(file)), why = errno;
  const int done = REAL(fclose)(file);
  if (fate != fails) return done;
  errno = why;
  return EOF;
}

int ftruncate(int file, off_t size) {
  return fate_of(file) == fails ? -1 : REAL(ftruncate)(file, size);
}

int ftruncate64(int file, off64_t size) {
  return ftruncate(file, size);
}

int fsync(int file) {
  return fate_of(file) == fails ? -1 : REAL(fsync)(file);
}

int rename(const char* from, const char* to) {
  return next_fate() == fails ? -1 : REAL(rename)(from, to);
}
