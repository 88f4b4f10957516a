// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/sidecar.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <string_view>

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/base/files.hpp"
#include "sparse_mocap/base/nearest_name.hpp"
#include "sparse_mocap/base/text_scanner.hpp"

namespace sparse_mocap {
namespace {

using Field = CsvField;

constexpr std::size_t kMaxBytes = 64'000'000;
constexpr std::array<std::string_view, 5> kColumns{"file", "actor", "class", "source", "license"};

// One line of a CSV file taken apart.
class LineReader {
 public:
  LineReader(std::string_view line, FileLocation where) : line_(line), where_(std::move(where)) {}

  std::vector<Field> fields() {
    std::vector<Field> out;
    for (;;) {
      out.push_back(field());
      if (at_ == line_.size()) return out;
      ++at_;  // the comma
    }
  }

 private:
  [[noreturn]] void fail(const std::string& problem, const std::string& remedy) {
    where_.column = static_cast<int>(at_) + 1;
    throw FormatError(where_, problem, remedy);
  }

  Field field() {
    Field field{"", static_cast<int>(at_) + 1};
    if (at_ < line_.size() && line_[at_] == '"') {
      field.text = quoted();
      if (at_ < line_.size() && line_[at_] != ',')
        fail("text follows a quoted field", "put a comma between fields");
    } else {
      const auto comma = std::min(line_.find(',', at_), line_.size());
      field.text = trimmed(line_.substr(at_, comma - at_));
      at_ = comma;
    }
    return field;
  }

  std::string quoted() {
    std::string text;
    const std::size_t open = at_++;
    for (; at_ < line_.size(); ++at_) {
      if (line_[at_] == '"') {
        ++at_;
        if (at_ == line_.size() || line_[at_] != '"') return text;
      }
      text.push_back(line_[at_]);
    }
    at_ = open;
    fail("a quote is not closed on its line", "write a quote within quotes twice");
  }

  static std::string trimmed(std::string_view text) {
    const auto begin = text.find_first_not_of(" \t");
    if (begin == std::string_view::npos) return "";
    return std::string(text.substr(begin, text.find_last_not_of(" \t") - begin + 1));
  }

  std::string_view line_;
  FileLocation where_;
  std::size_t at_ = 0;
};

// What each column of the table holds.
std::vector<std::string> columns_of(const std::vector<Field>& header, FileLocation where) {
  std::vector<std::string> columns;
  for (const auto& field : header) {
    where.column = field.column;
    const std::string name = lower_case(field.text);
    if (std::find(kColumns.begin(), kColumns.end(), name) == kColumns.end())
      throw FormatError(where, "unknown column " + in_quotes(field.text),
                        "did you mean " + in_quotes(std::string(nearest_name(name, kColumns))) +
                            "? Known are file, actor, class, source, license");
    if (std::find(columns.begin(), columns.end(), name) != columns.end())
      throw FormatError(where, "the column " + in_quotes(name) + " occurs twice", "leave one out");
    columns.push_back(name);
  }
  where.column = 1;
  if (std::find(columns.begin(), columns.end(), "file") == columns.end())
    throw FormatError(where, "the column \"file\" is missing",
                      "the header is file,actor,class,source,license");
  return columns;
}

std::string key_of(std::string name) {
  std::replace(name.begin(), name.end(), '\\', '/');
  return lower_case(name.starts_with("./") ? name.substr(2) : name);
}

// What a file may be called in a table, the longest name first.
std::array<std::string, 3> names_of(const SourceFile& file) {
  return {key_of(file.name), key_of(file.path.filename().string()),
          key_of(file.path.stem().string())};
}

}  // namespace

void Sidecar::add_row(const std::vector<std::string>& columns, const std::vector<Field>& fields,
                      FileLocation where) {
  if (fields.size() != columns.size())
    throw FormatError(where,
                      "has " + std::to_string(fields.size()) + " fields, the header has " +
                          std::to_string(columns.size()),
                      "put text that holds a comma within quotes");
  Row row;
  row.line = where.line;
  const std::map<std::string_view, std::string*> targets{{"file", &row.file},
                                                         {"actor", &row.actor},
                                                         {"class", &row.motion_class},
                                                         {"source", &row.origin},
                                                         {"license", &row.license}};
  for (std::size_t i = 0; i < fields.size(); ++i) {
    *targets.at(columns[i]) = fields[i].text;
    if (columns[i] == "file") where.column = fields[i].column;
  }
  if (row.file.empty())
    throw FormatError(where, "names no file", "write its name or leave the row out");
  const auto [at, is_new] = rows_.emplace(key_of(row.file), row);
  if (!is_new)
    throw FormatError(where,
                      in_quotes(row.file) + " is described in line " +
                          std::to_string(at->second.line) + " already",
                      "leave one of the rows out");
}

Sidecar Sidecar::read(const std::filesystem::path& path) {
  Sidecar sidecar;
  sidecar.path_ = path;
  TextScanner scanner(path, read_file(path, kMaxBytes), {});
  std::vector<std::string> columns;
  while (!scanner.at_end()) {
    const std::string_view text = scanner.rest_of_line();
    if (text.find_first_not_of(" \t") == std::string_view::npos) continue;
    const FileLocation where = scanner.location(text);
    const auto fields = LineReader(text, where).fields();
    if (columns.empty()) {
      columns = columns_of(fields, where);
    } else {
      sidecar.add_row(columns, fields, where);
    }
  }
  if (columns.empty())
    throw FormatError({path}, "is empty", "the header is file,actor,class,source,license");
  return sidecar;
}

const Sidecar::Row* Sidecar::find(const SourceFile& file) const {
  for (const auto& name : names_of(file))
    if (const auto at = rows_.find(name); at != rows_.end()) return &at->second;
  return nullptr;
}

bool Sidecar::describe(const SourceFile& file, Clip& clip) const {
  const Row* row = find(file);
  if (row == nullptr) return false;
  const auto put = [](std::string& label, const std::string& said) {
    if (!said.empty()) label = said;
  };
  put(clip.actor, row->actor);
  put(clip.motion_class, row->motion_class);
  put(clip.origin, row->origin);
  put(clip.license, row->license);
  return true;
}

std::vector<std::string> Sidecar::warnings(const std::vector<SourceFile>& files) const {
  std::set<std::string> known;
  for (const auto& file : files)
    for (const auto& name : names_of(file)) known.insert(name);
  std::vector<const Row*> unknown;
  for (const auto& [key, row] : rows_)
    if (!known.contains(key)) unknown.push_back(&row);
  std::sort(unknown.begin(), unknown.end(),
            [](const Row* a, const Row* b) { return a->line < b->line; });
  std::vector<std::string> lines;
  for (const Row* row : unknown)
    lines.push_back(
        FormatError({path_, row->line, 0}, "no motion file is called " + in_quotes(row->file))
            .what());
  return lines;
}

}  // namespace sparse_mocap
