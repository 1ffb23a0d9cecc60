// Any bytes are an accelerogram with samples that can be, or refused with one line. The first byte says what
// the scene notes.
#include <cmath>
#include <string_view>

#include "fuzz.h"
#include "solver/io/accelerogram/accelerogram_file.h"
#include "solver/io/scene/scene.h"
#include "solver/math/types.h"

using namespace topple;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  io::AccelerogramNotes notes;
  if (data[0] & 1) notes.unit = data[0] & 2 ? "gal" : "m/s^2";
  if (data[0] & 4) notes.interval = data[0] & 8 ? 0.01 : 0.005;
  const std::string_view bytes(reinterpret_cast<const char*>(data + 1), size - 1);
  try {
    const io::AccelerogramFile file = io::read_accelerogram(bytes, "a.csv", notes);
    promise(file.interval >= io::k_shortest_interval && file.interval <= io::k_longest_interval,
            "samples are some time apart", std::to_string(file.interval));
    promise(!file.components.empty() && file.components.size() <= 3, "there are one to three components");
    for (const std::vector<double>& component : file.components) {
      promise(component.size() >= 2, "a component has two samples or more");
      for (const double a : component)
        promise(std::abs(a) <= 2 * io::k_highest_peak * k_standard_gravity, "a sample can be",
                std::to_string(a));
    }
  } catch (const io::InputError& error) {
    promise_one_line(error.what());
  }
  return 0;
}
