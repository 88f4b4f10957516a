// SPDX-License-Identifier: GPL-3.0-or-later
//
// Models and other further content in motion databases.
#include "sparse_mocap/database/stored_models.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <limits>

#include "formats/format_test_support.hpp"
#include "sparse_mocap/base/files.hpp"
#include "sparse_mocap/database/builder.hpp"
#include "sparse_mocap/database/container.hpp"
#include "sparse_mocap/database/database_content.hpp"
#include "sparse_mocap/database/model_file.hpp"
#include "sparse_mocap/formats/bvh.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap {
namespace {

namespace fs = std::filesystem;
using testing::contains;
using testing::error_of;
using testing::swaying_motion;
using testing::template_skeleton;
using testing::TemporaryFolder;

std::string content(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

Model model_of(const std::string& method, double value) {
  Model model;
  model.method = method;
  model.version = 2;
  model.metadata = {{"made_of", "walks"}};
  model.set("W", Eigen::MatrixXd(Eigen::MatrixXd::Constant(3, 2, value)));
  model.set("bias", Eigen::Vector3f(1, 2, 3));
  return model;
}

bool same(const Model& a, const Model& b) {
  return a.method == b.method && a.version == b.version && a.metadata == b.metadata &&
         a.tensors == b.tensors;
}

// A database of two clips, and motion files to add to it.
class StoredModels : public ::testing::Test {
 protected:
  StoredModels() {
    fs::create_directories(folder_ / "a");
    fs::create_directories(folder_ / "b");
    for (unsigned seed = 1; seed < 4; ++seed)
      write_bvh(folder_ / (seed < 3 ? "a" : "b") / ("anna_walk_" + std::to_string(seed) + ".bvh"),
                swaying_motion(template_skeleton(), seed, 90, 60.0));
    BuildOptions options;
    options.tempo_copies = {};
    build_database({folder_ / "a"}, path_, options);
  }

  // Rewrites the file as another program might that knows safetensors alone; without checksums for
  // what it adds.
  void rewrite(const std::vector<Tensor>& added, const std::map<std::string, std::string>& texts) {
    const std::string old = content(path_);
    SafetensorsView view = parse_safetensors(std::as_bytes(std::span(old)));
    view.tensors.insert(view.tensors.begin(), added.begin(), added.end());
    for (const auto& [key, text] : texts) view.metadata[key] = text;
    view.metadata["metadata_checksum"] = metadata_checksum(view.metadata);
    std::string file = safetensors_header(view.metadata, view.tensors);
    for (const auto& tensor : view.tensors)
      file.append(reinterpret_cast<const char*>(tensor.bytes.data()), tensor.bytes.size());
    write_file_atomically(path_, file);
  }

  const TemporaryFolder folder_;
  const fs::path path_ = folder_ / "motions.smdb";
};

TEST_F(StoredModels, ADatabaseWithoutModelsSaysSo) {
  const auto database = MotionDatabase::open(path_);
  EXPECT_TRUE(database->model_names().empty());
  EXPECT_EQ(error_of([&] { database->model("liu2011"); }),
            "0: : holds no model of 'liu2011'; it holds no models");
  EXPECT_EQ(error_of([&] { remove_model(path_, "liu2011"); }),
            "0: : holds no model of 'liu2011'; it holds no models");
}

TEST_F(StoredModels, GivesBackWhatWasStoredAndLeavesAllElseAlone) {
  const std::string before = content(path_);
  store_model(path_, model_of("liu2011", 0.1));
  store_model(path_, model_of("eom2014", 0.2));
  store_model(path_, model_of("liu2011", 0.3));
  const auto database = MotionDatabase::open(path_);
  EXPECT_EQ(database->model_names(), (std::vector<std::string>{"eom2014", "liu2011"}));
  EXPECT_TRUE(same(database->model("liu2011"), model_of("liu2011", 0.3)));
  EXPECT_TRUE(same(database->model("eom2014"), model_of("eom2014", 0.2)));
  EXPECT_EQ(database->model("eom2014").path, path_);
  EXPECT_TRUE(contains(error_of([&] { database->model("tautges2011"); }),
                       "it holds models of eom2014, liu2011"));
  remove_model(path_, "liu2011");
  EXPECT_EQ(MotionDatabase::open(path_)->model_names(), (std::vector<std::string>{"eom2014"}));
  remove_model(path_, "eom2014");
  EXPECT_EQ(content(path_), before);
}

TEST_F(StoredModels, StoresNoModelThatIsNotSoundAndLeavesTheFileThen) {
  const std::string before = content(path_);
  Model model = model_of("liu2011", std::numeric_limits<double>::infinity());
  EXPECT_THROW(store_model(path_, model), std::invalid_argument);
  EXPECT_THROW(store_model(folder_ / "none.smdb", model_of("liu2011", 1.0)), FormatError);
  EXPECT_EQ(content(path_), before);
}

TEST_F(StoredModels, AddAndDropKeepModels) {
  store_model(path_, model_of("liu2011", 0.1));
  const std::string before = content(path_);
  add_to_database(path_, {folder_ / "b"}, path_, ImportOptions());
  EXPECT_EQ(MotionDatabase::open(path_)->clips().size(), 3U);
  EXPECT_TRUE(same(MotionDatabase::open(path_)->model("liu2011"), model_of("liu2011", 0.1)));
  drop_from_database(path_, {"anna_walk_3.bvh"}, path_);
  EXPECT_EQ(content(path_), before);
}

TEST_F(StoredModels, AddDropAndStoreKeepWhatOtherProgramsPutThere) {
  const std::string bytes = "\1\2\3\4\5\6\7";
  const auto odd = std::as_bytes(std::span(bytes));
  rewrite({{"half", ElementType::f16, {1, 3}, odd.first(6)},
           {"one", ElementType::u8, {}, odd.last(1)},
           {"pad", ElementType::u8, {1}, odd.first(1)}},
          {{"a later version's", "\xC3\xA9 {\"x\":1}"}});
  const auto expect_kept = [&](std::size_t num_clips) {
    const auto database = MotionDatabase::open(path_);
    EXPECT_EQ(database->clips().size(), num_clips);
    EXPECT_EQ(database->further().metadata.at("a later version's"), "\xC3\xA9 {\"x\":1}");
    const Tensor* half = database->further().find("half");
    const Tensor* one = database->further().find("one");
    ASSERT_TRUE(half != nullptr && one != nullptr);
    EXPECT_EQ(half->type, ElementType::f16);
    EXPECT_EQ(half->shape, (std::vector<std::size_t>{1, 3}));
    EXPECT_TRUE(std::ranges::equal(half->bytes, odd.first(6)));
    EXPECT_EQ(one->shape, std::vector<std::size_t>());
    EXPECT_TRUE(std::ranges::equal(one->bytes, odd.last(1)));
  };
  expect_kept(2);
  add_to_database(path_, {folder_ / "b"}, path_, ImportOptions());
  expect_kept(3);
  drop_from_database(path_, {"anna_walk_3.bvh"}, path_);
  expect_kept(2);
  store_model(path_, model_of("liu2011", 0.5));
  expect_kept(2);
  remove_model(path_, "liu2011");
  expect_kept(2);
}

TEST_F(StoredModels, RefusesArraysOfItsOwnWithoutAChecksum) {
  const std::string bytes(4, '\0');
  rewrite({{"models/liu2011/W", ElementType::f32, {1}, std::as_bytes(std::span(bytes))}},
          {{"models", R"({"liu2011":{"version":1,"metadata":{}}})"}});
  EXPECT_TRUE(contains(error_of([&] { MotionDatabase::open(path_); }),
                       "the array 'models/liu2011/W' has no checksum"));
}

TEST_F(StoredModels, RefusesRowsWithoutAChecksum) {
  rewrite({}, {{"checksums", "{}"}});
  EXPECT_TRUE(contains(error_of([&] { MotionDatabase::open(path_); }),
                       "the array 'angles' has no checksum"));
}

TEST_F(StoredModels, RefusesAListOfModelsThatIsDamaged) {
  for (const char* list : {"", "[]", "{\"No\":{}}", "{\"liu2011\":1}", "{\"a\":{},\"a\":{}}"}) {
    const auto before = content(path_);
    rewrite({}, {{"models", list}});
    EXPECT_TRUE(contains(error_of([&] { MotionDatabase::open(path_); }),
                         "the list of its models is damaged"))
        << list;
    write_file_atomically(path_, before);
  }
}

TEST_F(StoredModels, OpensWithAModelThatItCannotUse) {
  const auto before = content(path_);
  for (const char* list : {"{\"liu2011\":{}}", "{\"liu2011\":{\"version\":\"1\",\"metadata\":{}}}",
                           "{\"liu2011\":{\"version\":0,\"metadata\":{}}}",
                           "{\"liu2011\":{\"version\":1,\"metadata\":[1]}}"}) {
    rewrite({}, {{"models", list}});
    const auto database = MotionDatabase::open(path_);
    EXPECT_TRUE(contains(error_of([&] { database->model("liu2011"); }),
                         "the model of 'liu2011' is not sound: "))
        << list;
    store_model(path_, model_of("liu2011", 1.0));
    EXPECT_TRUE(same(MotionDatabase::open(path_)->model("liu2011"), model_of("liu2011", 1.0)));
    write_file_atomically(path_, before);
  }
}

TEST_F(StoredModels, EachKindOfFileIsToldFromTheOther) {
  write_model(folder_ / "walk.smmodel", model_of("liu2011", 1.0));
  EXPECT_EQ(error_of([&] { MotionDatabase::open(folder_ / "walk.smmodel"); }),
            "0: : is a model, not a motion database; name a file that ends in .smdb");
  EXPECT_EQ(error_of([&] { read_model(path_); }),
            "0: : is a motion database, not a model; name a file that ends in .smmodel");
}

TEST_F(StoredModels, AddRefusesADatabaseWithOtherSites) {
  DatabaseContent other = database_content(*MotionDatabase::open(path_));
  other.site_names.pop_back();
  for (auto& rows : other.clip_rows) rows.sites.pop_back();
  write_database(path_, other);
  EXPECT_TRUE(
      contains(error_of([&] { add_to_database(path_, {folder_ / "b"}, path_, ImportOptions()); }),
               "holds the readings of other sensor sites"));
  drop_from_database(path_, {"anna_walk_1.bvh"}, path_);
  EXPECT_EQ(MotionDatabase::open(path_)->site_names(), other.site_names);
}

// Built by the first version of the program that wrote the format.
TEST(DatabaseVersions, OpensADatabaseOfVersionOne) {
  const fs::path path = fs::path(SPARSE_MOCAP_TEST_DATA_DIR) / "database_version_1.smdb";
  const auto database = MotionDatabase::open(path);
  EXPECT_EQ(database->num_frames(), 24);
  EXPECT_EQ(database->rate_hz(), 25.0);
  ASSERT_EQ(database->clips().size(), 2U);
  EXPECT_EQ(database->clips()[0].name, "ada_walk_01");
  EXPECT_EQ(database->clips()[1].actor, "bruno");
  EXPECT_EQ(database->clips()[1].end, 24);
  EXPECT_EQ(database->site_names().size(), 11U);
  EXPECT_NEAR(database->site(0).gravity_direction(20, 0), -0.18738838F, 5e-5F);
  EXPECT_NEAR(database->site(0).gravity_direction(20, 1), -0.9273776F, 5e-5F);
  EXPECT_TRUE(database->further().tensors.empty());
  EXPECT_TRUE(database->further().metadata.empty());
  const auto again = encode_database(database_content(*database));
  EXPECT_TRUE(std::ranges::equal(again, database->bytes()->view()));
  const auto opened = MotionDatabase::from_bytes(own_bytes(again), path);
  EXPECT_EQ(opened->rows_hash(), database->rows_hash());
}

}  // namespace
}  // namespace sparse_mocap
