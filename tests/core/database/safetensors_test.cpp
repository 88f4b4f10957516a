// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/database/safetensors.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "sparse_mocap/base/checksum.hpp"
#include "sparse_mocap/base/errors.hpp"
#include "support/refusals.hpp"

namespace sparse_mocap {
namespace {

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text));
}

// A file with this header, written by hand, and so many bytes of data.
std::string file_with(const std::string& header, std::size_t data_bytes) {
  const std::uint64_t size = header.size();
  std::string file(8, '\0');
  std::memcpy(file.data(), &size, 8);
  return file + header + std::string(data_bytes, '\1');
}

std::string array(const std::string& name, const std::string& dtype, const std::string& shape,
                  const std::string& offsets) {
  return "\"" + name + "\":{\"dtype\":\"" + dtype + "\",\"shape\":" + shape +
         ",\"data_offsets\":" + offsets + "}";
}

// What the parser complains about, "" if it accepts the file.
std::string complaint(const std::string& file) {
  try {
    parse_safetensors(bytes_of(file));
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

void expect_complaint(const std::string& header, std::size_t data_bytes, const std::string& part) {
  const std::string text = complaint(file_with(header, data_bytes));
  EXPECT_NE(text.find(part), std::string::npos) << header << " -> " << text;
}

TEST(Safetensors, ReadsWhatAHandWrittenFileHolds) {
  const std::string file =
      file_with("{\"__metadata__\":{\"who\":\"me\"}," + array("b", "F32", "[2,1]", "[4,12]") + "," +
                    array("a", "I32", "[1]", "[0,4]") + "}",
                12);
  const SafetensorsView view = parse_safetensors(bytes_of(file));
  EXPECT_EQ(view.metadata.at("who"), "me");
  ASSERT_EQ(view.tensors.size(), 2U);
  const Tensor& b = *view.find("b");
  EXPECT_EQ(b.type, ElementType::f32);
  EXPECT_EQ(b.shape, (std::vector<std::size_t>{2, 1}));
  EXPECT_EQ(b.bytes.size(), 8U);
  EXPECT_EQ(b.bytes.data(), bytes_of(file).data() + file.size() - 8);
  EXPECT_EQ(view.find("c"), nullptr);
}

TEST(Safetensors, WritesAHeaderThatEndsOnABoundaryAndReadsItBack) {
  const std::string data(20, '\7');
  const std::vector<Tensor> tensors{{"x", ElementType::f32, {3, 1}, bytes_of(data).first(12)},
                                    {"none", ElementType::f32, {0, 5}, {}},
                                    {"y", ElementType::i32, {2}, bytes_of(data).subspan(12)}};
  const std::string header = safetensors_header({{"k", "v \"quoted\" \n"}}, tensors);
  EXPECT_EQ(header.size() % 64, 0U);
  const std::string file = header + data;
  const auto view = parse_safetensors(bytes_of(file));
  EXPECT_EQ(view.metadata.at("k"), "v \"quoted\" \n");
  for (const auto& tensor : tensors) {
    const Tensor& read = *view.find(tensor.name);
    EXPECT_EQ(read.type, tensor.type);
    EXPECT_EQ(read.shape, tensor.shape);
    EXPECT_TRUE(std::ranges::equal(read.bytes, tensor.bytes));
  }
}

TEST(Safetensors, KnowsTheSizeOfEveryTypeOfWholeBytes) {
  const std::map<std::string, std::size_t> sizes{
      {"BOOL", 1}, {"U8", 1},  {"I8", 1},  {"F8_E5M2", 1}, {"F8_E4M3", 1}, {"F8_E8M0", 1},
      {"U16", 2},  {"I16", 2}, {"F16", 2}, {"BF16", 2},    {"U32", 4},     {"I32", 4},
      {"F32", 4},  {"U64", 8}, {"I64", 8}, {"F64", 8},     {"C64", 8}};
  for (const auto& [name, size] : sizes) {
    const auto end = std::to_string(3 * size);
    const auto file = file_with("{" + array("a", name, "[3]", "[0," + end + "]") + "}", 3 * size);
    ASSERT_EQ(complaint(file), "") << name;
    const auto view = parse_safetensors(bytes_of(file));
    EXPECT_EQ(name_of(view.tensors[0].type), name);
    EXPECT_EQ(size_of(view.tensors[0].type), size);
    EXPECT_NE(
        complaint(file_with("{" + array("a", name, "[2]", "[0," + end + "]") + "}", 3 * size)), "");
  }
}

TEST(Safetensors, WritesNoTextThatIsNotUtf8) {
  EXPECT_THROW(safetensors_header({{"k", "\xff"}}, {}), std::invalid_argument);
  EXPECT_THROW(safetensors_header({}, {{"\xff", ElementType::u8, {0}, {}}}), std::invalid_argument);
}

TEST(Safetensors, RefusesFilesThatAreSomethingElse) {
  EXPECT_NE(complaint(""), "");
  EXPECT_NE(complaint("1234567"), "");
  EXPECT_NE(complaint(std::string(8, '\0')), "");
  EXPECT_NE(complaint("PK\3\4" + std::string(100, '\0')), "");
  EXPECT_NE(complaint("\x80\4\x95" + std::string(100, '\0')), "") << "a pickle";
  EXPECT_NE(complaint("\x93NUMPY" + std::string(100, '\0')), "");
  EXPECT_NE(complaint(std::string(64, '\xff')), "") << "a header of 2^64 - 1 bytes";
  expect_complaint("not JSON", 0, "not JSON");
  expect_complaint("[]", 0, "not an object");
  expect_complaint("{} {}", 0, "not JSON");
  expect_complaint(std::string("{} \0 hidden", 11), 0, "not JSON");
  expect_complaint("{\"a\":" + std::string(100000, '['), 0, "not JSON");
  expect_complaint("{\"\xff\xfe\":1}", 0, "not JSON");
}

TEST(Safetensors, RefusesRepeatedKeysAtAnyDepth) {
  const std::string a = array("a", "F32", "[1]", "[0,4]");
  expect_complaint("{" + a + "," + a + "}", 4, "repeats the key 'a'");
  expect_complaint("{\"__metadata__\":{\"k\":\"1\",\"k\":\"2\"}}", 0, "repeats the key 'k'");
  expect_complaint(
      "{\"a\":{\"dtype\":\"F32\",\"dtype\":\"I32\",\"shape\":[1],\"data_offsets\":[0,4]}}", 4,
      "repeats the key 'dtype'");
}

TEST(Safetensors, RefusesOverlapsHolesAndBytesThatBelongToNoArray) {
  const auto two = [](const std::string& first, const std::string& second) {
    return "{" + array("a", "F32", "[2]", first) + "," + array("b", "F32", "[2]", second) + "}";
  };
  EXPECT_EQ(complaint(file_with(two("[0,8]", "[8,16]"), 16)), "");
  expect_complaint(two("[0,8]", "[4,12]"), 16, "overlap");
  expect_complaint(two("[0,8]", "[0,8]"), 16, "overlap");
  expect_complaint(two("[0,8]", "[12,20]"), 20, "hole");
  expect_complaint(two("[4,12]", "[12,20]"), 20, "hole");
  expect_complaint(two("[0,8]", "[8,16]"), 17, "follow the last array");
  expect_complaint(two("[0,8]", "[8,16]"), 15, "outside the file");
}

TEST(Safetensors, RefusesSizesThatCannotBe) {
  const auto one = [](const std::string& shape, const std::string& offsets) {
    return "{" + array("a", "F32", shape, offsets) + "}";
  };
  expect_complaint(one("[1]", "[8,4]"), 8, "outside the file");
  expect_complaint(one("[1]", "[0,18446744073709551615]"), 8, "outside the file");
  expect_complaint(one("[25000000000]", "[0,100000000000]"), 1000, "outside the file");
  expect_complaint(one("[3]", "[0,8]"), 8, "size of its shape");
  expect_complaint(one("[0]", "[0,8]"), 8, "size of its shape");
  expect_complaint(one("[4294967296,4294967296]", "[0,0]"), 0, "overflows");
  expect_complaint(one("[4611686018427387905]", "[0,4]"), 4, "overflows");
  expect_complaint(one("[-1]", "[0,4]"), 4, "bad shape");
  expect_complaint(one("[1.0]", "[0,4]"), 4, "bad shape");
  expect_complaint(one("[1]", "[0,4.0]"), 4, "bad offsets");
  expect_complaint(one("[1]", "[-4,4]"), 4, "bad offsets");
}

TEST(Safetensors, RefusesDamagedDescriptions) {
  expect_complaint("{" + array("a", "F4", "[2]", "[0,1]") + "}", 1, "element type 'F4'");
  expect_complaint("{" + array("a", "f32", "[1]", "[0,4]") + "}", 4, "element type 'f32'");
  expect_complaint("{\"a\":{\"dtype\":\"F32\",\"shape\":[1]}}", 4, "damaged");
  expect_complaint("{\"a\":7}", 4, "damaged");
  expect_complaint("{" + array("a", "F32", "[1]", "[0,2,4]") + "}", 4, "bad offsets");
  expect_complaint("{" + array("a", "F32", "[1]", "[0]") + "}", 4, "bad offsets");
  expect_complaint("{" + array("a", "F32", "1", "[0,4]") + "}", 4, "bad shape");
  expect_complaint("{\"__metadata__\":{\"k\":1}}", 0, "metadata");
  expect_complaint("{\"__metadata__\":[]}", 0, "metadata");
  std::string many = "{";
  for (int i = 0; i < 1100; ++i)
    many += (i == 0 ? "" : ",") + array("a" + std::to_string(i), "F32", "[0]", "[0,0]");
  expect_complaint(many + "}", 0, "too many arrays");
}

TEST(Safetensors, KnowsTheChecksumOfKnownBytes) {
  EXPECT_EQ(checksum({}), "2d06800538d394c2");  // XXH3 of nothing, as its authors publish it
  EXPECT_NE(checksum(bytes_of("a")), checksum(bytes_of("b")));
  EXPECT_EQ(checksum(bytes_of("abc")).size(), 16U);
}

}  // namespace
}  // namespace sparse_mocap
