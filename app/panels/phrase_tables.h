// Every text that the window can show.
#pragma once

#include <string>

namespace topple::app {

/// The tables of phrases (app/*_words.h) as they are written.
std::string phrase_tables();

}  // namespace topple::app
