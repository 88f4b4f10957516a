// SPDX-License-Identifier: GPL-3.0-or-later
#include "fuzz/targets.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "sparse_mocap/base/checksum.hpp"
#include "sparse_mocap/database/container.hpp"
#include "sparse_mocap/database/database_content.hpp"
#include "sparse_mocap/database/model_file.hpp"
#include "sparse_mocap/database/motion_database.hpp"
#include "sparse_mocap/formats/acclaim.hpp"
#include "sparse_mocap/formats/bvh.hpp"
#include "support/invariants.hpp"

namespace sparse_mocap::fuzz {
namespace {

// What reading came to: a motion, or what the error says.
struct Outcome {
  std::optional<Motion> motion;
  std::string error;
  std::string problem;  // of the outcome itself
};

// Small enough for an input never to take long or much memory; every third input is read with
// another up axis and every second may lack frames, so that those ways are walked too.
ReadOptions options_for(std::string_view input) {
  ReadOptions options;
  options.max_joints = 200;
  options.max_depth = 100;
  options.max_frames = 10'000;
  options.max_rotations = 100'000;
  options.up = static_cast<Axis>((input.size() + 1) % 3);
  options.allow_no_frames = input.size() % 2 == 0;
  return options;
}

std::string problem_of(const FormatError& error, bool has_lines) {
  const std::string what = error.what();
  const auto& location = error.location();
  if (!what.starts_with(location.path.string())) return "the error does not begin with the file";
  if (what.find_first_of("\r\n") != std::string::npos) return "the error has several lines";
  if (has_lines && location.line < 1) return "the error names no line";
  if (what.find("; ") == std::string::npos) return "the error names no remedy";
  return "";
}

std::string problem_of(const std::vector<ReadWarning>& warnings) {
  for (const auto& warning : warnings) {
    if (warning.count < 1 || warning.text.empty()) return "a warning is empty";
    if (warning.message().find_first_of("\r\n") != std::string::npos)
      return "a warning has several lines";
  }
  return warnings.size() > 50 ? "warnings of a kind are not counted together" : "";
}

template <typename Read>
Outcome outcome_of(const Read& read) {
  Outcome outcome;
  try {
    MotionFile file = read();
    outcome.problem = testing::joined(testing::check_motion(file.motion));
    if (outcome.problem.empty()) outcome.problem = problem_of(file.warnings);
    outcome.motion = std::move(file.motion);
  } catch (const FormatError& error) {
    outcome.error = error.what();
    outcome.problem = problem_of(error, true);
  }
  return outcome;
}

std::string with_crlf(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '\n') result += '\r';
    result += c;
  }
  return result;
}

bool is_same(const Motion& a, const Motion& b) {
  const auto is_equal = [](const Quat& p, const Quat& q) { return p.coeffs() == q.coeffs(); };
  return a.frame_time_s == b.frame_time_s && a.root_positions == b.root_positions &&
         a.skeleton.num_joints() == b.skeleton.num_joints() &&
         std::equal(a.rotations.begin(), a.rotations.end(), b.rotations.begin(), b.rotations.end(),
                    is_equal);
}

// Reads the input as it is and with the line ends of Windows.
template <typename Read>
std::string try_both_line_ends(std::string_view input, const Read& read) {
  const auto first = outcome_of([&] { return read(std::string(input)); });
  const bool is_plain =
      input.find('\r') == std::string_view::npos && input.find('\0') == std::string_view::npos;
  if (!first.problem.empty() || !is_plain) return first.problem;
  const auto second = outcome_of([&] { return read(with_crlf(input)); });
  if (second.error != first.error)
    return "with CRLF it says \"" + second.error + "\" instead of \"" + first.error + "\"";
  if (first.motion && !is_same(*first.motion, *second.motion))
    return "with CRLF it moves otherwise";
  return second.problem;
}

// The same arrays and metadata with the checksums that belong to them; nothing where the container
// itself is damaged.
std::optional<std::vector<std::byte>> resealed(std::span<const std::byte> file) {
  SafetensorsView view;
  try {
    view = parse_safetensors(file);
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
  nlohmann::json checksums = nlohmann::json::object();
  for (const auto& tensor : view.tensors) checksums[tensor.name] = checksum(tensor.bytes);
  view.metadata["checksums"] = checksums.dump();
  view.metadata[kMetadataChecksum] = metadata_checksum(view.metadata);
  const auto header = safetensors_header(view.metadata, view.tensors);
  const auto header_bytes = std::as_bytes(std::span(header));
  std::vector<std::byte> result(header_bytes.begin(), header_bytes.end());
  for (const auto& tensor : view.tensors)
    result.insert(result.end(), tensor.bytes.begin(), tensor.bytes.end());
  return result;
}

// Runs try_bytes on the input, and on the input with its checksums put right.
template <typename TryBytes>
std::string try_both_checksums(std::string_view input, const TryBytes& try_bytes) {
  const auto bytes = std::as_bytes(std::span(input));
  if (auto problem = try_bytes({bytes.begin(), bytes.end()}); !problem.empty()) return problem;
  const auto sealed = resealed(bytes);
  return sealed ? try_bytes(*sealed) : "";
}

// What a model must be, whoever hands it out; written again it must be the same.
std::string problem_of(const Model& model) {
  check_model(model);  // throws std::invalid_argument, which nobody catches
  const auto again = model_from_bytes(encode_model(model), "fuzz.smmodel");
  const bool is_same = again.method == model.method && again.version == model.version &&
                       again.metadata == model.metadata && again.tensors == model.tensors;
  return is_same ? "" : "the model written again is another";
}

std::string try_models(const MotionDatabase& database) {
  for (const auto& method : database.model_names()) {
    try {
      if (auto problem = problem_of(database.model(method)); !problem.empty()) return problem;
    } catch (const FormatError& error) {
      if (auto problem = problem_of(error, false); !problem.empty()) return problem;
    }
  }
  return "";
}

// The file written again as add and drop do must hold the same further content, but for sections
// that were made from other rows.
std::string try_copy(const MotionDatabase& database) {
  const auto copy =
      MotionDatabase::from_bytes(own_bytes(encode_database(database_content(database))), "copy");
  SafetensorsView expected = database.further();
  remove_stale_sections(expected, database.rows_hash());
  if (copy->further().metadata != expected.metadata) return "metadata got lost";
  if (copy->further().tensors.size() != expected.tensors.size()) return "an array got lost";
  for (const auto& tensor : expected.tensors) {
    const Tensor* kept = copy->further().find(tensor.name);
    if (kept == nullptr || kept->type != tensor.type || kept->shape != tensor.shape ||
        !std::ranges::equal(kept->bytes, tensor.bytes))
      return "an array was changed";
  }
  return "";
}

std::string try_database_bytes(std::vector<std::byte> bytes) {
  try {
    const auto database = MotionDatabase::from_bytes(own_bytes(std::move(bytes)), "fuzz.smdb");
    auto problem = testing::joined(testing::check_database(*database));
    if (problem.empty()) problem = try_models(*database);
    return problem.empty() ? try_copy(*database) : problem;
  } catch (const FormatError& error) {
    return problem_of(error, false);
  }
}

std::string try_model_bytes(const std::vector<std::byte>& bytes) {
  try {
    return problem_of(model_from_bytes(bytes, "fuzz.smmodel"));
  } catch (const FormatError& error) {
    return problem_of(error, false);
  }
}

}  // namespace

std::string try_bvh(std::string_view input) {
  const auto options = options_for(input);
  return try_both_line_ends(
      input, [&](std::string text) { return bvh_from_text(std::move(text), "fuzz.bvh", options); });
}

std::string try_acclaim(std::string_view input) {
  constexpr std::string_view kBetween = "#AMC\n";
  const auto options = options_for(input);
  return try_both_line_ends(input, [&](const std::string& text) {
    const bool is_crlf = text.find("\r\n") != std::string::npos;
    const auto between = is_crlf ? with_crlf(kBetween) : std::string(kBetween);
    const auto at = text.find(between);
    const auto asf = asf_from_text(text.substr(0, at), "fuzz.asf", options);
    const auto amc = at == std::string::npos ? "" : text.substr(at + between.size());
    auto file = amc_from_text(amc, "fuzz.amc", asf, options);
    file.warnings.insert(file.warnings.end(), asf.warnings.begin(), asf.warnings.end());
    return file;
  });
}

std::string try_database(std::string_view input) {
  return try_both_checksums(input, try_database_bytes);
}

std::string try_model(std::string_view input) { return try_both_checksums(input, try_model_bytes); }

}  // namespace sparse_mocap::fuzz
