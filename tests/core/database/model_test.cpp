// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/model.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "formats/format_test_support.hpp"
#include "sparse_mocap/base/checksum.hpp"
#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/database/container.hpp"
#include "sparse_mocap/database/model_file.hpp"

namespace sparse_mocap {
namespace {

using testing::contains;
using testing::error_of;
using testing::TemporaryFolder;

Model small_model() {
  Model model;
  model.method = "liu2011";
  model.version = 3;
  model.metadata = {{"subjects", "12"}, {"note", "made of \"walks\" \xC3\xA9"}};
  model.set("W", (Eigen::MatrixXd(2, 3) << 1, 2, 3, 4, 5, 6).finished());
  model.set("bias", Eigen::VectorXf(Eigen::VectorXf::LinSpaced(5, -1.0F, 1.0F)));
  model.set("parents", Eigen::Matrix<std::int32_t, 3, 1>(-1, 0, 1));
  model.set("counts", Eigen::Matrix<std::int64_t, 1, 2>(std::int64_t{1} << 40, -7));
  model.set("is_left", Eigen::Matrix<std::uint8_t, 3, 1>(1, 0, 255));
  return model;
}

// What reading these bytes as a model complains about, "" if nothing.
std::string complaint(const std::vector<std::byte>& file) {
  try {
    model_from_bytes(file, "walk.smmodel");
  } catch (const FormatError& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with("walk.smmodel: ")) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.what();
  }
  return "";
}

// The small model's file with its metadata changed, and checksums that fit unless told otherwise.
template <typename Change>
std::vector<std::byte> forged(const Change& change, bool with_checksums = true) {
  const auto file = encode_model(small_model());
  SafetensorsView view = parse_safetensors(file);
  change(view.metadata);
  if (!with_checksums) view.metadata["checksums"] = "{}";
  std::string all;
  for (const auto& [key, value] : view.metadata)
    if (key != "metadata_checksum") all += key + '\0' + value + '\0';
  view.metadata["metadata_checksum"] = checksum(std::as_bytes(std::span(all)));
  const std::string header = safetensors_header(view.metadata, view.tensors);
  std::vector<std::byte> out(header.size());
  std::memcpy(out.data(), header.data(), header.size());
  for (const auto& t : view.tensors) out.insert(out.end(), t.bytes.begin(), t.bytes.end());
  return out;
}

using Metadata = std::map<std::string, std::string>;

TEST(Model, RefusesWhatIsNoModel) {
  Model model = small_model();
  EXPECT_NO_THROW(check_model(model));
  const auto expect = [](const Model& bad, const std::string& part) {
    try {
      check_model(bad);
      ADD_FAILURE() << part;
    } catch (const std::invalid_argument& error) {
      EXPECT_TRUE(contains(error.what(), part)) << error.what();
    }
    EXPECT_THROW(encode_model(bad), std::invalid_argument);
  };
  for (const char* name : {"", "Liu", "2liu", "liu-2011", "a/b", "liu 2011", "\xC3\xA9"}) {
    Model bad = model;
    bad.method = name;
    expect(bad, "method's name");
  }
  for (const int version : {0, -1, std::numeric_limits<int>::max()}) {
    Model bad = model;
    bad.version = version;
    expect(bad, "version");
  }
  for (const auto& name : {std::string(), std::string(256, 'a'), std::string("__metadata__")}) {
    Model bad = model;
    bad.tensors[name] = bad.tensors["W"];
    expect(bad, "tensor's name");
  }
  Model bad = model;
  bad.tensors["W"].shape = {3, 3};
  expect(bad, "size of its shape");
  bad.tensors["W"].shape = {std::size_t{1} << 62, 0, std::size_t{1} << 62};
  expect(bad, "size of its shape");
  for (const double value : {std::numeric_limits<double>::quiet_NaN(), -HUGE_VAL}) {
    Model odd = model;
    odd.set("W", Eigen::Vector2d(0.0, value));
    expect(odd, "'W' holds a value that is not a number");
    odd = model;
    odd.set("bias", Eigen::Vector2f(0.0F, static_cast<float>(value)));
    expect(odd, "'bias' holds a value that is not a number");
  }
}

TEST(Model, WritesNoTextThatIsNotUtf8) {
  Model model = small_model();
  model.metadata["note"] = "\xff";
  EXPECT_THROW(encode_model(model), std::invalid_argument);
  model = small_model();
  model.tensors["\xff"] = model.tensors["W"];
  EXPECT_THROW(encode_model(model), std::invalid_argument);
}

TEST(Model, KeepsRowsOneAfterAnother) {
  const Model model = small_model();
  EXPECT_EQ(model.tensors.at("W").shape, (std::vector<std::size_t>{2, 3}));
  const std::vector<double> expected{1, 2, 3, 4, 5, 6};
  ASSERT_EQ(model.tensors.at("W").bytes.size(), 48U);
  EXPECT_EQ(std::memcmp(model.tensors.at("W").bytes.data(), expected.data(), 48), 0);
  EXPECT_EQ(model.matrix<double>("W")(1, 0), 4.0);
  EXPECT_EQ(model.matrix<double>("W", 2, 3)(0, 2), 3.0);
  EXPECT_EQ(model.vector<float>("bias", 5)[4], 1.0F);
  EXPECT_EQ(model.vector<std::int32_t>("parents")[0], -1);
  EXPECT_EQ(model.vector<std::int64_t>("counts")[0], 1099511627776);
  EXPECT_EQ(model.vector<std::uint8_t>("is_left")[2], 255);
}

TEST(Model, SaysWhatIsWrongWithAnArray) {
  Model model = small_model();
  model.path = "walk.smmodel";
  EXPECT_EQ(error_of([&] { model.matrix<double>("V"); }),
            "0: : the model of 'liu2011' has no tensor 'V', it has W, bias, counts, "
            "is_left, parents; train it again with this version");
  EXPECT_EQ(error_of([&] { model.matrix<float>("W"); }),
            "0: : the tensor 'W' of the model of 'liu2011' has elements F64, not F32; "
            "train it again with this version");
  const auto shape_error = [](const std::string& wanted) {
    return "0: : the tensor 'W' of the model of 'liu2011' has shape (2, 3), not " + wanted +
           "; train it again with this version";
  };
  EXPECT_EQ(error_of([&] { model.matrix<double>("W", 3); }), shape_error("(3, any)"));
  EXPECT_EQ(error_of([&] { model.matrix<double>("W", {}, 2); }), shape_error("(any, 2)"));
  EXPECT_EQ(error_of([&] { model.vector<double>("W"); }), shape_error("(any)"));
}

TEST(Model, FileGivesBackWhatWasWritten) {
  const TemporaryFolder folder;
  const Model model = small_model();
  write_model(folder / "walk.smmodel", model);
  const Model read = read_model(folder / "walk.smmodel");
  EXPECT_EQ(read.method, "liu2011");
  EXPECT_EQ(read.version, 3);
  EXPECT_EQ(read.metadata, model.metadata);
  EXPECT_EQ(read.tensors, model.tensors);
  EXPECT_EQ(read.path, folder / "walk.smmodel");
  Model bare;
  bare.method = "eom2014";
  EXPECT_TRUE(model_from_bytes(encode_model(bare), "m").tensors.empty());
}

TEST(Model, FileHasEveryArrayAligned) {
  const auto file = encode_model(small_model());
  const SafetensorsView view = parse_safetensors(file);
  ASSERT_EQ(view.tensors.size(), 5U);
  for (const auto& tensor : view.tensors)
    EXPECT_EQ((tensor.bytes.data() - file.data()) % static_cast<int>(size_of(tensor.type)), 0)
        << tensor.name;
}

TEST(Model, RefusesAFileCutAtAnyLengthOrWithAnyByteDamaged) {
  const auto file = encode_model(small_model());
  ASSERT_EQ(complaint(file), "");
  for (std::size_t i = 0; i < file.size(); ++i) {
    ASSERT_NE(complaint({file.begin(), file.begin() + static_cast<std::ptrdiff_t>(i)}), "") << i;
    for (unsigned bit = 0; bit < 8; ++bit) {
      auto damaged = file;
      damaged[i] ^= std::byte{static_cast<unsigned char>(1U << bit)};
      ASSERT_NE(complaint(damaged), "") << "byte " << i << ", bit " << bit;
    }
  }
}

TEST(Model, RefusesClaimsThatAreChecksummedButFalse) {
  const auto expect = [](const std::string& key, const std::string& value, const char* part) {
    const auto text = complaint(forged([&](Metadata& metadata) { metadata[key] = value; }));
    EXPECT_TRUE(contains(text, part)) << key << " = " << value << " -> " << text;
  };
  EXPECT_EQ(complaint(forged([](Metadata&) {})), "");
  expect("format", "something", "something else");
  expect("format_version", "2", "of format version 2, and this program reads version 1; update");
  expect("format_version", "0", "of format version 0, and this program reads version 1; train it");
  expect("format_version", "1.0\n", "format version 1.0?, and");
  expect("method", "No Method", "method's name");
  expect("model_version", "0", "version cannot be 0");
  expect("model_version", "1x", "version is not a number");
  expect("model_version", "99999999999", "version is not a number");
  expect("metadata", "[]", "metadata are no texts");
  expect("metadata", "{\"a\":1}", "metadata are no texts");
  expect("metadata", "{\"a\":\"1\",\"a\":\"2\"}", "repeats the key 'a'");
  for (const std::string key :
       {"format_version", "method", "model_version", "metadata", "checksums"}) {
    const auto text = complaint(forged([&](Metadata& metadata) { metadata.erase(key); }));
    EXPECT_TRUE(contains(text, "'" + key + "' is missing")) << text;
  }
  EXPECT_TRUE(contains(complaint(forged([](Metadata&) {}, false)), "has no checksum"));
}

}  // namespace
}  // namespace sparse_mocap
