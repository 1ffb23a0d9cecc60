#include <cstdio>

#include "app/cli/command_line.h"

int main(int argc, char** argv) {
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) {
    std::fputs("topple: this build needs a processor with AVX2 (x86-64-v3)\n", stderr);
    return 1;
  }
  return topple::app::run_command_line(argc, argv);
}
