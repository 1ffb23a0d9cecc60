// What every live page has in common.
#pragma once

#include <string_view>

namespace topple::app {

/// HTML with @NAMES@ of what export_page.cpp fills in; empty when the program was built without emscripten.
std::string_view page_template();

}  // namespace topple::app
