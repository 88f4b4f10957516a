// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <map>
#include <utility>

#include "sparse_mocap/formats/asf_sections.hpp"

namespace sparse_mocap {
namespace {

constexpr double kInch_m = 0.0254;
constexpr int kRoot = 0;  // node 0 is the root, node i + 1 is bone i of the file

// The parents and children of each node.
struct Tree {
  std::vector<int> parents;                // -1: none
  std::vector<std::vector<int>> children;  // in the order of the file
};

std::map<std::string, int> nodes_by_name(const TextScanner& scanner, const AsfSections& sections) {
  std::map<std::string, int> nodes{{"root", kRoot}};
  for (std::size_t i = 0; i < sections.bones.size(); ++i) {
    const auto& bone = sections.bones[i];
    if (!nodes.emplace(lower_case(bone.token), static_cast<int>(i) + 1).second)
      scanner.fail(bone.token, "a second bone is named " + in_quotes(bone.name),
                   "give it another name");
  }
  return nodes;
}

Tree resolve_tree(const TextScanner& scanner, const AsfSections& sections) {
  const auto nodes = nodes_by_name(scanner, sections);
  const auto node_of = [&](std::string_view name) {
    const auto found = nodes.find(lower_case(name));
    if (found == nodes.end())
      scanner.fail(name, "bone " + in_quotes(name) + " is not defined in :bonedata",
                   "define it there, or leave it out");
    return found->second;
  };
  Tree tree{std::vector<int>(nodes.size(), -1), std::vector<std::vector<int>>(nodes.size())};
  for (const auto& family : sections.families) {
    const int parent = node_of(family.parent);
    for (const auto name : family.children) {
      const int child = node_of(name);
      if (child == kRoot) scanner.fail(name, "the root cannot be a child", "leave it out");
      auto& known_parent = tree.parents[static_cast<std::size_t>(child)];
      if (known_parent >= 0)
        scanner.fail(name, "bone " + in_quotes(name) + " has two parents", "name it once");
      known_parent = parent;
      tree.children[static_cast<std::size_t>(parent)].push_back(child);
    }
  }
  return tree;
}

// The nodes, parents before children, in the order of the file otherwise.
std::vector<int> depth_first_order(const TextScanner& scanner, const AsfSections& sections,
                                   const Tree& tree, int max_depth) {
  struct Visit {
    int node;
    int depth;
  };
  std::vector<int> order;
  std::vector<char> is_visited(tree.parents.size(), 0);
  std::vector<Visit> pending{{kRoot, 1}};
  while (!pending.empty()) {
    const auto [node, depth] = pending.back();
    pending.pop_back();
    is_visited[static_cast<std::size_t>(node)] = 1;
    order.push_back(node);
    const auto& children = tree.children[static_cast<std::size_t>(node)];
    if (depth >= max_depth && !children.empty())
      scanner.fail(sections.bones[static_cast<std::size_t>(children[0]) - 1].token,
                   "bones are nested deeper than " + std::to_string(max_depth),
                   "raise the limit max_depth if that is intended");
    for (auto child = children.rbegin(); child != children.rend(); ++child)
      pending.push_back({*child, depth + 1});
  }
  for (std::size_t i = 0; i < sections.bones.size(); ++i) {
    if (is_visited[i + 1]) continue;
    const auto& bone = sections.bones[i];
    scanner.fail(
        bone.token,
        "bone " + in_quotes(bone.name) + " cannot be reached from the root: :hierarchy " +
            (tree.parents[i + 1] < 0 ? "does not mention it as a child" : "has a cycle above it"),
        "name each bone once as a child");
  }
  return order;
}

// The frame turned by angles (about x, y, z), the first axis of the order first.
Mat3 frame_of(const Vec3& angles, const std::array<Axis, 3>& order, double radians_per_angle) {
  Mat3 R = Mat3::Identity();
  for (const Axis axis : order) {
    const double angle = angles[static_cast<Eigen::Index>(axis)] * radians_per_angle;
    R = Eigen::AngleAxisd(angle, unit(axis)).toRotationMatrix() * R;
  }
  return R;
}

// The axes of the channels that turn, outermost (the last of the file) first.
std::vector<Axis> rotation_axes(const std::vector<AcclaimChannel>& channels) {
  std::vector<Axis> axes;
  for (auto channel = channels.rbegin(); channel != channels.rend(); ++channel)
    if (*channel <= AcclaimChannel::rz) axes.push_back(static_cast<Axis>(*channel));
  return axes;
}

Joint joint_of(const AsfBone& bone, int parent, const Mat3& R_preset,
               const AcclaimSkeleton& units) {
  Joint joint;
  joint.name = bone.name;
  joint.parent = parent;
  joint.bone = R_preset * bone.direction * (bone.length * units.metres_per_unit);
  joint.R_joint_axes =
      R_preset * frame_of(bone.axis_angles, bone.axis_order, units.radians_per_angle);
  joint.axes = rotation_axes(bone.channels);
  return joint;
}

void build_skeleton(const TextScanner& scanner, const AsfSections& sections,
                    const ReadOptions& options, AcclaimSkeleton& result) {
  const auto tree = resolve_tree(scanner, sections);
  const auto order = depth_first_order(scanner, sections, tree, options.max_depth);
  std::vector<int> joint_of_node(order.size(), -1);
  std::vector<Joint> joints(1);
  joints[0].name = "root";
  joints[0].R_joint_axes = frame_of(sections.root.orientation_angles, sections.root.axis_order,
                                    result.radians_per_angle);
  joints[0].axes = rotation_axes(sections.root.channels);
  const Mat3 R_preset = joints[0].R_joint_axes;
  result.channels.push_back(sections.root.channels);
  joint_of_node[kRoot] = 0;
  for (std::size_t i = 1; i < order.size(); ++i) {
    const auto node = static_cast<std::size_t>(order[i]);
    const auto& bone = sections.bones[node - 1];
    const int parent = joint_of_node[static_cast<std::size_t>(tree.parents[node])];
    joint_of_node[node] = static_cast<int>(joints.size());
    joints.push_back(joint_of(bone, parent, R_preset, result));
    if (joints.back().bone.cwiseAbs().maxCoeff() > kMaxLength_m)
      scanner.fail(bone.token, "bone " + in_quotes(bone.name) + " is impossibly long",
                   "check its length and the unit of the file");
    result.channels.push_back(bone.channels);
  }
  result.skeleton = Skeleton(std::move(joints));
}

}  // namespace

AcclaimSkeleton read_asf(const std::filesystem::path& path, const ReadOptions& options) {
  options.validate();
  return asf_from_text(read_motion_text(path, options), path, options);
}

AcclaimSkeleton asf_from_text(std::string text, const std::filesystem::path& path,
                              const ReadOptions& options) {
  options.validate();
  TextScanner scanner(path, std::move(text), kAcclaimSyntax);
  AcclaimSkeleton result;
  result.path = path;
  const auto sections = read_asf_sections(scanner, options, result.warnings);
  result.metres_per_unit = kInch_m / sections.length_unit;
  result.radians_per_angle = sections.is_in_degrees ? kRadiansPerDegree : 1.0;
  result.root_position = sections.root.position * result.metres_per_unit;
  if (result.root_position.cwiseAbs().maxCoeff() > kMaxLength_m)
    scanner.fail(sections.root.position_key, "the position of the root is out of range",
                 "check the number and the unit of the file");
  build_skeleton(scanner, sections, options, result);
  warn_about_size(rest_pose(result.skeleton), {path}, result.warnings);
  return result;
}

std::filesystem::path find_asf(const std::filesystem::path& amc_path) {
  const auto folder = amc_path.has_parent_path() ? amc_path.parent_path() : ".";
  std::map<std::string, std::filesystem::path> asf_by_stem;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const auto& candidate = entry->path();
    if (equal_ignoring_case(candidate.extension().string(), ".asf"))
      asf_by_stem.emplace(lower_case(candidate.stem().string()), candidate);
  }
  std::string wanted;
  for (std::string stem = lower_case(amc_path.stem().string()); !stem.empty();) {
    if (const auto found = asf_by_stem.find(stem); found != asf_by_stem.end()) return found->second;
    wanted += (wanted.empty() ? "" : ", ") + stem + ".asf";
    const auto cut = stem.find_last_of("_-. ");
    stem.resize(cut == std::string::npos ? 0 : cut);
  }
  if (asf_by_stem.size() == 1) return asf_by_stem.begin()->second;
  const std::string problem = asf_by_stem.empty()
                                  ? "there is no .asf in " + folder.string()
                                  : "none of the " + std::to_string(asf_by_stem.size()) +
                                        " .asf in " + folder.string() + " matches its name";
  throw FormatError({amc_path}, problem + "; looked for " + wanted,
                    "put the .asf of its actor into the same folder");
}

}  // namespace sparse_mocap
