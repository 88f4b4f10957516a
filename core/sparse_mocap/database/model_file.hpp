// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "sparse_mocap/database/model.hpp"
#include "sparse_mocap/database/motion_database.hpp"

namespace sparse_mocap {

// A model in a file of its own (.smmodel), or in the motion database that it was learned from.
// Of the former any safetensors reader sees the tensors under their names, and in the metadata
// `format` sparse_mocap_model, `format_version`, `method`, `model_version`, the method's own
// `metadata` as a JSON object of texts, and checksums.

// Checks the whole file before use. Throws FormatError.
Model read_model(const std::filesystem::path& path);
// The same on bytes that are (or will be) such a file; path is for messages.
Model model_from_bytes(std::span<const std::byte> file, const std::filesystem::path& path);

// The file as it will lie on disk. Throws std::invalid_argument as check_model does.
std::vector<std::byte> encode_model(const Model& model);
// Writes it atomically. Throws std::filesystem_error, too.
void write_model(const std::filesystem::path& path, const Model& model);

// Puts a model into a motion database, in place of one that the same method has there, as
// change_database does. Throws FormatError (no sound
// database), std::invalid_argument (no sound model), std::filesystem_error.
void store_model(const std::filesystem::path& database, const Model& model);

// Changes the further content of a database file, which is replaced atomically; all else in it
// stays bit for bit, but that a file of an older version becomes one of the newest. Throws
// FormatError, and what change throws; the file is untouched then.
void change_database(
    const std::filesystem::path& path,
    const std::function<void(const MotionDatabase& database, SafetensorsView& content)>& change);

// Takes a method's model out of a motion database. Throws FormatError, also when there is none.
void remove_model(const std::filesystem::path& database, const std::string& method);

}  // namespace sparse_mocap
