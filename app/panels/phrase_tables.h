// Every text that the window can show.
#pragma once

#include <string>

namespace topple::app {

/// The tables of phrases (*_words.h, without those of reports) as they are written.
std::string phrase_tables();

}  // namespace topple::app
