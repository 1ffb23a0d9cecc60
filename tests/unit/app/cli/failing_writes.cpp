// Preloaded into a program: one of its writes to regular files fails.
//   TOPPLE_FAILING_WRITE   which, from 1
//   TOPPLE_FAILURE         EIO: it alone; ENOSPC: it and all after it; short: half of it is written
//   TOPPLE_WRITES_COUNTED  a file that gets their number at the end
// Counted is what changes a file: write, pwrite, writev, fwrite, fclose, ftruncate, fsync, rename. Those that
// have no bytes to be short of are done when the failure is "short".
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

enum class Fate { goes_well, fails, is_short };

std::atomic<long> count{0};

Fate next_fate() {
  const char* const which = std::getenv("TOPPLE_FAILING_WRITE");
  const char* const failure = std::getenv("TOPPLE_FAILURE");
  if (!which || !failure) return Fate::goes_well;
  const long now = ++count, at = std::atol(which);
  const bool full = std::strcmp(failure, "ENOSPC") == 0;
  if (now < at || (now > at && !full)) return Fate::goes_well;
  if (std::strcmp(failure, "short") == 0) return Fate::is_short;
  errno = full ? ENOSPC : EIO;
  return Fate::fails;
}

Fate fate_of(int file) {
  struct stat status {};
  const int saved = errno;
  const bool counts = file > STDERR_FILENO && fstat(file, &status) == 0 && S_ISREG(status.st_mode);
  errno = saved;
  return counts ? next_fate() : Fate::goes_well;
}

[[gnu::destructor]] void tell_count() {
  const char* const file = std::getenv("TOPPLE_WRITES_COUNTED");
  const int out = file ? open(file, O_WRONLY | O_CREAT | O_TRUNC, 0600) : -1;
  if (out >= 0) dprintf(out, "%ld", count.load());
}

std::size_t part(Fate fate, std::size_t size) {
  return fate == Fate::is_short && size > 1 ? size / 2 : size;
}

/// The function that this one stands before.
template <typename Function>
Function* real(Function*, const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" {

ssize_t write(int file, const void* bytes, size_t size) {
  const Fate fate = fate_of(file);
  return fate == Fate::fails ? -1 : real(&write, "write")(file, bytes, part(fate, size));
}

ssize_t pwrite(int file, const void* bytes, size_t size, off_t at) {
  const Fate fate = fate_of(file);
  return fate == Fate::fails ? -1 : real(&pwrite, "pwrite")(file, bytes, part(fate, size), at);
}

ssize_t pwrite64(int file, const void* bytes, size_t size, off64_t at) {
  return pwrite(file, bytes, size, at);
}

ssize_t writev(int file, const iovec* parts, int count) {
  const Fate fate = fate_of(file);
  if (fate == Fate::is_short)
    return real(&write, "write")(file, parts[0].iov_base, part(fate, parts[0].iov_len));
  return fate == Fate::fails ? -1 : real(&writev, "writev")(file, parts, count);
}

// Short counts of fwrite are errors: it goes on by itself.
size_t fwrite(const void* items, size_t size, size_t count, FILE* file) {
  return fate_of(fileno(file)) == Fate::fails ? 0 : real(&fwrite, "fwrite")(items, size, count, file);
}

int fclose(FILE* file) {
  const Fate fate = fate_of(fileno(file));
  const int why = errno, done = real(&fclose, "fclose")(file);
  if (fate != Fate::fails) return done;
  errno = why;
  return EOF;
}

int ftruncate(int file, off_t size) noexcept {
  return fate_of(file) == Fate::fails ? -1 : real(&ftruncate, "ftruncate")(file, size);
}

int ftruncate64(int file, off64_t size) noexcept {
  return ftruncate(file, size);
}

int fsync(int file) {
  return fate_of(file) == Fate::fails ? -1 : real(&fsync, "fsync")(file);
}

int rename(const char* from, const char* to) noexcept {
  return next_fate() == Fate::fails ? -1 : real(&rename, "rename")(from, to);
}
}
