// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/base/errors.hpp"

#include <utility>

namespace sparse_mocap {
namespace {

std::string one_line(const FileLocation& location, const std::string& problem,
                     const std::string& remedy) {
  std::string text = location.path.string();
  if (location.line > 0) text += ":" + std::to_string(location.line);
  if (location.line > 0 && location.column > 0) text += ":" + std::to_string(location.column);
  if (!text.empty()) text += ": ";
  text += problem;
  if (!remedy.empty()) text += "; " + remedy;
  // Names in files and of files may hold anything.
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = '?';
  return text;
}

}  // namespace

FormatError::FormatError(FileLocation location, const std::string& problem,
                         const std::string& remedy)
    : std::runtime_error(one_line(location, problem, remedy)), location_(std::move(location)) {}

}  // namespace sparse_mocap
