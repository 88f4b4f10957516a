// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/methods/reconstruct.hpp"

#include <iterator>
#include <utility>

#include "sparse_mocap/methods/registry.hpp"

namespace sparse_mocap {
namespace {

const MethodEntry& method_of(const ReconstructionRequest& request) {
  return request.method.empty() ? methods().front() : find_method(request.method);
}

MethodContext context_of(const ReconstructionRequest& request,
                         const std::vector<SensorInput>& sensors) {
  MethodContext context{request.database, request.model, request.body, {}, request.excluded_clips};
  for (const auto& input : sensors) context.sensors.push_back(input.sensor);
  return context;
}

ReadingSettings settings_for(const Method& method, const ReconstructionRequest& request,
                             GravityAverage average) {
  ReadingSettings settings;
  settings.rate_hz = method.rate_hz();
  settings.gravity_average = average;
  settings.tracker_world = request.tracker_world;
  settings.filter = method.reading_filter();
  return settings;
}

// Whether any sensor says anything.
bool has_any(const Reading& reading) {
  const auto is_there = [](const auto& values) { return values.array().isFinite().any(); };
  return is_there(reading.specific_force) || is_there(reading.angular_velocity) ||
         is_there(reading.position) || is_there(reading.orientation);
}

Reconstruction begun(const Method& method, const ExtremityTrack& extremities,
                     const MethodContext& context) {
  Reconstruction out;
  out.skeleton = extremities.skeleton();
  out.rate_hz = method.rate_hz();
  out.sensors = context.sensors;
  return out;
}

void add_alternatives(const WholeTakeMethod& method, const ExtremityTrack& extremities,
                      Reconstruction& solved) {
  std::vector<Reconstruction> found;
  for (auto& alternative : method.alternatives()) {
    Reconstruction& other = found.emplace_back(solved);
    other.estimates = std::move(alternative.estimates);
    extremities.complete(other.estimates);
    other.differences = std::move(alternative.differences);
  }
  solved.alternatives = std::move(found);
}

}  // namespace

std::vector<SensorInput> used_channels(std::vector<SensorInput> sensors, const MethodInfo& method) {
  for (auto& input : sensors)
    input.sensor.channels =
        input.sensor.channels & (method.required_channels | method.optional_channels);
  return sensors;
}

Reconstruction reconstruct(std::span<const SensorRecording> take, std::vector<SensorInput> sensors,
                           const ReconstructionRequest& request, Quality quality,
                           const Progress& progress) {
  const MethodEntry& entry = method_of(request);
  sensors = used_channels(std::move(sensors), entry.info);
  const MethodContext context = context_of(request, sensors);
  if (quality == Quality::best) {
    const auto method = make_whole_take_method(entry, request.settings, context);
    const ExtremityTrack extremities(method->skeleton(), method->rate_hz());
    Reconstruction out = begun(*method, extremities, context);
    out.readings = readings_of(take, std::move(sensors),
                               settings_for(*method, request, GravityAverage::whole_take));
    out.estimates = method->solve(out.readings, progress);
    extremities.complete(out.estimates);
    out.notes = method->notes();
    add_alternatives(*method, extremities, out);
    return out;
  }
  const auto method = make_live_method(entry, request.settings, context);
  ExtremityTrack extremities(method->skeleton(), method->rate_hz());
  Reconstruction out = begun(*method, extremities, context);
  const auto settings = settings_for(*method, request, GravityAverage::causal);
  out.latency_s = method->latency_s() + settings.filter.reach_s();
  out.readings = readings_of(take, std::move(sensors), settings);
  out.estimates = solve_live(*method, out.readings, progress);
  for (auto& estimate : out.estimates) extremities.complete(estimate);
  out.notes = method->notes();
  return out;
}

LiveReconstructor::LiveReconstructor(std::vector<SensorInput> sensors,
                                     const ReconstructionRequest& request, int largest_backlog)
    : method_(
          make_live_method(method_of(request), request.settings,
                           context_of(request, used_channels(sensors, method_of(request).info)))),
      readings_(used_channels(std::move(sensors), method_of(request).info),
                settings_for(*method_, request, GravityAverage::causal)),
      extremities_(method_->skeleton(), method_->rate_hz()),
      largest_backlog_(static_cast<std::size_t>(largest_backlog)) {}

std::vector<PoseEstimate> LiveReconstructor::advance(double now_s) {
  std::vector<Reading> readings = readings_.ready(now_s);
  if (largest_backlog_ > 0 && readings.size() > largest_backlog_) {
    num_skipped_ += static_cast<int>(readings.size()) - 1;
    readings.erase(readings.begin(), readings.end() - 1);
    method_->reset();
    extremities_.reset();
  }
  return solve(readings);
}

std::vector<PoseEstimate> LiveReconstructor::flush() {
  auto estimates = solve(readings_.flush());
  auto last = method_->flush();
  for (auto& estimate : last) extremities_.complete(estimate);
  extremities_.reset();
  std::move(last.begin(), last.end(), std::back_inserter(estimates));
  return estimates;
}

std::vector<PoseEstimate> LiveReconstructor::solve(const std::vector<Reading>& readings) {
  std::vector<PoseEstimate> estimates;
  for (const auto& reading : readings) {
    if (has_any(reading)) last_reading_s_ = reading.time_s;
    auto estimate = method_->step(reading);
    if (!estimate) continue;
    extremities_.complete(*estimate);
    estimates.push_back(std::move(*estimate));
  }
  return estimates;
}

}  // namespace sparse_mocap
