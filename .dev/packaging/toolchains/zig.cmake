# SPDX-License-Identifier: GPL-3.0-or-later
#
# What the targets built by zig share: its clang with libc++ and compiler-rt linked in. No header of
# this machine is on the compiler's path: the libraries are in SPARSE_MOCAP_PREFIX (made by ./dev
# package), which also exports SPARSE_MOCAP_ZIG, the program. ZIG_TARGET is set by the file that
# includes this one.
set(ZIG_TOOLS ${CMAKE_CURRENT_LIST_DIR}/../zig)
set(CMAKE_C_COMPILER ${ZIG_TOOLS}/clang)
set(CMAKE_C_COMPILER_TARGET ${ZIG_TARGET})
set(CMAKE_CXX_COMPILER ${ZIG_TOOLS}/clang++)
set(CMAKE_CXX_COMPILER_TARGET ${ZIG_TARGET})
set(CMAKE_AR ${ZIG_TOOLS}/ar)
set(CMAKE_RANLIB ${ZIG_TOOLS}/ranlib)

set(CMAKE_FIND_ROOT_PATH ${SPARSE_MOCAP_PREFIX})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES SPARSE_MOCAP_PREFIX)
