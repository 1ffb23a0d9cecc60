// Many pictures drawn by several processes: within one, software draws in one thread (render/gl/llvmpipe.h).
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

namespace topple::app {

/// Draws a picture and answers with what the process that asked for it needs to know, such as its bytes.
using DrawPicture = std::function<std::vector<std::uint8_t>(int number)>;

/// Draws the pictures 0 to count - 1, in as many processes as there are cores when they are many, and hands
/// the answers to `take` in order, in this process. `open` is called once in each process that draws. No
/// thread but the caller's may run. Ends early when interrupted (interrupt.h), and with std::runtime_error
/// where a process that draws threw or was killed.
void draw_pictures(int count, const std::function<DrawPicture()>& open,
                   const std::function<void(int number, std::vector<std::uint8_t> answer)>& take);

}  // namespace topple::app
