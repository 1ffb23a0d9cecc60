#include "solver/io/document/toml_precheck.h"

#include <utf8.h>

#include <algorithm>
#include <string>
#include <utility>

#include "solver/math/ranges.h"

namespace topple::io {
namespace {

constexpr int k_most_dots = 500;
constexpr std::string_view k_byte_order_mark = "\xef\xbb\xbf";

constexpr const char* k_beyond_ascii = "a letter beyond ASCII stands in quotes, or in a comment";

bool is_beyond_ascii(char c) {
  return static_cast<unsigned char>(c) >= 0x80;
}

bool begins_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
         c == '"' || c == '\'';
}

class Scanner {
 public:
  explicit Scanner(std::string_view text)
      : text_(text),
        begin_(text.starts_with(k_byte_order_mark) ? k_byte_order_mark.size() : 0),
        at_(begin_) {}

  std::optional<TomlFault> find() {
    bool line_is_blank = true;  // so far
    int dots = 0;
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (is_beyond_ascii(c)) return fault(k_beyond_ascii);
      if (c == '#') {
        skip_comment();
        continue;
      }
      if (c == '"' || c == '\'') {
        if (auto found = skip_string(c)) return found;
        line_is_blank = false;
        continue;
      }
      if (c == '[' && line_is_blank && open_.empty()) {
        if (auto nameless = skip_header_start()) return nameless;
        line_is_blank = false;
        continue;
      }
      if (in_value_ && !at_any_of(" \t\r\n,[]{}")) {
        if (auto found = skip_bare_value()) return found;
        continue;
      }
      if (c == '.' && ++dots > k_most_dots) return fault("keys nested too deeply");
      if (c == ',' || c == '=' || c == '\n') dots = 0;
      if (c == '[' || c == '{') open_ += c;
      if ((c == ']' || c == '}') && !open_.empty()) open_.pop_back();
      if (c == '=' || c == '[' || c == ']' || c == '}') in_value_ = true;
      if (c == '{' || (c == ',' && open_.ends_with('{')) || (c == '\n' && open_.empty())) in_value_ = false;
      if (c == '\n') {
        line_is_blank = true;
      } else if (c != ' ' && c != '\t' && c != '\r') {
        line_is_blank = false;
      }
      ++at_;
    }
    return std::nullopt;
  }

 private:
  bool at_any_of(std::string_view characters) const {
    return at_ < text_.size() && characters.find(text_[at_]) != characters.npos;
  }

  void skip_comment() {
    while (at_ < text_.size() && text_[at_] != '\n') ++at_;
  }

  // A number, date or word. The parser takes quotes and brackets within for letters of it, and with them what
  // follows, as far as a blank: a letter beyond ASCII too.
  std::optional<TomlFault> skip_bare_value() {
    for (; at_ < text_.size() && !at_any_of(" \t\r\n\v\f,]}#"); ++at_) {
      if (is_beyond_ascii(text_[at_])) return fault(k_beyond_ascii);
      if (at_any_of("\"'[{=")) return fault("a quote, bracket or = within a value");
    }
    while (at_any_of("\v\f")) ++at_;
    return std::nullopt;
  }

  // A string that is not closed ends with its line, or, when of several lines, with the text.
  std::optional<TomlFault> skip_string(char quote) {
    const std::string triple(3, quote);
    const bool several_lines = text_.substr(at_).starts_with(triple);
    at_ += several_lines ? 3 : 1;
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (!several_lines && c == '\n') return std::nullopt;
      if (c == '\\' && quote == '"') {
        ++at_;
        const std::size_t escaped = at_;
        while (several_lines && at_any_of(" \t\r\n\v\f")) ++at_;
        if (several_lines && at_ < text_.size() && is_beyond_ascii(text_[at_]))
          return fault("a letter beyond ASCII begins what follows a \\ in a text of several lines");
        if (at_ == escaped) ++at_;
      } else if (c != quote) {
        ++at_;
      } else if (!several_lines) {
        ++at_;
        return std::nullopt;
      } else if (text_.substr(at_).starts_with(triple)) {
        at_ += 3;
        for (int more = 0; more < 2 && at_any_of(std::string_view(&quote, 1)); ++more) ++at_;
        return std::nullopt;
      } else {
        ++at_;
      }
    }
    at_ = text_.size();
    return std::nullopt;
  }

  // "[" or "[[" and the blanks behind; a fault when no name follows. A text that ends here, or an empty name,
  // is refused by the parser in its own words.
  std::optional<TomlFault> skip_header_start() {
    ++at_;
    if (at_any_of("[")) ++at_;
    while (at_any_of(" \t")) ++at_;
    if (at_ == text_.size() || at_any_of("][") || begins_name(text_[at_])) return std::nullopt;
    if (is_beyond_ascii(text_[at_])) return std::nullopt;  // found as such
    return fault("expected a table's name");
  }

  TomlFault fault(std::string message) const {
    TomlFault result{at_, 1, 1, std::move(message)};
    const std::string_view before = text_.substr(begin_, at_ - begin_);
    result.line += static_cast<int>(ranges::count(before, '\n'));
    const std::string line = utf8::replace_invalid(before.substr(before.rfind('\n') + 1));
    result.column += static_cast<int>(utf8::distance(line.begin(), line.end()));
    return result;
  }

  std::string_view text_;
  std::size_t begin_;  // behind a byte order mark
  std::size_t at_;
  std::string open_;       // brackets and braces
  bool in_value_ = false;  // not in a key
};

}  // namespace

std::optional<TomlFault> find_toml_fault(std::string_view text) {
  return Scanner(text).find();
}

}  // namespace topple::io
