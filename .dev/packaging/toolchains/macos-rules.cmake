# SPDX-License-Identifier: GPL-3.0-or-later
#
# Read by CMake after its own rules for macOS: zig's own linker would link modules wrongly.
set(CMAKE_CXX_CREATE_SHARED_MODULE
  "${ZIG_TOOLS}/link-macos <TARGET> <OBJECTS> <LINK_LIBRARIES>")
