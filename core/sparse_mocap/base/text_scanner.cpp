// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/base/text_scanner.hpp"

#include <algorithm>
#include <charconv>
#include <system_error>
#include <utility>

namespace sparse_mocap {
namespace {

constexpr std::string_view kUtf8Mark = "\xEF\xBB\xBF";

bool is_digit(char c) { return c >= '0' && c <= '9'; }

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

// Whether a well-formed decimal that does not fit a double is too small rather than too large,
// judging by the power of ten of its leading digit.
bool is_tiny(std::string_view text) {
  const auto exponent_at = text.find_first_of("eE");
  const auto mantissa = text.substr(0, exponent_at);
  const auto point = std::min(mantissa.find('.'), mantissa.size());
  const auto leading = mantissa.find_first_of("123456789");
  if (leading == std::string_view::npos) return true;
  const double places = static_cast<double>(point) - static_cast<double>(leading);
  if (exponent_at == std::string_view::npos) return places < 0;
  auto exponent_text = text.substr(exponent_at + 1);
  const bool is_negative = exponent_text.starts_with('-');
  if (is_negative || exponent_text.starts_with('+')) exponent_text.remove_prefix(1);
  double exponent = 0.0;
  for (const char digit : exponent_text) exponent = std::min(10.0 * exponent + (digit - '0'), 1e15);
  return places + (is_negative ? -exponent : exponent) < 0;
}

// Reads a number at the start of [begin, end). Returns the end of it, nullptr where there is none.
// std::from_chars alone would accept "nan" and "inf" and reject a leading '+'.
const char* parse_number_prefix(const char* begin, const char* end, double& value,
                                NumberStatus& status) {
  status = NumberStatus::malformed;
  const bool has_plus = begin != end && *begin == '+';
  if (has_plus) ++begin;
  const char* digits = begin;
  if (!has_plus && digits != end && *digits == '-') ++digits;
  if (digits == end || !(is_digit(*digits) || *digits == '.')) return nullptr;
  const auto [stop, error] = std::from_chars(begin, end, value);
  if (error == std::errc::invalid_argument) return nullptr;
  status = NumberStatus::ok;
  if (error == std::errc::result_out_of_range) {
    const bool tiny = is_tiny({begin, static_cast<std::size_t>(stop - begin)});
    if (tiny) value = 0.0;
    if (!tiny) status = NumberStatus::too_large;
  }
  return stop;
}

bool has_decimal_comma(std::string_view token) {
  const auto comma = token.find(',');
  if (comma == std::string_view::npos) return false;
  std::string with_point(token);
  with_point[comma] = '.';
  double ignored = 0.0;
  return parse_number(with_point, ignored) == NumberStatus::ok;
}

}  // namespace

NumberStatus parse_number(std::string_view text, double& value) {
  auto status = NumberStatus::malformed;
  const char* end = text.data() + text.size();
  const char* stop = parse_number_prefix(text.data(), end, value, status);
  return stop == end ? status : NumberStatus::malformed;
}

bool equal_ignoring_case(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, {}, lower, lower);
}

std::string lower_case(std::string_view text) {
  std::string result(text);
  std::ranges::transform(result, result.begin(), lower);
  return result;
}

std::string in_quotes(std::string_view token) {
  constexpr std::size_t kMaxShown = 60;
  constexpr std::string_view kHexDigits = "0123456789abcdef";
  std::string result = "\"";
  for (const char c : token.substr(0, kMaxShown)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte < 0x7F) {
      result += c;
    } else {
      result += {'\\', 'x', kHexDigits[byte >> 4], kHexDigits[byte & 0xF]};
    }
  }
  return result + (token.size() > kMaxShown ? "...\"" : "\"");
}

TextScanner::TextScanner(std::filesystem::path path, std::string text, Syntax syntax)
    : path_(std::move(path)), text_(std::move(text)), syntax_(syntax) {
  const auto classify = [&](std::string_view characters, Class character_class) {
    for (const char c : characters) classes_[static_cast<unsigned char>(c)] = character_class;
  };
  classify(" \t\v\f", kBlank);
  classify("\r\n", kNewline);
  classify(syntax.blanks, kBlank);
  classify(syntax.punctuation, kPunctuation);
  refuse_binary();
  begin_ = text_.data() + (text_.starts_with(kUtf8Mark) ? kUtf8Mark.size() : 0);
  end_ = text_.data() + text_.size();
  cursor_ = begin_;
  counted_line_begin_ = begin_;
}

void TextScanner::refuse_binary() const {
  if (text_.starts_with("\xFF\xFE") || text_.starts_with("\xFE\xFF"))
    throw FormatError({path_, 1, 1}, "is UTF-16 text", "save it as UTF-8");
  const auto nul = text_.find('\0');
  if (nul == std::string::npos) return;
  if (nul < 2 && text_.size() > 3 && text_[nul ^ 1U] != '\0' && text_[nul + 2] == '\0')
    throw FormatError({path_, 1, 1}, "is UTF-16 text", "save it as UTF-8");
  const auto line = 1 + std::count(text_.begin(), text_.begin() + static_cast<long>(nul), '\n');
  throw FormatError({path_, static_cast<int>(line), 0}, "holds a NUL byte, so it is not text",
                    "save it as text");
}

void TextScanner::skip_blanks_on_line() {
  while (cursor_ != end_ && class_of(*cursor_) == kBlank) ++cursor_;
  if (cursor_ == end_ || !is_comment(*cursor_)) return;
  while (cursor_ != end_ && class_of(*cursor_) != kNewline) ++cursor_;
}

void TextScanner::skip_blanks() {
  skip_blanks_on_line();
  while (cursor_ != end_ && class_of(*cursor_) == kNewline) {
    ++cursor_;
    skip_blanks_on_line();
  }
}

bool TextScanner::at_end() {
  skip_blanks();
  return cursor_ == end_;
}

bool TextScanner::at_line_end() {
  skip_blanks_on_line();
  return cursor_ == end_ || class_of(*cursor_) == kNewline;
}

std::string_view TextScanner::peek() {
  skip_blanks();
  const char* stop = cursor_;
  if (stop != end_ && class_of(*stop) == kPunctuation) return {cursor_, 1};
  while (stop != end_ && class_of(*stop) == kWord) ++stop;
  return {cursor_, static_cast<std::size_t>(stop - cursor_)};
}

std::string_view TextScanner::next() {
  const auto token = peek();
  cursor_ += token.size();
  return token;
}

std::string_view TextScanner::next_on_line() {
  if (at_line_end()) return here();
  return next();
}

std::string_view TextScanner::rest_of_line() {
  const char* begin = cursor_;
  while (cursor_ != end_ && class_of(*cursor_) != kNewline) ++cursor_;
  return {begin, static_cast<std::size_t>(cursor_ - begin)};
}

std::string_view TextScanner::next_until(std::string_view stop) {
  auto token = next_on_line();
  const auto length = token.find_first_of(stop);
  if (length == std::string_view::npos) return token;
  cursor_ = token.data() + length;
  return token.substr(0, length);
}

void TextScanner::skip_character(char c) {
  if (!at_line_end() && *cursor_ == c) ++cursor_;
}

bool TextScanner::starts_line(std::string_view token) const {
  const char* begin = token.data();
  while (begin != begin_ && class_of(begin[-1]) == kBlank) --begin;
  return begin == begin_ || class_of(begin[-1]) == kNewline;
}

double TextScanner::number(std::string_view what) { return number_or_fail(next(), what); }

double TextScanner::number_or_fail(std::string_view token, std::string_view what) const {
  double value = 0.0;
  const auto status = parse_number(token, value);
  if (status == NumberStatus::ok) return value;
  const std::string expected = "expected " + std::string(what) + ", ";
  if (token.empty())
    fail(token, expected + "but the file ends", "the file may be cut off; export it again");
  if (status == NumberStatus::too_large)
    fail(token, in_quotes(token) + " is too large", "check the number");
  const char* remedy = has_decimal_comma(token)
                           ? "it has a decimal comma; write numbers with a point"
                           : "write a decimal number such as -1.5";
  fail(token, expected + "got " + in_quotes(token), remedy);
}

std::size_t TextScanner::numbers_on_line(double* values, std::size_t max) {
  std::size_t count = 0;
  while (count < max && !at_line_end()) {
    auto status = NumberStatus::malformed;
    const char* stop = parse_number_prefix(cursor_, end_, values[count], status);
    const bool is_token = stop != nullptr && (stop == end_ || class_of(*stop) != kWord);
    if (!is_token || status != NumberStatus::ok) number_or_fail(peek(), "a number");
    cursor_ = stop;
    ++count;
  }
  return count;
}

FileLocation TextScanner::location(std::string_view token) const {
  if (token.data() < counted_line_begin_) {
    counted_line_begin_ = begin_;
    counted_lines_ = 1;
  }
  for (const char* c = counted_line_begin_; c != token.data(); ++c) {
    const bool ends_line = *c == '\n' || (*c == '\r' && (c + 1 == end_ || c[1] != '\n'));
    if (!ends_line) continue;
    counted_line_begin_ = c + 1;
    ++counted_lines_;
  }
  const auto is_character = [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; };
  const auto column = std::count_if(counted_line_begin_, token.data(), is_character);
  return {path_, counted_lines_, static_cast<int>(column) + 1};
}

void TextScanner::fail(std::string_view token, const std::string& problem,
                       const std::string& remedy) const {
  throw FormatError(location(token), problem, remedy);
}

}  // namespace sparse_mocap
