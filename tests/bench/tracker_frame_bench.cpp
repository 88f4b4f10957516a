// SPDX-License-Identifier: GPL-3.0-or-later
//
// Frames of liu2011 with six trackers, and the stages of one: the search for motion examples, the
// regression on them, and the minimisation.
#include <benchmark/benchmark.h>

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "latencies.hpp"
#include "recorded.hpp"
#include "sparse_mocap/liu2011/history_search.hpp"
#include "sparse_mocap/liu2011/pose_priors.hpp"
#include "sparse_mocap/methods/registry.hpp"
#include "sparse_mocap/retrieval/signals.hpp"
#include "sparse_mocap/sensors/sites.hpp"
#include "support/synthetic.hpp"

namespace sparse_mocap::testing {
namespace {

using namespace liu2011;

const std::map<std::string, Channels> kChannels{
    {"position", Channel::position},
    {"position+orientation", Channel::position | Channel::orientation}};
constexpr int kPaperFrames = 66'000;  // about as many as the paper's database has

std::vector<Sensor> trackers(Channels channels) {
  std::vector<Sensor> sensors;
  for (const char* site : {"left_hand", "right_hand", "left_ankle", "right_ankle", "head", "torso"})
    sensors.push_back({find_site(site), 1.0, channels});
  return sensors;
}

// The size 66k is a part of the next larger database.
MethodContext context_of(const std::string& size, const std::vector<Sensor>& sensors) {
  const bool is_part = size == "66k";
  MethodContext context{recorded_database(is_part ? "100k" : size), nullptr, {}, sensors, {}};
  const auto& clips = context.database->clips();
  for (std::size_t clip = 0; is_part && clip < clips.size(); ++clip)
    if (clips[clip].end > kPaperFrames) context.excluded_clips.push_back(static_cast<int>(clip));
  return context;
}

void frame(benchmark::State& state, const std::string& size, Channels channels) {
  const auto sensors = trackers(channels);
  const auto method = make_live_method(find_method("liu2011"), {}, context_of(size, sensors));
  const auto queries = MotionDatabase::open(recorded_path("queries"));
  std::vector<Reading> readings;
  for (int clip = 0; clip < static_cast<int>(queries->clips().size()); ++clip) {
    const auto all = readings_of(*queries, clip, sensors);
    readings.insert(readings.end(), all.begin(), all.end());
  }
  method->step(readings.front());
  Latencies latencies;
  std::size_t t = 1;
  for (auto _ : state) {
    latencies.begin();
    benchmark::DoNotOptimize(method->step(readings[t++ % readings.size()]));
    latencies.end();
  }
  latencies.report(state);
}

// What a frame begins with: the poses before it, as they were, and what the sensors say.
struct Instant {
  std::vector<BodyPose> recent;
  std::vector<Observation> observed;
};

// All that a stage takes: of frames that the database does not hold.
class Stages {
 public:
  Stages(const std::string& size, Channels channels)
      : context_(context_of(size, trackers(channels))),
        examples_(context_.database, context_.database->skeleton()),
        worn_(worn_sensors(examples_.body(), context_.sensors)),
        num_poses_(config_.num_poses(context_.database->rate_hz())),
        search_(examples_, worn_,
                {num_poses_, config_.search_position_per_m, config_.search_orientation},
                retrieval::searched_frames(*context_.database, false, context_.excluded_clips)) {
    const MotionExamples performed(MotionDatabase::open(recorded_path("queries")),
                                   examples_.body());
    for (int t = 0; t < performed.num_frames(); ++t) {
      Instant instant;
      for (const auto& place : performed.history(t, num_poses_))
        instant.recent.push_back(place.heading.to_parent(performed.pose(place.frame)));
      for (Observation& one : sensors_of(examples_.body(), worn_, performed.next(t))) {
        one.has_orientation = channels.has(Channel::orientation);
        instant.observed.push_back(one);
      }
      instants_.push_back(std::move(instant));
    }
  }

  const Instant& instant(std::size_t t) const { return instants_[t % instants_.size()]; }
  void search(const Instant& at) {
    search_.search(at.recent, at.observed, config_.num_neighbours, nearest_);
  }
  PosePrior prior(const Instant& at) const {
    return pose_prior(examples_.body(), local_examples(examples_, nearest_, num_poses_), at.recent,
                      config_);
  }
  Estimate minimum(const Instant& at, const PosePrior& prior) const {
    return map_estimate(examples_.body(), at.observed, config_.control(), prior,
                        examples_.next(nearest_.front().row), config_.max_iterations);
  }

 private:
  Config config_;
  MethodContext context_;
  MotionExamples examples_;
  std::vector<WornSensor> worn_;
  int num_poses_;
  HistorySearch search_;
  std::vector<Instant> instants_;
  std::vector<retrieval::Neighbour> nearest_;
};

// The one that was asked for last is kept.
Stages& stages_of(const std::string& size, Channels channels) {
  static std::pair<std::string, Channels> kept_for;
  static std::unique_ptr<Stages> kept;
  if (kept == nullptr || kept_for != std::pair(size, channels)) {
    kept = std::make_unique<Stages>(size, channels);
    kept_for = {size, channels};
  }
  return *kept;
}

enum class Stage { search, regression, minimisation };
const std::map<std::string, Stage> kStages{{"search", Stage::search},
                                           {"regression", Stage::regression},
                                           {"minimisation", Stage::minimisation}};

// All stages of each frame; one is timed.
void stage(benchmark::State& state, Stage timed, const std::string& size, Channels channels) {
  Stages& stages = stages_of(size, channels);
  std::map<Stage, Latencies> latencies;
  std::size_t t = 0;
  for (auto _ : state) {
    const Instant& at = stages.instant(t++);
    latencies[Stage::search].begin();
    stages.search(at);
    latencies[Stage::search].end();
    latencies[Stage::regression].begin();
    const PosePrior prior = stages.prior(at);
    latencies[Stage::regression].end();
    latencies[Stage::minimisation].begin();
    benchmark::DoNotOptimize(stages.minimum(at, prior));
    latencies[Stage::minimisation].end();
  }
  latencies[timed].report(state);
}

const bool is_registered = [] {
  auto sizes = recorded_sizes();
  std::erase(sizes, "5m");
  for (std::size_t i = 0; i < sizes.size(); ++i)
    if (sizes[i] == "100k") {
      sizes.insert(sizes.begin() + static_cast<std::ptrdiff_t>(i), "66k");
      break;
    }
  for (const auto& size : sizes)
    for (const auto& [name, channels] : kChannels) {
      const std::string what = name + "/" + size;
      benchmark::RegisterBenchmark(("tracker_frame/" + what).c_str(), frame, size, channels)
          ->Unit(benchmark::kMillisecond)
          ->Iterations(600);
      for (const auto& [stage_name, timed] : kStages)
        benchmark::RegisterBenchmark(("tracker_" + stage_name + "/" + what).c_str(), stage, timed,
                                     size, channels)
            ->Unit(benchmark::kMillisecond)
            ->Iterations(600);
    }
  return true;
}();

}  // namespace
}  // namespace sparse_mocap::testing
