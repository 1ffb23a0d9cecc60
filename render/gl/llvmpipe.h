// Mesa's software renderer.
#pragma once

#include <cstdlib>

namespace topple::render {

/// To be called before its library is loaded: it draws in the thread that calls it, unless LP_NUM_THREADS
/// says otherwise. Its own threads tell that they are done inside a lock, which the thread that waits reads
/// past and may free before they have left it (lp_fence_signal and lp_fence_signalled of Mesa 22.3): hours of
/// drawing on busy cores end in a broken heap.
inline void keep_to_one_thread() {
  setenv("LP_NUM_THREADS", "0", 0);
}

}  // namespace topple::render
