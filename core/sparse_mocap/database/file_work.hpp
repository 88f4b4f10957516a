// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sparse_mocap/database/clip_import.hpp"

namespace sparse_mocap {

// The work on motion files as messages, so that other processes can do it: a request is bytes
// (MessagePack), and so is the answer. Messages are of one version of this library.

// Files are found by their paths, and mappings by hand go along.
std::string encoded(const SurveyRequest& request);
std::string encoded(const ImportRequest& request);

// Does what a request asks for. read: readers of further formats; all else of it is in the request.
// What is wrong with the file is in the answer. Throws std::invalid_argument for what is no
// request.
std::string answer_to(const std::string& request, const ReadOptions& read);

// What an answer says. Throws std::invalid_argument for what is no such answer.
Outcome<SurveyedFile> decoded_survey(const std::string& answer);
Outcome<ImportedFile> decoded_import(const std::string& answer);

// The answers to some requests, one after another in their order; nothing while the next one is not
// there yet.
using NextAnswer = std::function<std::optional<std::string>()>;
// Gets requests answered.
using RemoteWork = std::function<NextAnswer(std::vector<std::string> requests)>;

}  // namespace sparse_mocap
