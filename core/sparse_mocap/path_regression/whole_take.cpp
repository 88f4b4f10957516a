// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/path_regression/whole_take.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "sparse_mocap/path_regression/merged_motion.hpp"
#include "sparse_mocap/path_regression/take_fit.hpp"
#include "sparse_mocap/path_regression/take_headings.hpp"
#include "sparse_mocap/path_regression/take_search.hpp"

namespace sparse_mocap::path_regression {
namespace {

// Of the work, which take about as long: search, retrieval and fit; the poses and the fit of each
// alternative.
constexpr std::size_t kFirstParts = 3, kPartsOfAlternative = 2;

// Of the parts of an alternative.
constexpr double kAboutAsWell = 0.7;  // of the best path's reward: what paths must earn
constexpr double kShortest_s = 0.4;
constexpr double kEdge_s = 0.24;        // at its ends
constexpr double kAround_s = 0.5;       // before and after it, where the fit may still differ
constexpr double kWorthALook_m = 0.08;  // less apart it is not offered

std::size_t num_parts_of(const Config& config) {
  return kFirstParts + kPartsOfAlternative * static_cast<std::size_t>(config.alternatives);
}

// Reports the progress of one of these parts.
Progress part_of(const Progress& progress, std::size_t part, std::size_t num_parts,
                 std::size_t num_frames) {
  return Progress(Progress::Callback(
      [=, &progress](std::size_t done, std::size_t total, std::string_view what) {
        const std::size_t share = total > 0 ? num_frames * done / total : 0;
        progress.report(part * num_frames + share, num_parts * num_frames, what);
        return true;
      }));
}

// From 0 to 1, and flat beyond.
double smooth(double share) {
  const double s = std::clamp(share, 0.0, 1.0);
  return s * s * (3.0 - 2.0 * s);
}

}  // namespace

// A take, and the paths through the database that its readings lead along.
struct WholeTakeReconstructor::SearchedTake {
  std::vector<Reading> readings;
  retrieval::FeatureRows signals;
  TwoWayPaths paths;

  retrieval::SignalWindow window(std::size_t t) const { return window_at(signals, t); }
};

// What was retrieved for each frame of a take, or of a part.
struct WholeTakeReconstructor::RetrievedTake {
  std::vector<FrameTarget> targets;
  std::vector<Diagnostics> diagnostics;
  std::vector<ExtremityVote> extremities;

  void add(RetrievedFrame frame) {
    targets.push_back(std::move(frame.target));
    diagnostics.push_back(std::move(frame.diagnostics));
    extremities.push_back(frame.extremities);
  }
  void even(double rate_hz) {
    constexpr double kEvened_s = 0.08;
    even_agreements(targets, static_cast<std::size_t>(std::lround(kEvened_s * rate_hz)));
  }
  void replace(std::size_t begin, RetrievedTake part) {
    const auto at = static_cast<std::ptrdiff_t>(begin);
    std::move(part.targets.begin(), part.targets.end(), targets.begin() + at);
    std::move(part.diagnostics.begin(), part.diagnostics.end(), diagnostics.begin() + at);
    std::move(part.extremities.begin(), part.extremities.end(), extremities.begin() + at);
  }
};

// Frames [begin, end()) of a take, and the poses that they may have had instead.
struct WholeTakeReconstructor::Part {
  std::size_t begin = 0;
  std::vector<PoseMode> modes;

  std::size_t end() const { return begin + modes.size(); }
  bool has(std::size_t frame) const { return frame >= begin && frame < end(); }
  // How much a fit of it counts in a frame: wholly inside, and less and less away from it.
  double share(std::size_t frame, double rate_hz) const {
    const std::size_t away = frame < begin ? begin - frame : frame - std::min(frame, end() - 1);
    return smooth(1.0 - static_cast<double>(away) / std::max(kAround_s * rate_hz, 1.0));
  }
  // How much one of its frames is of its own: little at its ends, which lead there from the first
  // motion's poses. Where the take begins or ends there is nothing to lead from.
  double presence(std::size_t frame, std::size_t num_frames, double rate_hz) const {
    const double edge = std::max(kEdge_s * rate_hz, 1.0);
    double share = 1.0;
    if (begin > 0) share = std::min(share, static_cast<double>(frame - begin + 1) / edge);
    if (end() < num_frames) share = std::min(share, static_cast<double>(end() - frame) / edge);
    return smooth(share);
  }
};

// A part with what is before and after it, fitted together.
struct WholeTakeReconstructor::FittedPart {
  std::size_t begin = 0;
  std::vector<FittedFrame> frames;
  bool is_even = true;  // no joint jumps

  // Puts it in place of a motion.
  void put(const Part& part, double rate_hz, std::vector<OtherFrame>& others) const {
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const std::size_t t = begin + i;
      const double share = part.share(t, rate_hz);
      if (share <= others[t].share) continue;
      others[t] = {frames[i], root_step(frames[i > 0 ? i - 1 : 0], frames[i]), share};
    }
  }
};

std::vector<PoseEstimate> WholeTakeReconstructor::solve(const std::vector<Reading>& measured,
                                                        const Progress& progress) {
  for (const auto& reading : measured) require_sensors(reading, solver_.num_sensors());
  alternatives_.clear();
  std::vector<Reading> take = turned(measured);
  if (!asks_for_headings(solver_, take.size())) return solved(std::move(take), progress);
  const std::size_t num_parts = num_parts_of(solver_.config());
  share_headings(solver_, num_threads_, part_of(progress, 0, num_parts + 1, take.size()), take);
  const Progress rest(
      Progress::Callback([&](std::size_t done, std::size_t total, std::string_view what) {
        progress.report(measured.size() + done, measured.size() + total, what);
        return true;
      }));
  return solved(std::move(take), rest);
}

// From readings whose orientations share a heading.
std::vector<PoseEstimate> WholeTakeReconstructor::solved(std::vector<Reading> readings,
                                                         const Progress& progress) {
  const std::size_t num_frames = readings.size();
  const std::size_t num_parts = num_parts_of(solver_.config());
  const auto part = [&](std::size_t i) { return part_of(progress, i, num_parts, num_frames); };
  const SearchedTake take = searched(std::move(readings), part(0));
  RetrievedTake first = retrieved(take, part(1));
  std::vector<FittedFrame> frames;
  for (const auto& target : first.targets)
    frames.push_back(
        start_of(skeleton(), 1.0 / rate_hz(), target, frames.empty() ? nullptr : &frames.back()));
  first.even(rate_hz());
  fit(frames, first, part(2));
  find_alternatives(take, first, frames, progress);
  return estimates(take, std::move(first), frames);
}

std::vector<Reading> WholeTakeReconstructor::turned(const std::vector<Reading>& measured) {
  turning_.reset();
  std::vector<Reading> take;
  for (const auto& reading : measured) take.push_back(turning_(reading));
  return take;
}

WholeTakeReconstructor::SearchedTake WholeTakeReconstructor::searched(
    std::vector<Reading> take, const Progress& progress) const {
  const retrieval::FeatureRows signals = signal_rows(take, solver_.signals());
  TwoWayPaths paths = paths_of(solver_, signals, num_threads_, [&](std::size_t t) {
    progress.report(t, take.size(), "searching");
  });
  return {std::move(take), signals, std::move(paths)};
}

WholeTakeReconstructor::RetrievedTake WholeTakeReconstructor::retrieved(
    const SearchedTake& take, const Progress& progress) const {
  const std::size_t num_frames = take.readings.size();
  auto frames = in_parallel<RetrievedFrame>(
      num_frames, num_threads_,
      [&](std::size_t t) { progress.report(t, num_frames, "reconstructing"); },
      [&](std::size_t t) {
        RetrievedFrame frame;
        solver_.retrieve(take.paths.paths(t), take.window(t), take.readings[t], frame);
        return frame;
      });
  RetrievedTake out;
  for (auto& frame : frames) out.add(std::move(frame));
  return out;
}

// The whole take in one fit.
void WholeTakeReconstructor::fit(std::vector<FittedFrame>& frames, const RetrievedTake& retrieved,
                                 const Progress& progress) const {
  const Config& config = solver_.config();
  TakeFit(skeleton(), 1.0 / rate_hz(), config.fit, num_threads_)
      .fit(frames, retrieved.targets, 0, config.max_iterations, progress);
}

std::vector<PoseEstimate> WholeTakeReconstructor::estimates(
    const SearchedTake& take, RetrievedTake retrieved,
    const std::vector<FittedFrame>& frames) const {
  std::vector<PoseEstimate> estimates;
  for (std::size_t t = 0; t < frames.size(); ++t) {
    estimates.push_back(to_estimate(frames[t], take.readings[t].time_s,
                                    retrieved.targets[t].feet.certainty,
                                    std::move(retrieved.diagnostics[t])));
    estimates.back().extremities = retrieved.extremities[t];
  }
  return estimates;
}

void WholeTakeReconstructor::find_alternatives(const SearchedTake& take, const RetrievedTake& first,
                                               const std::vector<FittedFrame>& frames,
                                               const Progress& progress) {
  const std::size_t num_parts = num_parts_of(solver_.config());
  Known known(frames.size());
  for (std::size_t t = 0; t < frames.size(); ++t) known[t].push_back(positions_of(frames[t]));
  for (std::size_t i = kFirstParts; i < num_parts; i += kPartsOfAlternative) {
    const auto parts = parts_elsewhere(take, known, part_of(progress, i, num_parts, frames.size()));
    Alternative found;
    RetrievedTake other = first;
    std::vector<OtherFrame> others(frames.size());
    for (const Part& part : parts) {
      RetrievedTake there = retrieved_part(take, known, part);
      const FittedPart fitted = fitted_part(part, there, first, frames,
                                            part_of(progress, i + 1, num_parts, frames.size()));
      const double apart_m = distance_m(part, fitted, known);
      if (apart_m < kWorthALook_m || !fitted.is_even) continue;
      found.differences.push_back({static_cast<double>(part.begin) / rate_hz(),
                                   static_cast<double>(part.end()) / rate_hz(), apart_m});
      other.replace(part.begin, std::move(there));
      fitted.put(part, rate_hz(), others);
    }
    if (found.differences.empty()) return;
    const auto fitted = merged(frames, others);
    for (std::size_t t = 0; t < frames.size(); ++t) known[t].push_back(positions_of(fitted[t]));
    found.estimates = estimates(take, std::move(other), fitted);
    alternatives_.push_back(std::move(found));
  }
}

// Where the retrieved poses tell of another motion for long enough.
std::vector<WholeTakeReconstructor::Part> WholeTakeReconstructor::parts_elsewhere(
    const SearchedTake& take, const Known& known, const Progress& progress) const {
  const std::size_t num_frames = known.size();
  const auto modes = in_parallel<FrameModes>(
      num_frames, num_threads_, [&](std::size_t t) { progress.report(t, num_frames, "searching"); },
      [&](std::size_t t) {
        const auto& paths = take.paths.paths(t);
        Eigen::VectorXd weights = retrieval::softmax_weights(paths, solver_.config().sharpness);
        // The best path comes first.
        for (std::size_t i = 0; i < paths.size(); ++i)
          if (paths[i].reward < kAboutAsWell * paths.front().reward)
            weights[static_cast<Eigen::Index>(i)] = 0.0;
        return modes_of(solver_.positions(paths), weights, known[t]);
      });
  const auto chosen = likeliest_modes(modes, 1.0 / rate_hz());
  std::vector<Part> parts;
  for (std::size_t t = 0; t < num_frames; ++t) {
    if (!chosen[t]) continue;
    if (t == 0 || !chosen[t - 1]) parts.push_back({t, {}});
    parts.back().modes.push_back(modes[t].modes[*chosen[t]]);
  }
  std::erase_if(parts, [&](const Part& part) {
    return static_cast<double>(part.modes.size()) < kShortest_s * rate_hz();
  });
  return parts;
}

// A part, retrieved from the paths that lead to its modes alone.
WholeTakeReconstructor::RetrievedTake WholeTakeReconstructor::retrieved_part(
    const SearchedTake& take, const Known& known, const Part& part) const {
  RetrievedTake out;
  for (std::size_t t = part.begin; t < part.end(); ++t) {
    const PoseMode& mode = part.modes[t - part.begin];
    const Eigen::MatrixXf positions = solver_.positions(take.paths.paths(t));
    std::vector<retrieval::Path> paths;
    for (Eigen::Index i = 0; i < positions.cols(); ++i)
      if (pose_distance_m(positions.col(i), mode.positions) <= kAlike_m &&
          !is_alike(positions.col(i), known[t]))
        paths.push_back(take.paths.paths(t)[static_cast<std::size_t>(i)]);
    RetrievedFrame frame;
    solver_.retrieve(paths, take.window(t), take.readings[t], frame);
    out.add(std::move(frame));
  }
  out.even(rate_hz());
  return out;
}

WholeTakeReconstructor::FittedPart WholeTakeReconstructor::fitted_part(
    const Part& part, const RetrievedTake& retrieved, const RetrievedTake& first,
    const std::vector<FittedFrame>& frames, const Progress& progress) const {
  // Twice as much as is kept, so that no frame of it lacks its neighbours.
  const auto around = static_cast<std::size_t>(std::lround(2.0 * kAround_s * rate_hz()));
  const Config& config = solver_.config();
  FittedPart fitted{part.begin - std::min(part.begin, around), {}};
  const std::size_t end = std::min(frames.size(), part.end() + around);
  std::vector<FrameTarget> targets;
  for (std::size_t t = fitted.begin; t < end; ++t) {
    const FittedFrame* before = fitted.frames.empty() ? nullptr : &fitted.frames.back();
    targets.push_back(first.targets[t]);
    FittedFrame start = frames[t];
    if (part.has(t)) {
      const double share = part.presence(t, frames.size(), rate_hz());
      const FrameTarget& own = retrieved.targets[t - part.begin];
      targets.back() = blended(first.targets[t], own, share, config.wide_spread_m);
      const double share_before =
          part.has(t - 1) ? part.presence(t - 1, frames.size(), rate_hz()) : 0.0;
      if (t > 0 && targets.back().step.size() > 0)
        targets.back().step += (share - share_before) * (own.points - first.targets[t].points);
      start = start_of(skeleton(), 1.0 / rate_hz(), own, before);
      start.rotations = between(frames[t].rotations, start.rotations, share);
    } else if (before != nullptr) {
      start = after(*before, root_step(frames[t - 1], frames[t]), start);
    }
    fitted.frames.push_back(std::move(start));
  }
  TakeFit(skeleton(), 1.0 / rate_hz(), config.fit, num_threads_)
      .fit(fitted.frames, targets, 0, config.max_iterations, progress);
  std::vector<FittedFrame> shown = fitted.frames;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const std::size_t t = fitted.begin + i;
    shown[i].rotations = between(frames[t].rotations, shown[i].rotations, part.share(t, rate_hz()));
  }
  fitted.is_even = moves_as_asked(shown, targets);
  return fitted;
}

// Whether each joint moves about as the retrieved motions do: a fit may leave one that jumps.
bool WholeTakeReconstructor::moves_as_asked(const std::vector<FittedFrame>& frames,
                                            const std::vector<FrameTarget>& targets) const {
  constexpr double kJump_mps = 5.0;
  Eigen::VectorXf before, here;
  for (std::size_t t = 0; t < frames.size(); ++t) {
    before = std::move(here);
    here = positions_of(frames[t]);
    if (t > 0 && targets[t].step.size() > 0) {
      const Eigen::VectorXf off = here - before - targets[t].step.head(here.size()).cast<float>();
      const float most = off.reshaped(3, off.size() / 3).colwise().norm().maxCoeff();
      if (static_cast<double>(most) * rate_hz() > kJump_mps) return false;
    }
  }
  return true;
}

// The mean distance of a part's poses from those of the first motion.
double WholeTakeReconstructor::distance_m(const Part& part, const FittedPart& fitted,
                                          const Known& known) const {
  double sum_m = 0.0;
  for (std::size_t t = part.begin; t < part.end(); ++t)
    sum_m += pose_distance_m(positions_of(fitted.frames[t - fitted.begin]), known[t].front());
  return sum_m / static_cast<double>(part.modes.size());
}

Eigen::VectorXf WholeTakeReconstructor::positions_of(const FittedFrame& frame) const {
  JointTransforms pose;
  forward_kinematics(skeleton(), Vec3::Zero(), frame.rotations, pose);
  return pose_points(pose, 1.0).head(3 * skeleton().num_joints()).cast<float>();
}

}  // namespace sparse_mocap::path_regression
