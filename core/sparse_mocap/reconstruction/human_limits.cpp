// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/reconstruction/human_limits.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

namespace sparse_mocap {
namespace {

// The fastest turns and widest ranges in HDM05 and CMU motions, and a little more; for both sides.
struct NamedLimit {
  std::string_view joint;  // its name without l or r
  double fastest_degps, farthest_deg, least_deg, most_deg;
};

constexpr std::array kLimits{
    NamedLimit{"root", 900, 0, 0, 0},       NamedLimit{"femur", 1000, 130, 0, 0},
    NamedLimit{"tibia", 1400, 0, -10, 170}, NamedLimit{"lowerback", 700, 100, 0, 0},
    NamedLimit{"upperback", 500, 60, 0, 0}, NamedLimit{"thorax", 500, 60, 0, 0},
    NamedLimit{"lowerneck", 700, 70, 0, 0}, NamedLimit{"upperneck", 600, 70, 0, 0},
    NamedLimit{"head", 400, 50, 0, 0},      NamedLimit{"clavicle", 700, 60, 0, 0},
    NamedLimit{"humerus", 1400, 0, 0, 0},   NamedLimit{"radius", 1000, 0, -10, 160},
    NamedLimit{"wrist", 1400, 0, 0, 0},
};

const NamedLimit* limit_of(std::string_view joint) {
  for (const NamedLimit& limit : kLimits)
    if (joint == limit.joint ||
        (joint.size() == limit.joint.size() + 1 && (joint.front() == 'l' || joint.front() == 'r') &&
         joint.substr(1) == limit.joint))
      return &limit;
  return nullptr;
}

// The rotation on the shortest way from one to another, at most so far from the first.
Quat at_most(const Quat& from, const Quat& to, double farthest_rad) {
  const double angle = from.angularDistance(to);
  return angle <= farthest_rad ? to : from.slerp(farthest_rad / angle, to);
}

class BoundedLive : public LiveMethod {
 public:
  explicit BoundedLive(std::unique_ptr<LiveMethod> method)
      : method_(std::move(method)), limits_(method_->skeleton(), method_->rate_hz()) {}

  const Skeleton& skeleton() const override { return method_->skeleton(); }
  double rate_hz() const override { return method_->rate_hz(); }
  GaussianFilter reading_filter() const override { return method_->reading_filter(); }
  std::vector<std::string> notes() const override { return method_->notes(); }
  double latency_s() const override { return method_->latency_s(); }
  double history_s() const override { return method_->history_s(); }

  std::optional<PoseEstimate> step(const Reading& reading) override {
    auto estimate = method_->step(reading);
    if (estimate) limits_.apply(*estimate);
    return estimate;
  }
  bool step_into(const Reading& reading, PoseEstimate& estimate) override {
    if (!method_->step_into(reading, estimate)) return false;
    limits_.apply(estimate);
    return true;
  }
  std::vector<PoseEstimate> flush() override {
    auto estimates = method_->flush();
    for (auto& estimate : estimates) limits_.apply(estimate);
    limits_.reset();
    return estimates;
  }
  void reset() override {
    method_->reset();
    limits_.reset();
  }

 private:
  std::unique_ptr<LiveMethod> method_;
  HumanLimits limits_;
};

class BoundedWholeTake : public WholeTakeMethod {
 public:
  explicit BoundedWholeTake(std::unique_ptr<WholeTakeMethod> method) : method_(std::move(method)) {}

  const Skeleton& skeleton() const override { return method_->skeleton(); }
  double rate_hz() const override { return method_->rate_hz(); }
  GaussianFilter reading_filter() const override { return method_->reading_filter(); }
  std::vector<std::string> notes() const override { return method_->notes(); }

  std::vector<PoseEstimate> solve(const std::vector<Reading>& take,
                                  const Progress& progress) override {
    auto estimates = method_->solve(take, progress);
    limit(estimates);
    return estimates;
  }
  std::vector<Alternative> alternatives() const override {
    auto alternatives = method_->alternatives();
    for (auto& alternative : alternatives) limit(alternative.estimates);
    return alternatives;
  }

 private:
  void limit(std::vector<PoseEstimate>& estimates) const {
    HumanLimits limits(skeleton(), rate_hz());
    for (auto& estimate : estimates) limits.apply(estimate);
  }

  std::unique_ptr<WholeTakeMethod> method_;
};

}  // namespace

HumanLimits::HumanLimits(const Skeleton& skeleton, double rate_hz) : skeleton_(skeleton) {
  for (const Joint& joint : skeleton.joints()) {
    const NamedLimit* limit = limit_of(joint.name);
    limits_.push_back(limit == nullptr ? Limit()
                                       : Limit{limit->fastest_degps * kRadiansPerDegree / rate_hz,
                                               limit->farthest_deg * kRadiansPerDegree,
                                               limit->least_deg * kRadiansPerDegree,
                                               limit->most_deg * kRadiansPerDegree});
  }
}

Quat HumanLimits::within_range(std::size_t joint, const Quat& rotation) const {
  const Limit& limit = limits_[joint];
  const Joint& described = skeleton_.joints()[joint];
  if (limit.farthest_rad > 0.0) return at_most(Quat::Identity(), rotation, limit.farthest_rad);
  if (limit.least_rad == limit.most_rad || described.axes.size() != 1) return rotation;
  // Near the middle of the range, so that beyond either end means nearer to it than to the other.
  const double middle = 0.5 * (limit.least_rad + limit.most_rad);
  double angle = 0.0;
  joint_angles(described, rotation.toRotationMatrix(), &middle, &angle);
  if (angle >= limit.least_rad && angle <= limit.most_rad) return rotation;
  angle = std::clamp(angle, limit.least_rad, limit.most_rad);
  return Quat(joint_rotation(described, &angle));
}

void HumanLimits::apply(PoseEstimate& estimate) {
  for (std::size_t j = 0; j < std::min(limits_.size(), estimate.rotations.size()); ++j) {
    Quat& rotation = estimate.rotations[j];
    rotation = within_range(j, rotation);
    if (!before_.empty() && limits_[j].fastest_rad > 0.0)
      rotation = at_most(before_[j], rotation, limits_[j].fastest_rad);
  }
  before_ = estimate.rotations;
}

std::optional<HingeRange> hinge_range(std::string_view joint) {
  const NamedLimit* limit = limit_of(joint);
  if (limit == nullptr || limit->least_deg == limit->most_deg) return std::nullopt;
  return HingeRange{limit->least_deg * kRadiansPerDegree, limit->most_deg * kRadiansPerDegree};
}

std::unique_ptr<LiveMethod> within_human_limits(std::unique_ptr<LiveMethod> method) {
  return std::make_unique<BoundedLive>(std::move(method));
}

std::unique_ptr<WholeTakeMethod> within_human_limits(std::unique_ptr<WholeTakeMethod> method) {
  return std::make_unique<BoundedWholeTake>(std::move(method));
}

}  // namespace sparse_mocap
