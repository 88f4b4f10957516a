// SPDX-License-Identifier: GPL-3.0-or-later
//
// copied_database SOURCE.smdb TARGET.smdb: a database of eight copies of each clip, at other tempos
// and a little differently posed, to see how large databases fare.
#include <cmath>
#include <exception>
#include <iostream>
#include <numbers>
#include <string>

#include "sparse_mocap/base/ordered_work.hpp"
#include "sparse_mocap/database/clip_motion.hpp"
#include "sparse_mocap/database/database_content.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap::testing {
namespace {

constexpr std::size_t kCopies = 8;

double tempo_of(std::size_t copy) { return 0.8 + 0.06 * static_cast<double>(copy); }

// Each joint is turned by a few degrees, now more and now less.
Motion perturbed(Motion motion, unsigned seed) {
  Random random(seed);
  const int num_joints = motion.skeleton.num_joints();
  for (int joint = 0; joint < num_joints; ++joint) {
    const Vec3 axis = random.rotation() * Vec3::UnitX();
    const double most_rad = random.in(0.0, 0.1), frequency_hz = random.in(0.1, 0.5);
    const double phase_rad = random.in(0.0, 2.0 * std::numbers::pi);
    for (int frame = 0; frame < motion.num_frames(); ++frame) {
      const double at_rad =
          2.0 * std::numbers::pi * frequency_hz * frame * motion.frame_time_s + phase_rad;
      Quat& rotation = motion.rotation(frame, joint);
      rotation = rotation * Quat(Eigen::AngleAxisd(most_rad * std::sin(at_rad), axis));
    }
  }
  return motion;
}

DatabaseContent with_copies(const MotionDatabase& source) {
  DatabaseContent content;
  content.skeleton = source.skeleton();
  content.rate_hz = source.rate_hz();
  content.sources = source.sources();
  content.build_info = source.build_info();
  const std::size_t num_clips = source.clips().size();
  content.clips.resize(kCopies * num_clips);
  content.clip_rows.resize(kCopies * num_clips);
  in_pieces(content.clips.size(), 1, 0, [&](std::size_t i) {
    const std::size_t copy = i / num_clips, of = i % num_clips;
    Motion motion = clip_motion(source, static_cast<int>(of));
    motion.frame_time_s /= tempo_of(copy);
    content.clip_rows[i] = packed(
        database_rows(perturbed(std::move(motion), static_cast<unsigned>(i)), source.rate_hz()));
    Clip clip = source.clips()[of];
    clip.source = "copy " + std::to_string(copy) + "/" + clip.source;
    clip.has_extremity = {};
    content.clips[i] = std::move(clip);
  });
  return content;
}

}  // namespace
}  // namespace sparse_mocap::testing

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: copied_database SOURCE.smdb TARGET.smdb\n";
    return 2;
  }
  try {
    const auto source = sparse_mocap::MotionDatabase::open(argv[1]);
    sparse_mocap::write_database(argv[2], sparse_mocap::testing::with_copies(*source));
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
