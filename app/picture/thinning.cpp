#include "app/picture/thinning.h"

#include "solver/io/recording/recording_format.h"

namespace topple::app {

std::size_t memory_of(const io::FrameRow& row) {
  std::size_t bytes = sizeof row;
  for (const auto field : io::field_bytes(row)) bytes += field.size();
  return bytes;
}

}  // namespace topple::app
