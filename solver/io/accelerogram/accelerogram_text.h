// What readers of accelerograms share: lines with numbers, how texts and numbers are read and judged.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "solver/io/accelerogram/accelerogram_content.h"
#include "solver/io/common/errors.h"

namespace topple::io::accelerogram {

/// The text from line to line.
class Lines {
 public:
  Lines(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  bool next() {
    if (begin_ >= text_.size()) return false;
    const auto end = std::min(text_.find('\n', begin_), text_.size());
    line_ = text_.substr(begin_, end - begin_);
    if (line_.ends_with('\r')) line_.remove_suffix(1);
    begin_ = end + 1;
    ++number_;
    return true;
  }
  std::string_view line() const { return line_; }
  int number() const { return number_; }
  std::size_t bytes_left() const { return text_.size() - std::min(begin_, text_.size()); }

  /// Throws InputError "NAME:LINE: MESSAGE".
  [[noreturn]] void fail(const std::string& message) const { fail_at(number_, message); }
  [[noreturn]] void fail_at(int number, const std::string& message) const {
    throw InputError(name_ + ":" + std::to_string(number) + ": " + message);
  }

 private:
  std::string_view text_;
  const std::string& name_;
  std::size_t begin_ = 0;
  std::string_view line_;
  int number_ = 0;
};

/// Without blanks at both ends.
std::string_view trimmed(std::string_view text);
std::string upper(std::string_view text);
/// In quotes, for a message: at most 40 characters, those beyond ASCII as "?".
std::string shown(std::string_view text);
/// A whole number, of more than 15 digits as a power of ten.
std::string count_text(double count);

/// Nothing when it is no number; infinity when it is too large for one.
std::optional<double> number_in(std::string_view text);
/// The finite number at the begin of `text`, taken off it; else nothing, and nothing is taken off.
std::optional<double> take_number(std::string_view& text);
/// Fails where the text is none, with `what` before what was found.
double finite_number(std::string_view text, const Lines& lines, const std::string& what);

// The limits of accelerogram_content.h. They fail, with `key` before what was found.
void check_count(const Lines& lines, const std::string& key, double count);
void check_interval(const Lines& lines, int line, const std::string& key, double interval);
/// `size`: in `unit`. Fails above k_highest_peak, where the unit is taken to be wrong.
void check_peak(const Lines& lines, int line, double size, std::string_view unit);

/// "known: g, gal, ...": k_sample_units, for a message.
std::string known_units();

/// The symbol of a unit as files spell it; empty when it is none that is known.
std::string_view acceleration_unit(std::string_view text);
/// The symbol that the file states (empty: nothing) or the scene says. Fails when neither does, or they
/// differ.
std::string_view chosen_unit(const Lines& lines, std::string_view stated, const AccelerogramNotes& notes);

/// The largest |number| as it stands in the file, and its line.
struct Largest {
  double size = 0;
  int line = 0;
  void update(double value, int number) {
    if (std::abs(value) > size) {
      size = std::abs(value);
      line = number;
    }
  }
};

/// The numbers on the lines that are left, the first `count` of them as samples; returns how many there are.
/// Calls each(value, text) for every one. Fails at what is no finite number.
template <class Each>
double read_samples(Lines& lines, double count, std::vector<double>& samples, Each each) {
  samples.reserve(std::min(static_cast<std::size_t>(count), lines.bytes_left()));
  double found = 0;
  while (lines.next()) {
    for (std::string_view rest = trimmed(lines.line()); !rest.empty(); rest = trimmed(rest)) {
      const std::string_view text = rest.substr(0, rest.find_first_of(" \t"));
      const double value = finite_number(text, lines, "");
      each(value, text);
      rest.remove_prefix(text.size());
      if (++found <= count) samples.push_back(value);
    }
  }
  return found;
}

/// `factor`: SI value of one unit.
void to_si(std::vector<double>& values, double factor);

/// Whether the text is CSV.
bool is_csv(std::string_view text, const std::string& name, const AccelerogramNotes& notes);
AccelerogramFile read_csv(std::string_view text, const std::string& name, const AccelerogramNotes& notes);

}  // namespace topple::io::accelerogram
