// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

namespace sparse_mocap {

// A place in a text file; line and column count from 1, 0 means "the file as a whole".
struct FileLocation {
  std::filesystem::path path;
  int line = 0;
  int column = 0;
};

// The input is at fault. what() is one line: "walk.bvh:57:12: expected 3 numbers after OFFSET, got
// 2; <remedy>".
class FormatError : public std::runtime_error {
 public:
  FormatError(FileLocation location, const std::string& problem, const std::string& remedy = "");

  const FileLocation& location() const { return location_; }

 private:
  FileLocation location_;
};

// A setting is outside what it may be; what() names the setting, its value and its range.
class ConfigError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

// The caller asked a long operation to stop; nothing was written.
class Cancelled : public std::runtime_error {
 public:
  Cancelled() : std::runtime_error("cancelled") {}
};

}  // namespace sparse_mocap
