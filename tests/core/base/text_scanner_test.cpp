// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/base/text_scanner.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

namespace sparse_mocap {
namespace {

using namespace std::string_literals;

NumberStatus status_of(std::string_view text) {
  double ignored = 0.0;
  return parse_number(text, ignored);
}

double number_in(std::string_view text) {
  double value = 12345.0;
  EXPECT_EQ(parse_number(text, value), NumberStatus::ok) << text;
  return value;
}

std::vector<std::string> tokens_of(const std::string& text, TextScanner::Syntax syntax) {
  TextScanner scanner("file", text, syntax);
  std::vector<std::string> tokens;
  while (!scanner.at_end()) tokens.emplace_back(scanner.next());
  return tokens;
}

// The line and column that the scanner gives the last token of the text.
std::array<int, 2> place_of_last(const std::string& text) {
  TextScanner scanner("file", text, {});
  std::string_view last;
  while (!scanner.at_end()) last = scanner.next();
  const auto location = scanner.location(last);
  return {location.line, location.column};
}

std::string error_of(const std::string& text) {
  try {
    TextScanner scanner("walk.bvh", text, {});
    std::array<double, 8> values{};
    while (!scanner.at_end()) scanner.numbers_on_line(values.data(), values.size());
  } catch (const FormatError& error) {
    return error.what();
  }
  return "no error";
}

TEST(ParseNumber, RefusesWhatIsNoFiniteDecimal) {
  for (const char* text :
       {"",     "+",    "-",        ".",    "e5",  "nan",   "NaN",     "-nan",    "inf",
        "-inf", "+inf", "infinity", "0x1A", "--5", "+-5",   "-+5",     "++5",     "1,5",
        "1.5x", "1e",   "1e+",      "1 ",   " 1",  "1.2.3", "-1.#IND", "1.#QNAN", "\xB2"})
    EXPECT_EQ(status_of(text), NumberStatus::malformed) << text;
  EXPECT_EQ(status_of("1e400"), NumberStatus::too_large);
  EXPECT_EQ(status_of("-1e400"), NumberStatus::too_large);
  EXPECT_EQ(status_of(std::string(400, '9')), NumberStatus::too_large);
  EXPECT_EQ(status_of("1e99999999999999999999"), NumberStatus::too_large);
}

TEST(ParseNumber, ReadsEveryFormThatExportersWrite) {
  EXPECT_EQ(number_in("12"), 12.0);
  EXPECT_EQ(number_in("+1.5"), 1.5);
  EXPECT_EQ(number_in("-.5"), -0.5);
  EXPECT_EQ(number_in("+.5"), 0.5);
  EXPECT_EQ(number_in("5."), 5.0);
  EXPECT_EQ(number_in("007"), 7.0);
  EXPECT_EQ(number_in("6e-014"), 6e-14);
  EXPECT_EQ(number_in("1E+003"), 1000.0);
  EXPECT_EQ(number_in("0.1"), 0.1);
  EXPECT_EQ(number_in("8.3333333333333332e-3"), 1.0 / 120.0);
}

TEST(ParseNumber, TakesWhatIsTooSmallForADoubleAsZero) {
  EXPECT_EQ(number_in("1e-400"), 0.0);
  EXPECT_EQ(number_in("-123.4e-5000"), 0.0);
  EXPECT_EQ(number_in("0." + std::string(400, '0') + "1"), 0.0);
  EXPECT_EQ(number_in("0e99999"), 0.0);
  EXPECT_EQ(number_in("1e-99999999999999999999"), 0.0);
}

TEST(TextScanner, SplitsAtBlanksPunctuationAndComments) {
  EXPECT_EQ(tokens_of("JOINT a{OFFSET\t1}", {.punctuation = "{}"}),
            (std::vector<std::string>{"JOINT", "a", "{", "OFFSET", "1", "}"}));
  EXPECT_EQ(tokens_of("a (1, 2) # b c\n#d\ne#f", {.blanks = ",()", .comment = '#'}),
            (std::vector<std::string>{"a", "1", "2", "e#f"}));
  EXPECT_EQ(tokens_of(" \n\t\r\n", {}), std::vector<std::string>{});
  EXPECT_EQ(tokens_of("\xEF\xBB\xBFHIERARCHY", {}), std::vector<std::string>{"HIERARCHY"});
}

TEST(TextScanner, CountsLinesAndColumnsForEveryLineEnd) {
  EXPECT_EQ(place_of_last("a\nb\n  c"), (std::array{3, 3}));
  EXPECT_EQ(place_of_last("a\r\nb\r\n  c"), (std::array{3, 3}));
  EXPECT_EQ(place_of_last("a\rb\r  c"), (std::array{3, 3}));
  EXPECT_EQ(place_of_last("a\n\n\nb"), (std::array{4, 1}));
  EXPECT_EQ(place_of_last("\xEF\xBB\xBFx"), (std::array{1, 1}));
  EXPECT_EQ(place_of_last("\xC3\xA4 x"), (std::array{1, 3})) << "characters, not bytes";
}

TEST(TextScanner, FindsAPlaceBeforeTheOneAskedLast) {
  TextScanner scanner("file", "a\nb\nc", {});
  const auto a = scanner.next();
  scanner.next();
  const auto c = scanner.next();
  EXPECT_EQ(scanner.location(c).line, 3);
  EXPECT_EQ(scanner.location(a).line, 1);
  EXPECT_EQ(scanner.location(c).line, 3);
}

TEST(TextScanner, ReadsLineByLine) {
  TextScanner scanner("file", "1 2 3\n\n 4 x", {});
  std::array<double, 4> values{};
  EXPECT_EQ(scanner.numbers_on_line(values.data(), 2), 2U);
  EXPECT_FALSE(scanner.at_line_end());
  EXPECT_EQ(scanner.numbers_on_line(values.data(), 4), 1U);
  EXPECT_EQ(values[0], 3.0);
  EXPECT_TRUE(scanner.at_line_end());
  EXPECT_TRUE(scanner.next_on_line().empty());
  EXPECT_FALSE(scanner.at_end());
  EXPECT_TRUE(scanner.starts_line(scanner.peek()));
  EXPECT_EQ(scanner.next(), "4");
  EXPECT_FALSE(scanner.starts_line(scanner.peek()));
  EXPECT_EQ(scanner.rest_of_line(), "x");
  EXPECT_TRUE(scanner.at_end());
  EXPECT_TRUE(scanner.next().empty());
}

TEST(TextScanner, SaysWhereAndWhatIsWrongWithANumber) {
  EXPECT_EQ(error_of("1 2\n3 x"),
            "walk.bvh:2:3: expected a number, got \"x\"; write a decimal number such as -1.5");
  EXPECT_EQ(error_of("1\n2 1,5"),
            "walk.bvh:2:3: expected a number, got \"1,5\"; it has a decimal comma; write numbers "
            "with a point");
  EXPECT_EQ(error_of("1e400"), "walk.bvh:1:1: \"1e400\" is too large; check the number");
  EXPECT_EQ(error_of("nan"),
            "walk.bvh:1:1: expected a number, got \"nan\"; write a decimal number such as -1.5");
  EXPECT_EQ(
      error_of("\x01\xFF"),
      "walk.bvh:1:1: expected a number, got \"\\x01\\xff\"; write a decimal number such as -1.5");
  EXPECT_EQ(error_of("1e-400 +1.5"), "no error");
}

TEST(TextScanner, RefusesWhatIsNotText) {
  EXPECT_EQ(error_of("\xFF\xFE"s), "walk.bvh:1:1: is UTF-16 text; save it as UTF-8");
  EXPECT_EQ(error_of("\xFE\xFF\0H"s), "walk.bvh:1:1: is UTF-16 text; save it as UTF-8");
  EXPECT_EQ(error_of("H\0I\0"s), "walk.bvh:1:1: is UTF-16 text; save it as UTF-8");
  EXPECT_EQ(error_of("\0H\0I"s), "walk.bvh:1:1: is UTF-16 text; save it as UTF-8");
  EXPECT_EQ(error_of("a\nb\0c"s),
            "walk.bvh:2: holds a NUL byte, so it is not text; save it as text");
  EXPECT_EQ(error_of("\0"s), "walk.bvh:1: holds a NUL byte, so it is not text; save it as text");
}

TEST(InQuotes, ShortensAndEscapes) {
  EXPECT_EQ(in_quotes("a\tb"), "\"a\\x09b\"");
  EXPECT_EQ(in_quotes(std::string(100, 'a')), "\"" + std::string(60, 'a') + "...\"");
}

TEST(EqualIgnoringCase, ComparesAsciiLetters) {
  EXPECT_TRUE(equal_ignoring_case("End", "eND"));
  EXPECT_FALSE(equal_ignoring_case("End", "Ends"));
  EXPECT_EQ(lower_case("LeftARM_1"), "leftarm_1");
}

}  // namespace
}  // namespace sparse_mocap
