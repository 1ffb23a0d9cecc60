// Which instructions the solver was compiled for.
#pragma once

namespace topple {

/// "x86-64-v3" (AVX2, FMA), "x86-64", "aarch64", or "generic". All compute the same bits.
const char* instruction_set();

}  // namespace topple
