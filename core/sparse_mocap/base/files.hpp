// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace sparse_mocap {

// The whole file as bytes. Throws FormatError when it is larger than max_bytes or cannot be read
// (missing, a directory, no permission).
std::string read_file(const std::filesystem::path& path, std::size_t max_bytes);

// Writes the pieces one after another to a temporary file beside path, syncs and renames it, so
// that a reader sees the old file or the new one, never a part. Throws std::filesystem_error, which
// names path, and removes the temporary file when anything fails.
void write_file_atomically(const std::filesystem::path& path,
                           std::span<const std::span<const std::byte>> pieces);
void write_file_atomically(const std::filesystem::path& path, const std::string& text);

// Removes the temporary files beside path of writers that were killed; those that are being written
// stay. Files that cannot be removed are left.
void remove_abandoned_temporaries(const std::filesystem::path& path);

}  // namespace sparse_mocap
