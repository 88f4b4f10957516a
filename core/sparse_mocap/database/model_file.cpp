// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/model_file.hpp"

#include <algorithm>
#include <charconv>
#include <functional>
#include <map>
#include <stdexcept>
#include <utility>

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/base/file_lock.hpp"
#include "sparse_mocap/base/mapped_file.hpp"
#include "sparse_mocap/database/container.hpp"
#include "sparse_mocap/database/motion_database.hpp"
#include "sparse_mocap/database/stored_models.hpp"

namespace sparse_mocap {
namespace {

constexpr char kMethod[] = "method";
constexpr char kVersion[] = "model_version";
constexpr char kMetadata[] = "metadata";

std::vector<ArrayInPieces> whole_arrays(const std::vector<Tensor>& tensors) {
  std::vector<ArrayInPieces> arrays;
  for (const auto& tensor : tensors) arrays.push_back({tensor, {tensor.bytes}});
  return arrays;
}

EncodedContainer encoded(const Model& model) {
  check_model(model);
  std::map<std::string, std::string> metadata{{kMethod, model.method},
                                              {kVersion, std::to_string(model.version)},
                                              {kMetadata, text_of_metadata(model.metadata)}};
  std::vector<Tensor> tensors;
  for (const auto& [name, tensor] : model.tensors) tensors.push_back(viewed(name, tensor));
  return {kModelFormat, std::move(metadata), whole_arrays(tensors)};
}

int version_from(const std::string& text, const Container& container) {
  int version = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), version);
  if (error != std::errc() || end != text.data() + text.size())
    container.refuse("its version is not a number");
  return version;
}

}  // namespace

Model model_from_bytes(std::span<const std::byte> file, const std::filesystem::path& path) {
  const Container container(file, path, kModelFormat);
  Model model;
  model.path = path;
  model.method = container.text(kMethod);
  model.version = version_from(container.text(kVersion), container);
  for (const auto& tensor : container.tensors()) {
    if (!container.has_checksum(tensor.name))
      container.refuse("the array '" + tensor.name + "' has no checksum");
    model.tensors.emplace(tensor.name, copied(tensor));
  }
  try {
    model.metadata = metadata_from_text(container.text(kMetadata));
    check_model(model);
  } catch (const std::invalid_argument& error) {
    container.refuse(error.what());
  }
  return model;
}

Model read_model(const std::filesystem::path& path) {
  return model_from_bytes(map_file(path)->view(), path);
}

std::vector<std::byte> encode_model(const Model& model) { return encoded(model).bytes(); }

void write_model(const std::filesystem::path& path, const Model& model) {
  encoded(model).write(path);
}

void change_database(const std::filesystem::path& path,
                     const std::function<void(const MotionDatabase&, SafetensorsView&)>& change) {
  const FileLock lock(path);
  const auto database = MotionDatabase::open(path);
  const Container container(database->bytes()->view(), path, kDatabaseFormat);
  SafetensorsView content{container.metadata(), container.tensors()};
  change(*database, content);
  EncodedContainer(kDatabaseFormat, content.metadata, whole_arrays(content.tensors)).write(path);
}

void store_model(const std::filesystem::path& database, const Model& model) {
  change_database(database, [&](const MotionDatabase&, SafetensorsView& content) {
    remove_stored_model(content, model.method);
    add_stored_model(content, model);
  });
}

void remove_model(const std::filesystem::path& database, const std::string& method) {
  change_database(database, [&](const MotionDatabase& opened, SafetensorsView& content) {
    opened.require_model(method);
    remove_stored_model(content, method);
  });
}

}  // namespace sparse_mocap
