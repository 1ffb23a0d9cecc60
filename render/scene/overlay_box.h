// Places of the parts of an overlay.
#pragma once

#include <string>

namespace topple::render {

/// Where a part of the overlay lies, px from the upper left corner of the picture.
struct OverlayBox {
  std::string name;  ///< "title", "lines", "legend", "trace", "note"
  float left, top, right, bottom;
};

}  // namespace topple::render
