// SPDX-License-Identifier: GPL-3.0-or-later
// A made-up method: holds the first pose of the clip that it was trained from.
#include "sparse_mocap/database/model.hpp"
#include "sparse_mocap/motion/standard_skeleton.hpp"
#include "sparse_mocap/reconstruction/method_info.hpp"

namespace sparse_mocap::held_pose {
namespace {
struct HeldPose : WholeTakeMethod {
  const Skeleton& skeleton() const override { return skeleton_; }
  double rate_hz() const override { return 30.0; }
  std::vector<PoseEstimate> solve(const std::vector<Reading>& take, const Progress&) override {
    pose_.root_position.y() = height_m;
    std::vector<PoseEstimate> poses(take.size(), pose_);
    for (std::size_t t = 0; t < take.size(); ++t) poses[t].time_s = take[t].time_s;
    return poses;
  }

  double height_m = 0.9;
  PoseEstimate pose_;
  Skeleton skeleton_ = make_standard_skeleton(template_bones());
};

const auto kOptions = OptionTable<HeldPose>().number("height_m", &HeldPose::height_m, 0.0, 3.0,
                                                     "height of the pelvis above the floor, m");

std::unique_ptr<WholeTakeMethod> make(const MethodSettings& settings, const MethodContext& given) {
  auto method = std::make_unique<HeldPose>();
  kOptions.apply(settings.options, *method);
  const auto rotations = given.model->matrix<double>("rotations", kNumStandardJoints, 4);
  for (const auto& q : rotations.rowwise())
    method->pose_.rotations.emplace_back(q[0], q[1], q[2], q[3]);
  return method;
}

Model train(const MethodSettings&, const std::vector<TrainingClip>& clips, const Progress&) {
  Eigen::MatrixX4d rotations(kNumStandardJoints, 4);
  for (int j = 0; j < kNumStandardJoints; ++j) {
    const Quat& q = clips.front().motion.rotation(0, j);
    rotations.row(j) << q.w(), q.x(), q.y(), q.z();
  }
  Model model{"held_pose", 1, {{"clip", clips.front().name}}, {}, {}};
  model.set("rotations", rotations);
  return model;
}

}  // namespace

MethodEntry method() {
  MethodInfo info;
  info.name = "held_pose", info.title = "Held pose";
  info.summary = "Holds the pose that a clip begins with.";
  info.presets = {{"default", "Still."}};
  info.options = kOptions.described(HeldPose());
  info.required_channels = Channel::specific_force;
  info.most_sensors = 4, info.needs_model = true;
  return {info, nullptr, make, train};
}

}  // namespace sparse_mocap::held_pose
