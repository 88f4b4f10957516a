# SPDX-License-Identifier: GPL-3.0-or-later
#
# Linux x86-64, against the symbols of glibc 2.28.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR x86_64)
set(CMAKE_LIBRARY_ARCHITECTURE x86_64-linux-gnu)
set(CMAKE_MODULE_LINKER_FLAGS_INIT -s)
set(ZIG_TARGET x86_64-linux-gnu.2.28)
include(${CMAKE_CURRENT_LIST_DIR}/zig.cmake)
