// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>

#include "formats/format_test_support.hpp"
#include "sparse_mocap/base/checksum.hpp"
#include "sparse_mocap/base/files.hpp"
#include "sparse_mocap/database/container.hpp"
#include "sparse_mocap/database/database_content.hpp"
#include "support/refusals.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap {
namespace {

using testing::contains;
using testing::content_of;
using testing::database_of;
using testing::swaying_motion;
using testing::template_skeleton;
using testing::TemporaryFolder;

DatabaseContent small_content(int frames) {
  return content_of({swaying_motion(template_skeleton(), 1, frames, 25.0)}, 25.0);
}

// What opening these bytes as a database complains about, "" if nothing.
std::string complaint(std::vector<std::byte> file) {
  try {
    MotionDatabase::from_bytes(own_bytes(std::move(file)), "motions.smdb");
  } catch (const FormatError& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with("motions.smdb: ")) << error.what();
    return error.what();
  }
  return "";
}

// The file with its arrays and metadata changed, checksums put right again.
template <typename Change>
std::vector<std::byte> forged(const std::vector<std::byte>& file, const Change& change) {
  const SafetensorsView view = parse_safetensors(file);
  auto metadata = view.metadata;
  std::map<std::string, std::vector<std::byte>> arrays;
  for (const auto& t : view.tensors) arrays[t.name] = {t.bytes.begin(), t.bytes.end()};
  change(metadata, arrays);
  nlohmann::json sums;
  std::vector<Tensor> tensors;
  for (const auto& t : view.tensors) {
    sums[t.name] = checksum(arrays[t.name]);
    tensors.push_back({t.name, t.type, t.shape, arrays[t.name]});
  }
  metadata["checksums"] = sums.dump();
  metadata.erase("metadata_checksum");
  std::string all;
  for (const auto& [key, value] : metadata) all += key + '\0' + value + '\0';
  metadata["metadata_checksum"] = checksum(std::as_bytes(std::span(all)));
  const std::string header = safetensors_header(metadata, tensors);
  std::vector<std::byte> out(header.size());
  std::memcpy(out.data(), header.data(), header.size());
  for (const auto& t : tensors) out.insert(out.end(), t.bytes.begin(), t.bytes.end());
  return out;
}

using Metadata = std::map<std::string, std::string>;
using Arrays = std::map<std::string, std::vector<std::byte>>;

TEST(MotionDatabase, GivesBackWhatWasWritten) {
  const DatabaseContent content = content_of({swaying_motion(template_skeleton(), 1, 50, 50.0),
                                              swaying_motion(template_skeleton(), 2, 37, 50.0)},
                                             25.0);
  const TemporaryFolder folder;
  const auto file = encode_database(content);
  const std::span<const std::byte> piece(file);
  write_file_atomically(folder / "motions.smdb", std::span(&piece, 1));
  const auto database = MotionDatabase::open(folder / "motions.smdb");
  EXPECT_EQ(database->path(), folder / "motions.smdb");
  EXPECT_EQ(database->rate_hz(), 25.0);
  EXPECT_EQ(database->build_info(), "{}");
  EXPECT_EQ(bones_of(database->skeleton()), bones_of(content.skeleton));
  EXPECT_EQ(database->site_names().size(), all_sites().size());
  ASSERT_EQ(database->clips().size(), 2U);
  EXPECT_EQ(database->num_frames(), 25 + 19);
  for (std::size_t c = 0; c < 2; ++c) {
    const Clip& clip = database->clips()[c];
    const PackedRows& rows = content.clip_rows[c];
    EXPECT_EQ(clip.name, content.clips[c].name);
    EXPECT_EQ(clip.num_frames(), rows.num_frames());
    const auto same = [&](const ScaledRows& read, const PackedArray& written) {
      EXPECT_EQ(read.values().middleRows(clip.begin, clip.num_frames()), written.values);
      EXPECT_EQ(read.scale(clip.begin), written.scale);
      EXPECT_EQ(read.row(clip.begin + 1), unpacked(written).row(1));
      EXPECT_EQ(read(clip.begin + 2, 1), unpacked(written)(2, 1));
    };
    same(database->angles(), rows.angles);
    same(database->positions(), rows.positions);
    EXPECT_EQ(database->root_motion().middleRows(clip.begin, clip.num_frames()), rows.root_motion);
    EXPECT_EQ(database->contacts().middleRows(clip.begin, clip.num_frames()), rows.contacts);
    for (std::size_t s = 0; s < rows.sites.size(); ++s) {
      same(database->site(s).specific_force_pivot, rows.sites[s].specific_force_pivot);
      same(database->site(s).specific_force_end, rows.sites[s].specific_force_end);
      same(database->site(s).angular_velocity, rows.sites[s].angular_velocity);
      same(database->site(s).gravity_direction, rows.sites[s].gravity_direction);
    }
    for (int n = clip.begin; n < clip.end; ++n)
      EXPECT_EQ(database->clip_index(n), static_cast<int>(c));
  }
}

TEST(MotionDatabase, RefusesContentThatDoesNotCorrespond) {
  DatabaseContent content = small_content(5);
  content.clips.clear();
  EXPECT_REFUSED(std::invalid_argument, "do not correspond", encode_database(content));
  content.clips.resize(2);
  EXPECT_REFUSED(std::invalid_argument, "do not correspond", encode_database(content));
  content = small_content(5);
  content.clip_rows[0].sites.pop_back();
  EXPECT_REFUSED(std::invalid_argument, "do not correspond to its sites", encode_database(content));
}

TEST(MotionDatabase, RefusesMissingFilesAndFolders) {
  const TemporaryFolder folder;
  EXPECT_REFUSED(FormatError, "no such file", MotionDatabase::open(folder / "none.smdb"));
  EXPECT_REFUSED(FormatError, "is not a regular file", MotionDatabase::open(folder.path()));
  folder.write("empty.smdb", "");
  EXPECT_REFUSED(FormatError, "not a sound motion database",
                 MotionDatabase::open(folder / "empty.smdb"));
}

TEST(MotionDatabase, RefusesAFileCutAtAnyLength) {
  const auto file = encode_database(small_content(3));
  ASSERT_EQ(complaint(file), "");
  for (std::size_t length = 0; length < file.size(); ++length)
    ASSERT_NE(complaint({file.begin(), file.begin() + static_cast<std::ptrdiff_t>(length)}), "")
        << "cut to " << length << " of " << file.size();
  auto longer = file;
  longer.push_back(std::byte{0});
  EXPECT_TRUE(contains(complaint(longer), "bytes follow the last array"));
}

TEST(MotionDatabase, RefusesAFileWithAnyByteDamaged) {
  const auto file = encode_database(small_content(3));
  for (std::size_t i = 0; i < file.size(); ++i) {
    auto damaged = file;
    damaged[i] ^= std::byte{static_cast<unsigned char>(1U << (i * 5 % 8))};
    ASSERT_NE(complaint(damaged), "")
        << "byte " << i << " of "
        << std::string(reinterpret_cast<const char*>(&damaged[i - std::min<std::size_t>(i, 30)]),
                       60);
  }
}

TEST(MotionDatabase, NamesTheArrayThatIsDamaged) {
  auto file = encode_database(small_content(3));
  file[file.size() - 3] ^= std::byte{1};
  EXPECT_TRUE(contains(complaint(file), "the array 'contacts' does not match its checksum"));
}

TEST(MotionDatabase, RefusesAnotherVersionNamingBoth) {
  const auto file = forged(encode_database(small_content(3)),
                           [](Metadata& metadata, Arrays&) { metadata["format_version"] = "999"; });
  EXPECT_TRUE(
      contains(complaint(file), "format version 999, and this program reads versions 1 to " +
                                    std::to_string(kDatabaseFormatVersion)))
      << complaint(file);
}

TEST(MotionDatabase, RefusesClaimsThatAreChecksummedButFalse) {
  const auto file = encode_database(small_content(4));
  const auto expect = [&](const std::string& key, const std::string& value,
                          const std::string& part) {
    const auto text =
        complaint(forged(file, [&](Metadata& metadata, Arrays&) { metadata[key] = value; }));
    EXPECT_TRUE(contains(text, part)) << key << " = " << value << " -> " << text;
  };
  EXPECT_EQ(complaint(forged(file, [](Metadata&, Arrays&) {})), "");
  expect("format", "something", "something else");
  expect("rate_hz", "0", "frame rate");
  expect("rate_hz", "1e9", "frame rate");
  expect("rate_hz", "fast", "metadata is damaged");
  expect("sites", "[]", "no sensor sites");
  expect("sites", "[\"a\"]", "the array 'sites/a/specific_force_pivot' is missing");
  expect("sites", "[\"head\",\"head\"]", "a sensor site twice");
  expect("skeleton", "[]", "21 joints");
  expect("clips", "[]", "no clips");
  expect("sections", "[]", "the list of its sections is damaged");
  expect("clips", "{", "metadata is damaged");
  expect("clips", "[{\"name\":\"a\"}]", "metadata is damaged");
}

TEST(MotionDatabase, RefusesClipsThatDoNotCoverTheFrames) {
  const auto file = encode_database(small_content(6));
  const auto with_range = [&](int begin, int end) {
    return complaint(forged(file, [&](Metadata& metadata, Arrays&) {
      auto clips = nlohmann::json::parse(metadata["clips"]);
      clips[0]["begin"] = begin;
      clips[0]["end"] = end;
      metadata["clips"] = clips.dump();
    }));
  };
  EXPECT_EQ(with_range(0, 6), "");
  for (const auto& [begin, end] : {std::pair{1, 6}, {0, 5}, {0, 7}, {0, 0}, {3, 2}, {-1, 6}})
    EXPECT_NE(with_range(begin, end), "") << begin << " " << end;
}

// The content with one source skeleton, and what a file says of where it comes from.
DatabaseContent content_with_sources() {
  DatabaseContent content = small_content(6);
  content.sources.skeletons = {{"5", 31, {{"ltibia", "LeftLeg"}}, 0.01}};
  content.sources.skipped = {{"bad.bvh", "bad.bvh:1: is no BVH"}};
  content.sources.duplicates = {{"b.bvh", "b.bvh: the same file as a.bvh"}};
  Clip& clip = content.clips[0];
  clip.skeleton = "5";
  clip.skeleton_hash = "fedcba9876543210";
  clip.origin = "a studio";
  clip.license = "CC0";
  clip.source_frames = 700;
  clip.source_rate_hz = 120.0;
  clip.warnings = {{"an odd unit", 2}};
  return content;
}

TEST(MotionDatabase, GivesBackWhatItWasToldOfItsSources) {
  const DatabaseContent content = content_with_sources();
  const auto database = database_of(content);
  EXPECT_EQ(database->sources().skeletons, content.sources.skeletons);
  EXPECT_EQ(database->sources().skipped, content.sources.skipped);
  EXPECT_EQ(database->sources().duplicates, content.sources.duplicates);
  const Clip& clip = database->clips()[0];
  EXPECT_EQ(clip.skeleton, "5");
  EXPECT_EQ(clip.skeleton_hash, "fedcba9876543210");
  EXPECT_EQ(clip.origin, "a studio");
  EXPECT_EQ(clip.license, "CC0");
  EXPECT_EQ(clip.source_frames, 700);
  EXPECT_EQ(clip.source_rate_hz, 120.0);
  EXPECT_EQ(clip.warnings, (std::map<std::string, int>{{"an odd unit", 2}}));
  EXPECT_EQ(encode_database(database_content(*database)), encode_database(content));
}

TEST(MotionDatabase, OpensDatabasesThatDoNotSayWhereTheyComeFrom) {
  const auto file =
      forged(encode_database(content_with_sources()), [](Metadata& metadata, Arrays&) {
        metadata.erase("sources");
        auto clips = nlohmann::json::parse(metadata["clips"]);
        for (const char* key : {"skeleton", "skeleton_hash", "origin", "license", "source_frames",
                                "source_rate_hz", "warnings"})
          EXPECT_EQ(clips[0].erase(key), 1U) << key;
        metadata["clips"] = clips.dump();
      });
  const auto database = MotionDatabase::from_bytes(own_bytes(file), "old.smdb");
  EXPECT_EQ(database->clips()[0].source, "clip0.bvh");
  EXPECT_EQ(database->clips()[0].source_frames, 0);
  EXPECT_TRUE(database->sources().skeletons.empty());
}

TEST(MotionDatabase, RefusesImpossibleSources) {
  const auto file = encode_database(content_with_sources());
  const auto complaint_of = [&](const std::string& key, const std::string& from,
                                const std::string& to) {
    return complaint(forged(file, [&](Metadata& metadata, Arrays&) {
      metadata[key] = testing::replaced(metadata[key], from, to);
    }));
  };
  EXPECT_TRUE(contains(complaint_of("clips", "\"skeleton\":\"5\"", "\"skeleton\":\"6\""),
                       "names an unknown skeleton"));
  EXPECT_TRUE(contains(complaint_of("clips", ":700", ":-1"), "has an impossible source"));
  EXPECT_TRUE(contains(complaint_of("clips", ":120.0", ":-1"), "has an impossible source"));
  EXPECT_TRUE(contains(complaint_of("clips", "\"tempo\":1.0", "\"tempo\":0"), "impossible tempo"));
  EXPECT_TRUE(contains(complaint_of("clips", "\"CC0\"", "7"), "metadata is damaged"));
  EXPECT_TRUE(contains(complaint_of("sources", ":0.01", ":-1"), "skeleton '5' of its sources"));
  EXPECT_TRUE(contains(complaint_of("sources", ":31", ":0"), "skeleton '5' of its sources"));
  EXPECT_TRUE(contains(complaint_of("sources", "\"skipped\"", "\"x\""), "metadata is damaged"));
  EXPECT_TRUE(contains(complaint_of("sources", "{", "["), "metadata is damaged"));
}

TEST(MotionDatabase, WritesTheSameFileInPieces) {
  const DatabaseContent content = content_of({swaying_motion(template_skeleton(), 1, 50, 50.0),
                                              swaying_motion(template_skeleton(), 2, 37, 50.0)},
                                             25.0);
  const TemporaryFolder folder;
  write_database(folder / "motions.smdb", content);
  const auto bytes = map_file(folder / "motions.smdb");
  const auto encoded = encode_database(content);
  EXPECT_TRUE(
      std::equal(encoded.begin(), encoded.end(), bytes->view().begin(), bytes->view().end()));
}

TEST(MotionDatabase, NamesFilesThatAreNotUtf8) {
  DatabaseContent content = small_content(5);
  content.clips[0].source = "m\xFC\x6C.bvh";
  EXPECT_EQ(complaint(encode_database(content)), "");
}

TEST(MotionDatabase, RefusesDirectionsThatAreNoDirections) {
  const auto file = encode_database(small_content(4));
  const std::int16_t bad = 0x0101;
  EXPECT_TRUE(contains(complaint(forged(file,
                                        [&](Metadata&, Arrays& arrays) {
                                          std::memcpy(arrays["sites/head/up"].data() + 2, &bad, 2);
                                        })),
                       "a direction has not unit length"));
}

TEST(MotionDatabase, RefusesValuesThatAreNoNumbers) {
  const auto file = encode_database(small_content(4));
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::infinity()}) {
    const auto with_bad = [&](const std::string& name) {
      return complaint(forged(file, [&](Metadata&, Arrays& arrays) {
        std::memcpy(arrays[name].data() + arrays[name].size() - 4, &bad, 4);
      }));
    };
    EXPECT_TRUE(contains(with_bad("root_motion"), "not a number"));
    for (const std::string name : {"angles", "positions", "sites/head/up"})
      EXPECT_TRUE(
          contains(with_bad(name + "/scale"), "a scale of the array '" + name + "' is impossible"));
  }
}

TEST(MotionDatabase, RefusesContactsThatAreNeither) {
  const auto file = encode_database(small_content(4));
  EXPECT_TRUE(
      contains(complaint(forged(
                   file, [](Metadata&, Arrays& arrays) { arrays["contacts"][5] = std::byte{2}; })),
               "a contact is neither 0 nor 1"));
}

TEST(MotionDatabase, KeepsItsContentWhenTheFileIsReplaced) {
  const TemporaryFolder folder;
  const auto path = folder / "motions.smdb";
  const auto write = [&](const std::vector<std::byte>& file) {
    const std::span<const std::byte> piece(file);
    write_file_atomically(path, std::span(&piece, 1));
  };
  write(encode_database(small_content(30)));
  const auto database = MotionDatabase::open(path);
  const DatabaseRows::Rows before = database->angles().all();
  write(encode_database(small_content(4)));
  EXPECT_EQ(database->angles().all(), before);
  EXPECT_EQ(MotionDatabase::open(path)->num_frames(), 4);
}

TEST(MotionDatabase, RefusesImpossibleTakes) {
  DatabaseContent content = small_content(20);
  PackedSite& site = content.clip_rows[0].sites[0];
  DatabaseRows::Rows turned = DatabaseRows::Rows::Zero(20, 4);
  turned.col(0).setOnes();
  site.orientation = packed(turned);
  content.clips[0].take =
      ClipTake{"take.csv", "hash", 1.5, 0.9, 1.0, {{content.site_names[0], Channel::orientation}}};
  EXPECT_EQ(complaint(encode_database(content)), "");
  EXPECT_EQ(database_of(content)->clips()[0].take, content.clips[0].take);
  site.orientation = packed(DatabaseRows::Rows(1.1F * turned));
  EXPECT_TRUE(contains(complaint(encode_database(content)), "an orientation has not unit length"));
  site.orientation = packed(turned);
  for (const auto& change : std::vector<std::function<void(ClipTake&)>>{
           [](ClipTake& take) { take.channels["nowhere"] = Channel::orientation; },
           [](ClipTake& take) { take.correlation = 7.0; },
           [](ClipTake& take) { take.coverage = -0.1; }}) {
    DatabaseContent changed = content;
    change(*changed.clips[0].take);
    EXPECT_TRUE(contains(complaint(encode_database(changed)), "has an impossible take"));
  }
}

}  // namespace
}  // namespace sparse_mocap
