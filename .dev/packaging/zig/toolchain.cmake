# SPDX-License-Identifier: GPL-3.0-or-later
#
# Linux x86-64 by zig's clang: against the symbols of glibc 2.28, with libc++ and compiler-rt linked
# in. No header of this machine is on the compiler's path: the libraries are in SPARSE_MOCAP_PREFIX
# (made by ./dev package), which also exports SPARSE_MOCAP_ZIG, the program.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR x86_64)
set(CMAKE_CXX_COMPILER ${CMAKE_CURRENT_LIST_DIR}/clang++)
set(CMAKE_CXX_COMPILER_TARGET x86_64-linux-gnu.2.28)
set(CMAKE_LIBRARY_ARCHITECTURE x86_64-linux-gnu)
set(CMAKE_AR ${CMAKE_CURRENT_LIST_DIR}/ar)
set(CMAKE_RANLIB ${CMAKE_CURRENT_LIST_DIR}/ranlib)
set(CMAKE_MODULE_LINKER_FLAGS_INIT -s)

set(CMAKE_FIND_ROOT_PATH ${SPARSE_MOCAP_PREFIX})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES SPARSE_MOCAP_PREFIX)
