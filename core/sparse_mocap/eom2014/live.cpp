// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/eom2014/live.hpp"

#include <algorithm>
#include <cmath>

#include "sparse_mocap/eom2014/heading_rate.hpp"
#include "sparse_mocap/motion/contacts.hpp"
#include "sparse_mocap/motion/heading.hpp"

namespace sparse_mocap::eom2014 {
namespace {

constexpr double kBehind_s = 1.0;    // of readings before a pose, that it depends on
constexpr Eigen::Index kAround = 8;  // poses to both sides that smoothing and feet look at
constexpr double kKept_s = 8.0;      // of readings that tell how the sensor is worn
constexpr double kShortestWorn_s = 2.0;
constexpr int kMostCompared = 50;  // instants of those; few, so that no frame is late
constexpr int kMostFound = 6;      // times, a second apart; by then the sensor is known

std::size_t frames_in(double seconds, double rate_hz) {
  return static_cast<std::size_t>(std::lround(seconds * rate_hz));
}

}  // namespace

LiveReconstructor::LiveReconstructor(const MethodSettings& settings, const MethodContext& context)
    : model_(settings, context),
      lag_frames_(static_cast<int>(std::lround(1e-3 * model_.config().lag_ms * rate_hz()))) {}

double LiveReconstructor::history_s() const { return kBehind_s; }

void LiveReconstructor::reset() {
  kept_.clear();
  turning_errors_.clear();
  next_ = 0;
  num_seen_ = num_found_ = 0;
  worn_ = {};
  place_.setZero();
  yaw_rad_ = 0.0;
}

void LiveReconstructor::keep(const Reading& reading) {
  require_sensors(reading, 1);
  Kept kept;
  kept.time_s = reading.time_s;
  kept.reading << reading.specific_force.col(0).transpose(),
      reading.angular_velocity.col(0).transpose();
  kept.turning = turning_rate(reading);
  // A silent sensor is taken to go on as it was.
  if (!kept.reading.allFinite())
    kept.reading = kept_.empty() ? model_.known().scale.mean : kept_.back().reading;
  kept_.push_back(kept);
  ++num_seen_;
}

ReadingRows LiveReconstructor::kept_rows(std::size_t begin) const {
  ReadingRows rows(static_cast<Eigen::Index>(kept_.size() - begin), 6);
  for (std::size_t i = begin; i < kept_.size(); ++i)
    rows.row(static_cast<Eigen::Index>(i - begin)) = kept_[i].reading;
  return smoothed(rows, model_.config().reading_smoothing_s * rate_hz());
}

void LiveReconstructor::find_how_it_is_worn() {
  const auto second = static_cast<int>(frames_in(1.0, rate_hz()));
  if (num_found_ >= kMostFound || num_seen_ % second != 0) return;
  const ReadingRows rows = kept_rows(0);
  std::vector<std::string> notes;
  worn_.units = units_of(rows, notes);
  const bool is_enough = kept_.size() >= frames_in(kShortestWorn_s, rate_hz());
  if (!is_enough || !model_.is_moving(worn_.units.converted(rows))) return;
  notes.clear();
  worn_ = model_.worn(rows, kMostCompared, notes);
  notes_ = std::move(notes);
  ++num_found_;
}

std::optional<PoseEstimate> LiveReconstructor::step(const Reading& reading) {
  if (num_seen_ == 0) notes_.clear();
  keep(reading);
  find_how_it_is_worn();
  if (kept_.size() <= next_ + static_cast<std::size_t>(lag_frames_)) return std::nullopt;
  return next_pose();
}

std::vector<PoseEstimate> LiveReconstructor::flush() {
  std::vector<PoseEstimate> estimates;
  while (next_ < kept_.size()) estimates.push_back(next_pose());
  reset();
  return estimates;
}

PoseEstimate LiveReconstructor::next_pose() {
  const std::size_t behind = frames_in(kBehind_s, rate_hz());
  const std::size_t first = next_ > behind ? next_ - behind : 0;
  const ReadingRows readings = worn_.corrected(kept_rows(first));
  const auto at = static_cast<Eigen::Index>(next_ - first);
  const FrameRange range{std::max<Eigen::Index>(at - kAround, 0),
                         std::min(at + kAround + 1, readings.rows())};
  MappedFrames frames = model_.mapped(readings, range);
  const Eigen::Index frame = at - range.begin;
  if (model_.config().turns_by_gyroscope)
    turn_as_measured(frames, frame, first + static_cast<std::size_t>(range.begin));
  const Motion motion = model_.motion_of(frames);
  PoseEstimate estimate = model_.estimate(frames, motion, frame);
  place(frames, motion, frame, estimate);
  estimate.time_s = kept_[next_].time_s;
  estimate.contacts = foot_contacts(motion).col(frame);
  estimate.diagnostics["sensor_misfit_mps2"] = model_.force_misfits(readings, {at, at + 1});
  ++next_;
  forget_old();
  return estimate;
}

// All frames turn by what was measured over the last second and is there of those ahead.
void LiveReconstructor::turn_as_measured(MappedFrames& frames, Eigen::Index frame,
                                         std::size_t first_kept) {
  const auto error = [&](Eigen::Index at) {
    const double measured =
        worn_.corrected_turning(kept_[first_kept + static_cast<std::size_t>(at)].turning);
    return measured - frames.root_velocities(at, 2);
  };
  turning_errors_.push_back(error(frame));
  if (turning_errors_.size() > frames_in(2.0, rate_hz())) turning_errors_.pop_front();
  std::vector<double> errors(turning_errors_.begin(), turning_errors_.end());
  for (Eigen::Index ahead = frame + 1; ahead < frames.root_velocities.rows(); ++ahead)
    errors.push_back(error(ahead));
  const auto measured =
      Eigen::Map<const Eigen::VectorXd>(errors.data(), static_cast<Eigen::Index>(errors.size()));
  const Eigen::VectorXd mended =
      turned_as_measured(Eigen::VectorXd::Zero(measured.size()), measured, rate_hz());
  frames.root_velocities.col(2).array() +=
      mended[static_cast<Eigen::Index>(turning_errors_.size()) - 1];
}

// A step of the motion, which begins anew for each pose, goes on from where the last pose is.
void LiveReconstructor::place(const MappedFrames& frames, const Motion& motion, Eigen::Index frame,
                              PoseEstimate& estimate) {
  double yaw_rad = 0.0;  // of the motion's own frame
  for (Eigen::Index t = 1; t < frame; ++t) yaw_rad += frames.root_velocities(t, 2) / rate_hz();
  if (frame > 0) {
    const auto at = static_cast<std::size_t>(frame);
    const Vec3 step = motion.root_positions[at] - motion.root_positions[at - 1];
    place_ += yaw_rotation(yaw_rad_ - yaw_rad) * step;
    const double turn_rad = frames.root_velocities(frame, 2) / rate_hz();
    yaw_rad += turn_rad;
    yaw_rad_ += turn_rad;
  }
  estimate.rotations.front() = Quat(yaw_rotation(yaw_rad_ - yaw_rad)) * estimate.rotations.front();
  estimate.root_position.x() = place_.x();
  estimate.root_position.z() = place_.z();
}

void LiveReconstructor::forget_old() {
  const std::size_t most = frames_in(kKept_s, rate_hz());
  while (kept_.size() > most && next_ > frames_in(kBehind_s, rate_hz())) {
    kept_.pop_front();
    --next_;
  }
}

}  // namespace sparse_mocap::eom2014
