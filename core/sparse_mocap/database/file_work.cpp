// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/file_work.hpp"

#include <cstring>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "sparse_mocap/database/clip_json.hpp"

namespace sparse_mocap {
namespace {

using nlohmann::json;

std::string packed_message(const json& message) {
  std::string bytes;
  json::to_msgpack(message, bytes);
  return bytes;
}

// Reads a message; what is not as it must be is the sender's fault.
template <typename Read>
auto unpacked_message(const std::string& bytes, const Read& read) {
  try {
    return read(json::from_msgpack(bytes));
  } catch (const json::exception& error) {
    throw std::invalid_argument(std::string("a message about a motion file is damaged: ") +
                                error.what());
  }
}

// --- Requests ------------------------------------------------------------------------------------

json bones_json(const StandardBones& bones) {
  json numbers = json::array();
  for (const Vec3& bone : bones) numbers.push_back({bone.x(), bone.y(), bone.z()});
  return numbers;
}

StandardBones bones_from(const json& numbers) {
  StandardBones bones;
  for (std::size_t j = 0; j < bones.size(); ++j)
    for (int k = 0; k < 3; ++k) bones[j][k] = numbers.at(j).at(static_cast<std::size_t>(k));
  return bones;
}

// Formats that further readers read are the worker's own business.
json read_json(const ReadOptions& read) {
  json entry{{"max_bytes", read.max_bytes},
             {"max_joints", read.max_joints},
             {"max_depth", read.max_depth},
             {"max_frames", read.max_frames},
             {"max_rotations", read.max_rotations},
             {"amc_rate_hz", read.amc_rate_hz},
             {"up", static_cast<int>(read.up)},
             {"asf", read.asf.string()},
             {"refuse_other_asf", read.refuse_other_asf},
             {"allow_no_frames", read.allow_no_frames}};
  if (read.unit_m) entry["unit_m"] = *read.unit_m;
  if (read.rate_hz) entry["rate_hz"] = *read.rate_hz;
  return entry;
}

ReadOptions read_from(const json& entry, const ReadOptions& own) {
  ReadOptions read;
  read.max_bytes = entry.at("max_bytes");
  read.max_joints = entry.at("max_joints");
  read.max_depth = entry.at("max_depth");
  read.max_frames = entry.at("max_frames");
  read.max_rotations = entry.at("max_rotations");
  read.amc_rate_hz = entry.at("amc_rate_hz");
  read.up = static_cast<Axis>(entry.at("up").get<int>());
  read.asf = entry.at("asf").get<std::string>();
  read.refuse_other_asf = entry.at("refuse_other_asf");
  read.allow_no_frames = entry.at("allow_no_frames");
  if (entry.contains("unit_m")) read.unit_m = entry.at("unit_m").get<double>();
  if (entry.contains("rate_hz")) read.rate_hz = entry.at("rate_hz").get<double>();
  read.further_readers = own.further_readers;
  read.validate();
  return read;
}

json survey_json(const SurveyRequest& request) {
  return {{"path", request.file.path.string()},  {"name", request.file.name},
          {"num_bytes", request.file.num_bytes}, {"read", read_json(request.read)},
          {"by_hand", request.mapping.by_hand},  {"by_rig", request.mapping.by_rig}};
}

void read_survey(const json& entry, const ReadOptions& own, SurveyRequest& request) {
  request.file = {entry.at("path").get<std::string>(), entry.at("name"), entry.at("num_bytes")};
  request.read = read_from(entry.at("read"), own);
  request.mapping.by_hand = entry.at("by_hand").get<JointNames>();
  request.mapping.by_rig = entry.at("by_rig").get<std::map<std::string, JointNames>>();
}

ImportRequest import_from(const json& entry, const ReadOptions& own) {
  ImportRequest request;
  read_survey(entry, own, request);
  request.hashes = {entry.at("hash"), entry.at("skeleton_hash")};
  request.bones = bones_from(entry.at("bones"));
  request.copies = {entry.at("rate_hz"), entry.at("mirror"), entry.at("reverse"),
                    entry.at("tempos").get<std::vector<double>>(), entry.at("own_proportions")};
  request.is_strict = entry.at("strict");
  return request;
}

// --- Answers -------------------------------------------------------------------------------------

template <typename Matrix>
json matrix_json(const Matrix& matrix) {
  const auto* first = reinterpret_cast<const std::uint8_t*>(matrix.data());
  const auto num_bytes = static_cast<std::size_t>(matrix.size()) * sizeof(typename Matrix::Scalar);
  return {matrix.rows(), matrix.cols(), json::binary({first, first + num_bytes})};
}

template <typename Matrix>
void read_matrix(const json& entry, Matrix& matrix) {
  const auto& bytes = entry.at(2).get_binary();
  const auto rows = entry.at(0).get<Eigen::Index>(), columns = entry.at(1).get<Eigen::Index>();
  constexpr Eigen::Index kMost = Eigen::Index{1} << 31;
  if (rows < 0 || columns < 0 || rows >= kMost || columns >= kMost ||
      bytes.size() != static_cast<std::size_t>(rows * columns) * sizeof(typename Matrix::Scalar))
    throw std::invalid_argument("a message about a motion file holds too few numbers");
  matrix.resize(rows, columns);
  if (!bytes.empty()) std::memcpy(matrix.data(), bytes.data(), bytes.size());
}

// Calls visit(array) for each packed array of the rows.
template <typename Rows, typename Visit>
void each_array(Rows& rows, const Visit& visit) {
  for (auto* array : {&rows.angles, &rows.positions, &rows.extremities}) visit(*array);
  for (auto& site : rows.sites)
    for (auto* array : {&site.specific_force_pivot, &site.specific_force_end,
                        &site.angular_velocity, &site.gravity_direction})
      visit(*array);
}

json rows_json(const PackedRows& rows) {
  json arrays = json::array();
  each_array(rows, [&](const PackedArray& array) {
    arrays.push_back({array.scale, matrix_json(array.values)});
  });
  return {{"sites", rows.sites.size()},
          {"arrays", std::move(arrays)},
          {"root_motion", matrix_json(rows.root_motion)},
          {"contacts", matrix_json(rows.contacts)}};
}

PackedRows rows_from(const json& entry) {
  PackedRows rows;
  rows.sites.resize(entry.at("sites").get<std::uint8_t>());
  std::size_t next = 0;
  each_array(rows, [&](PackedArray& array) {
    const json& at = entry.at("arrays").at(next++);
    array.scale = at.at(0);
    read_matrix(at.at(1), array.values);
  });
  read_matrix(entry.at("root_motion"), rows.root_motion);
  read_matrix(entry.at("contacts"), rows.contacts);
  return rows;
}

json result_json(const SurveyedFile& surveyed) {
  return {{"hash", surveyed.hashes.file},
          {"skeleton_hash", surveyed.hashes.skeleton},
          {"bones", bones_json(surveyed.bones)},
          {"num_frames", surveyed.num_frames},
          {"duration_s", surveyed.duration_s}};
}

void read_result(const json& entry, SurveyedFile& surveyed) {
  surveyed = {{entry.at("hash"), entry.at("skeleton_hash")},
              bones_from(entry.at("bones")),
              entry.at("num_frames"),
              entry.at("duration_s")};
}

json result_json(const ImportedFile& imported) {
  json clips = json::array(), rows = json::array(), faults = json::array();
  for (const Clip& clip : imported.clips) clips.push_back(clip_json(clip));
  for (const PackedRows& of_clip : imported.clip_rows) rows.push_back(rows_json(of_clip));
  for (const ClipFault& fault : imported.faults) faults.push_back({fault.text, fault.severity});
  return {{"clips", std::move(clips)},
          {"rows", std::move(rows)},
          {"skeleton", source_skeleton_json(imported.skeleton)},
          {"bones", bones_json(imported.bones)},
          {"warnings", imported.warnings},
          {"faults", std::move(faults)}};
}

void read_result(const json& entry, ImportedFile& imported) {
  for (const json& clip : entry.at("clips")) imported.clips.push_back(clip_from(clip));
  for (const json& rows : entry.at("rows")) imported.clip_rows.push_back(rows_from(rows));
  if (imported.clips.empty() || imported.clips.size() != imported.clip_rows.size())
    throw std::invalid_argument("a message about a motion file holds too few clips");
  imported.skeleton = source_skeleton_from(entry.at("skeleton"));
  imported.bones = bones_from(entry.at("bones"));
  imported.warnings = entry.at("warnings").get<std::vector<std::string>>();
  for (const json& fault : entry.at("faults"))
    imported.faults.push_back({fault.at(0), fault.at(1), false});
}

json error_json(const FormatError& error) {
  const FileLocation& at = error.location();
  const std::size_t prefix = std::strlen(FormatError(at, "").what());
  return {{"path", at.path.string()},
          {"line", at.line},
          {"column", at.column},
          {"problem", std::string(error.what()).substr(prefix)}};
}

FormatError error_from(const json& entry) {
  return FormatError({entry.at("path").get<std::string>(), entry.at("line"), entry.at("column")},
                     entry.at("problem").get<std::string>());
}

template <typename Result>
std::string answer_with(const Outcome<Result>& outcome) {
  if (const auto* error = std::get_if<FormatError>(&outcome))
    return packed_message({{"error", error_json(*error)}});
  return packed_message({{"result", result_json(std::get<Result>(outcome))}});
}

template <typename Result>
Outcome<Result> outcome_in(const std::string& answer) {
  return unpacked_message(answer, [](const json& message) -> Outcome<Result> {
    if (message.contains("error")) return error_from(message.at("error"));
    Result result;
    read_result(message.at("result"), result);
    return result;
  });
}

}  // namespace

std::string encoded(const SurveyRequest& request) { return packed_message(survey_json(request)); }

std::string encoded(const ImportRequest& request) {
  json message = survey_json(request);
  message["hash"] = request.hashes.file;
  message["skeleton_hash"] = request.hashes.skeleton;
  message["bones"] = bones_json(request.bones);
  message["rate_hz"] = request.copies.rate_hz;
  message["mirror"] = request.copies.add_mirrored;
  message["reverse"] = request.copies.add_reversed;
  message["tempos"] = request.copies.tempos;
  message["own_proportions"] = request.copies.has_own_proportions;
  message["strict"] = request.is_strict;
  return packed_message(message);
}

std::string answer_to(const std::string& request, const ReadOptions& read) {
  return unpacked_message(request, [&](const json& message) {
    if (message.contains("bones"))
      return answer_with(import_file(import_from(message, read), std::stop_token()));
    SurveyRequest survey;
    read_survey(message, read, survey);
    return answer_with(survey_file(survey, std::stop_token()));
  });
}

Outcome<SurveyedFile> decoded_survey(const std::string& answer) {
  return outcome_in<SurveyedFile>(answer);
}

Outcome<ImportedFile> decoded_import(const std::string& answer) {
  return outcome_in<ImportedFile>(answer);
}

}  // namespace sparse_mocap
