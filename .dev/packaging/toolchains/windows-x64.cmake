# SPDX-License-Identifier: GPL-3.0-or-later
#
# Windows x86-64 by MinGW-w64, with all of its runtime linked in. Its libstdc++ takes the names of
# files for UTF-8, whatever the code page of Windows; zig's libc++ does not. No header of this machine
# is on the compiler's path: the libraries are in SPARSE_MOCAP_PREFIX (made by ./dev package).
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_SYSTEM_PROCESSOR AMD64)
set(CMAKE_C_COMPILER x86_64-w64-mingw32-gcc-posix)
set(CMAKE_CXX_COMPILER x86_64-w64-mingw32-g++-posix)
set(CMAKE_RC_COMPILER x86_64-w64-mingw32-windres)
set(CMAKE_EXE_LINKER_FLAGS_INIT -static)
# The time of linking stays out of the file, so that the same sources give the same bytes.
set(CMAKE_MODULE_LINKER_FLAGS_INIT "-static -s -Wl,--no-insert-timestamp")

set(CMAKE_FIND_ROOT_PATH ${SPARSE_MOCAP_PREFIX})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES SPARSE_MOCAP_PREFIX)
