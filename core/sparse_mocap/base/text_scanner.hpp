// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "sparse_mocap/base/errors.hpp"

namespace sparse_mocap {

enum class NumberStatus { ok, malformed, too_large };

// Reads all of text as a finite decimal number, whatever the locale: 12, -.5, +1.5, 6e-014. What is
// too small for a double is 0. NaN, infinities, hexadecimals and decimal commas are malformed.
NumberStatus parse_number(std::string_view text, double& value);

// Whether two texts are the same but for the case of their ASCII letters.
bool equal_ignoring_case(std::string_view a, std::string_view b);
std::string lower_case(std::string_view text);

// Walks over the tokens of a text file and knows the line and column of each.
//
// A token is a string_view into the text: it stays valid as long as the scanner does and its
// address tells where it stands. Where the text or the line ends, the token is empty.
class TextScanner {
 public:
  struct Syntax {
    std::string_view blanks = "";       // separate tokens, like space and tab
    std::string_view punctuation = "";  // each is a token of its own
    char comment = '\0';                // at the start of a token: ignore the rest of the line
  };

  // Skips a UTF-8 byte order mark. Throws FormatError on UTF-16 and on NUL bytes.
  TextScanner(std::filesystem::path path, std::string text, Syntax syntax);
  TextScanner(const TextScanner&) = delete;
  TextScanner& operator=(const TextScanner&) = delete;

  // Whether nothing but blanks and comments follows: in the text, on this line.
  bool at_end();
  bool at_line_end();

  std::string_view peek();
  std::string_view next();
  std::string_view next_on_line();
  // What follows on this line, without the line end; the next token is on the next line.
  std::string_view rest_of_line();
  // Takes what follows on this line up to the next blank or one of the characters of stop.
  std::string_view next_until(std::string_view stop);
  // Takes the character if it comes next on this line.
  void skip_character(char c);
  // The empty token where the scanner stands, as a place for errors.
  std::string_view here() const { return std::string_view(cursor_, end_).substr(0, 0); }
  bool starts_line(std::string_view token) const;

  // The next token as a number; what names it in the error ("3 numbers after OFFSET").
  double number(std::string_view what);
  // Numbers until the line ends, at most max. Returns how many.
  std::size_t numbers_on_line(double* values, std::size_t max);

  const std::filesystem::path& path() const { return path_; }
  std::size_t bytes_left() const { return static_cast<std::size_t>(end_ - cursor_); }
  // Where a token of this scanner stands.
  FileLocation location(std::string_view token) const;
  // Throws FormatError located at a token of this scanner.
  [[noreturn]] void fail(std::string_view token, const std::string& problem,
                         const std::string& remedy = "") const;

 private:
  enum Class : unsigned char { kWord = 0, kBlank = 1, kNewline = 2, kPunctuation = 4 };

  Class class_of(char c) const { return classes_[static_cast<unsigned char>(c)]; }
  bool is_comment(char c) const { return syntax_.comment != '\0' && c == syntax_.comment; }
  void refuse_binary() const;
  void skip_blanks_on_line();
  void skip_blanks();
  double number_or_fail(std::string_view token, std::string_view what) const;

  std::filesystem::path path_;
  std::string text_;
  Syntax syntax_;
  std::array<Class, 256> classes_{};
  const char* begin_ = nullptr;
  const char* cursor_ = nullptr;
  const char* end_ = nullptr;
  // Where location() stopped counting lines last: places are mostly asked for in rising order.
  mutable const char* counted_line_begin_ = nullptr;
  mutable int counted_lines_ = 1;
};

// The token in quotes, shortened and with unprintable bytes escaped, for error messages.
std::string in_quotes(std::string_view token);

}  // namespace sparse_mocap
