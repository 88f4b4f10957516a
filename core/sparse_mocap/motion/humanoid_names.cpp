// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/motion/humanoid_names.hpp"

#include <array>
#include <cctype>

namespace sparse_mocap {
namespace {

using Names = std::vector<std::string_view>;

const std::array<Names, kNumStandardJoints>& table() {
  static const std::array<Names, kNumStandardJoints> names{{
      {"root", "hips", "hip", "pelvis"},
      {"lhipjoint"},
      {"lfemur", "leftupleg", "leftupperleg", "lefthip", "leftthigh", "lthigh", "upperlegl"},
      {"ltibia", "leftleg", "leftlowerleg", "leftknee", "leftshin", "lshin", "lowerlegl"},
      {"rhipjoint"},
      {"rfemur", "rightupleg", "rightupperleg", "righthip", "rightthigh", "rthigh", "upperlegr"},
      {"rtibia", "rightleg", "rightlowerleg", "rightknee", "rightshin", "rshin", "lowerlegr"},
      {"lowerback", "abdomen"},
      {"upperback", "spine"},
      {"thorax", "spine1", "chest"},
      {"lowerneck", "neck"},
      {"upperneck", "neck1"},
      {"head"},
      {"lclavicle", "leftshoulder", "leftcollar", "lcollar", "shoulderl"},
      {"lhumerus", "leftarm", "leftupperarm", "lshldr", "upperarml"},
      {"lradius", "leftforearm", "leftlowerarm", "leftelbow", "lforearm", "lowerarml"},
      {"lwrist", "lefthand", "leftwrist", "lhand", "handl"},
      {"rclavicle", "rightshoulder", "rightcollar", "rcollar", "shoulderr"},
      {"rhumerus", "rightarm", "rightupperarm", "rshldr", "upperarmr"},
      {"rradius", "rightforearm", "rightlowerarm", "rightelbow", "rforearm", "lowerarmr"},
      {"rwrist", "righthand", "rightwrist", "rhand", "handr"},
  }};
  return names;
}

}  // namespace

std::span<const std::string_view> known_names(standard_joint::Index joint) {
  return table()[static_cast<std::size_t>(joint)];
}

std::string normalised_joint_name(std::string_view name) {
  const auto colon = name.rfind(':');
  if (colon != std::string_view::npos) name.remove_prefix(colon + 1);
  std::string out;
  for (const char c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) != 0)
      out.push_back(static_cast<char>(std::tolower(static_cast<unsigned char>(c))));
  return out;
}

}  // namespace sparse_mocap
