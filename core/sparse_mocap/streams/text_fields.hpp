// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>
#include <vector>

#include "sparse_mocap/streams/stream_parser.hpp"

namespace sparse_mocap::streams {

// The line's bytes as text without the '\r' before its end.
inline std::string_view text_of(ByteView line) {
  std::string_view text(reinterpret_cast<const char*>(line.data()), line.size());
  if (text.ends_with('\r')) text.remove_suffix(1);
  return text;
}

// The fields between separators, without the blanks around them; ' ' stands for any run of blanks.
std::vector<std::string_view> split_fields(std::string_view text, char separator);

// Appends a number the way devices print it, whatever the locale.
void append_number(Bytes& out, double value, int decimals);
void append_text(Bytes& out, std::string_view text);

}  // namespace sparse_mocap::streams
