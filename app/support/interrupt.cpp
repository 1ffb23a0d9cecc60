#include "app/support/interrupt.h"

#include <unistd.h>

#include <csignal>

#include "app/support/errors.h"

namespace topple::app {
namespace {

volatile std::sig_atomic_t g_deferred = 0, g_interrupted = 0;

void on_signal(int signal) {
  if (!g_deferred) _exit(k_interrupted);
  g_interrupted = 1;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void catch_interrupts() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  std::signal(SIGXFSZ, SIG_IGN);
}

void defer_interrupts() {
  g_deferred = 1;
}

bool interrupted() {
  return g_interrupted != 0;
}

}  // namespace topple::app
