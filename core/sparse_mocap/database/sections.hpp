// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "sparse_mocap/database/safetensors.hpp"

namespace sparse_mocap {

// An optional part of a motion database, under a name of its own, such as a search index: readers
// that do not know it skip it, editing keeps it. Of the file's metadata, `sections` lists them,
//   {"index": {"version": 1, "rows": "0123456789abcdef", "metadata": {"leaf": "64"}}}
// and the tensors of each are called sections/<section>/<tensor>, with checksums like all others.
struct Section {
  int version = 1;  // of what is kept under this name
  // MotionDatabase::rows_hash of the rows that it was made from, "" when it belongs to any rows.
  std::string rows;
  std::map<std::string, std::string> metadata;
  std::vector<Tensor> tensors;  // views; the names without what says whose they are

  // Throws std::invalid_argument when there is none, or it has another type or another number of
  // indices.
  const Tensor& tensor(const std::string& name, ElementType type, std::size_t num_indices) const;
};

inline constexpr char kSectionsKey[] = "sections";

// The sections of a file's further content, by name. Throws std::invalid_argument when the list is
// damaged.
std::map<std::string, Section> sections_of(const SafetensorsView& further);

// Whether it is a tensor of some section.
bool is_of_section(const Tensor& tensor);

// Puts a section in place of one with its name; the new tensors view the section's. Throws
// std::invalid_argument when its name is not of a-z, 0-9 and _, begins with no letter, or a text is
// not UTF-8.
void put_section(SafetensorsView& further, const std::string& name, const Section& section);
void remove_section(SafetensorsView& further, const std::string& name);

// Removes the sections that were made from other rows.
void remove_stale_sections(SafetensorsView& further, const std::string& rows_hash);

// Puts a section into a database file, which is replaced atomically; all else in it stays bit for
// bit, but that a file of an older version becomes one of the newest. Throws FormatError (no sound
// database), std::invalid_argument as put_section, std::filesystem_error.
void store_section(const std::filesystem::path& database, const std::string& name,
                   const Section& section);

}  // namespace sparse_mocap
