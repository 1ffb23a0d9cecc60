// What of a scene will surprise, though nothing is wrong with it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/support/language.h"
#include "solver/run/run.h"

namespace topple::app {

/// One sentence each: what will happen, where, and what to try.
/// - An anchor in the middle of an edge that bends: it gives with the edge.
/// - A body that nothing bears when the run begins.
/// - soft_contact_warning() and bending_warning().
std::vector<std::string> scene_warnings(const Setup& setup);

/// Of contacts so soft that a side lifts at less than 95 % of the steady acceleration that lifts it on a
/// rigid floor; nothing: they are stiffer, or nothing moves. `parameters`: of the scene now.
std::optional<Said> soft_contact(const Setup& setup, const Parameters& parameters);
/// The same with what to do about it; empty where it says nothing.
std::string soft_contact_warning(const Setup& setup, const Parameters& parameters);

/// Of a room in which many bodies bend more than run.accuracy allows rigid ones to; empty: there are few.
std::string bending_warning(const Setup& setup);

}  // namespace topple::app
