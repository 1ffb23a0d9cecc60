// One key of a scene file.
#pragma once

#include <limits>
#include <string_view>
#include <vector>

#include "solver/io/common/units.h"

namespace topple::io {

enum class KeyType {
  number,  ///< a quantity
  integer,
  boolean,
  text,
  texts,     ///< a list of 1 to `count` texts
  choice,    ///< one of `choices`
  choices,   ///< a list of some of `choices`
  numbers,   ///< a list of `count` quantities
  vectors,   ///< a list of lists of three quantities
  integers,  ///< a list of `count` integers
  history,   ///< a list of [time, factor]
  table,     ///< [key]
  tables,    ///< [[key]], or a list of inline tables
};

/// One key. Values are in SI.
struct Key {
  std::string_view table = {};  ///< "contact"; "" at the top; "frame.members" within
  std::string_view name = {};
  KeyType type = KeyType::number;
  Dimension dimension = Dimension::none;
  std::string_view unit = {};  ///< in which the reference, errors and sliders show it; empty: SI
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  int count = 0;        ///< entries of a list, see KeyType; least_count is fewer when some may be left out
  int least_count = 0;  ///< 0: exactly `count`; 1: a bare number is accepted too
  std::vector<double> fallback = {};  ///< the default: values, index of the choice, 0 or 1; empty: none
  std::string_view otherwise = {};    ///< what an absent key means when that is no value
  bool required = false;              ///< when its choice was made
  std::vector<std::string_view> choices = {};   ///< also words that a number or numbers may be replaced by
  std::vector<int> numbers = {};                ///< of the choices, as edits and recordings hold them
  std::string_view of = {};                     ///< the key whose choice it belongs to
  std::vector<std::string_view> when = {};      ///< the choices of `of` that it belongs to
  std::vector<std::string_view> analyses = {};  ///< of run.analysis that it belongs to; empty: all
  std::string_view about = {};                  ///< its meaning, for the reference
};

}  // namespace topple::io
