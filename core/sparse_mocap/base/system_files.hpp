// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>

#include "sparse_mocap/base/mapped_file.hpp"

// What files need of the operating system: system_files_posix.cpp or system_files_windows.cpp.
namespace sparse_mocap {

int process_id();

// Both give nullptr and set errno when it does not work. A created file was not there before.
// It can be told from one whose writer was killed, see remove_unless_written.
std::FILE* open_file(const std::filesystem::path& path);
std::FILE* create_file(const std::filesystem::path& path);

// Waits until what was written is on the disk. Returns false and sets errno when it does not work.
bool sync_file(std::FILE* file);

// Closes a created file and renames it over another, which may be missing or mapped. Throws
// std::filesystem_error.
void close_and_replace(std::FILE* created, const std::filesystem::path& from,
                       const std::filesystem::path& to);

// Removes a file unless the one who created it has it open still.
void remove_unless_written(const std::filesystem::path& path);

// The lock of a file, until what is returned goes; nullptr while somebody else has it. Held without
// effect where there is no such file, or no locks.
std::shared_ptr<const void> try_lock(const std::filesystem::path& path);

// A rename is durable only once the folder that holds the name is.
void sync_folder(const std::filesystem::path& folder);

// Maps a regular file. Throws FormatError when it cannot be read.
std::shared_ptr<const Bytes> map_regular_file(const std::filesystem::path& path);

}  // namespace sparse_mocap
