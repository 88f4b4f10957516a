// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/formats/other_formats.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "sparse_mocap/base/text_scanner.hpp"

namespace sparse_mocap {
namespace {

constexpr const char* kByBlender = "import it with Blender and build from what is in that file";
constexpr const char* kMarkers = "holds markers in space, not the turns of a skeleton";
constexpr const char* kSolve = "solve it onto a skeleton with a program for that and export BVH";
constexpr const char* kUnpack = "unpack it";
constexpr const char* kWebPage = "is a web page, perhaps the error page of a download";
constexpr const char* kAgain = "download the file again";

constexpr std::array kByEnding{
    OtherFormat{".fbx", "is an FBX file", kByBlender},
    OtherFormat{".glb", "is a GLB file", kByBlender},
    OtherFormat{".gltf", "is a glTF file", kByBlender},
    OtherFormat{".vrm", "is a VRM file", kByBlender},
    OtherFormat{".vrma", "is a VRM animation", kByBlender},
    OtherFormat{".usd", "is a USD file", kByBlender},
    OtherFormat{".usda", "is a USD file", kByBlender},
    OtherFormat{".usdc", "is a USD file", kByBlender},
    OtherFormat{".usdz", "is a USD file", kByBlender},
    OtherFormat{".dae", "is a Collada file", kByBlender},
    OtherFormat{".blend", "is a Blender file", "open it in Blender and build from what is in it"},
    OtherFormat{".c3d", kMarkers, kSolve},
    OtherFormat{".trc", kMarkers, kSolve},
    OtherFormat{".mot", "is an OpenSim motion", "export BVH"},
    OtherFormat{".htr", "is an HTR file", "export BVH"},
    OtherFormat{".bip", "is a Biped file", "export BVH"},
    OtherFormat{".pkl", "is a Python pickle, which can run any program", "save it as .npz"},
    OtherFormat{".gz", "is compressed", kUnpack},
    OtherFormat{".zip", "is an archive", kUnpack},
    OtherFormat{".7z", "is an archive", kUnpack},
};

constexpr std::array kByContent{
    OtherFormat{"kaydara fbx binary", "is a binary FBX file", kByBlender},
    OtherFormat{"; fbx", "is an FBX file", kByBlender},
    OtherFormat{"gltf", "is a GLB file", kByBlender},
    OtherFormat{"\x1f\x8b", "is compressed (gzip)", kUnpack},
    OtherFormat{"pk\x03\x04", "is a zip archive", kUnpack},
    OtherFormat{"7z\xbc\xaf", "is a 7z archive", kUnpack},
    OtherFormat{"<!doctype", kWebPage, kAgain},
    OtherFormat{"<html", kWebPage, kAgain},
    OtherFormat{"version https://git-lfs", "only points to a file that Git LFS keeps",
                "fetch it with 'git lfs pull'"},
};

}  // namespace

const OtherFormat* other_format_by_ending(const std::filesystem::path& path) {
  const std::string ending = lower_case(path.extension().string());
  const auto* at = std::find_if(kByEnding.begin(), kByEnding.end(),
                                [&](const OtherFormat& other) { return other.mark == ending; });
  return at == kByEnding.end() ? nullptr : at;
}

const OtherFormat* other_format_by_content(std::string_view content) {
  constexpr std::size_t kLongest = 32;
  content.remove_prefix(std::min(content.find_first_not_of(" \t\r\n"), content.size()));
  const std::string begin = lower_case(content.substr(0, kLongest));
  const auto* at =
      std::find_if(kByContent.begin(), kByContent.end(),
                   [&](const OtherFormat& other) { return begin.starts_with(other.mark); });
  return at == kByContent.end() ? nullptr : at;
}

}  // namespace sparse_mocap
