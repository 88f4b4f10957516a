// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/retrieval/signals.hpp"

#include <algorithm>
#include <string>

#include "sparse_mocap/base/errors.hpp"
#include "sparse_mocap/retrieval/shared_heading.hpp"
#include "sparse_mocap/sensors/sites.hpp"

namespace sparse_mocap::retrieval {
namespace {

const Site& site_of(int site) { return all_sites()[static_cast<std::size_t>(site)]; }

void require_distinct_sites(const std::vector<Sensor>& sensors) {
  if (sensors.empty()) throw ConfigError("at least one sensor is needed");
  for (std::size_t a = 0; a < sensors.size(); ++a)
    for (std::size_t b = a + 1; b < sensors.size(); ++b)
      if (sensors[a].site == sensors[b].site)
        throw ConfigError("two sensors at " + std::string(site_of(sensors[a].site).name));
}

const SiteRows& site_rows(const MotionDatabase& database, int site) {
  const auto& names = database.site_names();
  const auto at = std::find(names.begin(), names.end(), site_of(site).name);
  if (at == names.end())
    throw ConfigError("the motion database has no readings for " + std::string(site_of(site).name) +
                      "; build it again");
  return database.site(static_cast<std::size_t>(at - names.begin()));
}

// The sensors whose axes are compared; their columns follow all others.
struct Turned {
  std::vector<Eigen::Index> sensors;
  std::vector<int> sites;

  void find(std::span<const Signal> signals) {
    sensors.clear();
    sites.clear();
    for (const Signal& signal : signals)
      if (signal.channel == Channel::orientation &&
          (sensors.empty() || sensors.back() != signal.sensor)) {
        sensors.push_back(signal.sensor);
        sites.push_back(signal.site);
      }
  }
  Eigen::Index num_columns() const {
    return kAxesColumns * static_cast<Eigen::Index>(sites.size());
  }
};

}  // namespace

std::vector<Signal> compared_signals(const std::vector<Sensor>& sensors, bool with_gravity) {
  require_distinct_sites(sensors);
  std::vector<Signal> signals;
  for (const Channel channel : {Channel::specific_force, Channel::gravity_direction}) {
    if (channel == Channel::gravity_direction && !with_gravity) continue;
    for (std::size_t s = 0; s < sensors.size(); ++s)
      if (sensors[s].channels.has(channel))
        signals.push_back({static_cast<Eigen::Index>(s), sensors[s].site,
                           sensors[s].position_along_bone, channel});
  }
  return signals;
}

std::vector<Signal> all_signals(const std::vector<Sensor>& sensors) {
  std::vector<Signal> signals = compared_signals(sensors, true);
  for (std::size_t s = 0; s < sensors.size(); ++s)
    if (sensors[s].channels.has(Channel::orientation))
      signals.insert(signals.end(), 2,
                     {static_cast<Eigen::Index>(s), sensors[s].site, sensors[s].position_along_bone,
                      Channel::orientation});
  return signals;
}

bool is_on_leg(const Signal& signal) {
  using namespace standard_joint;
  const int carrier = site_of(signal.site).carrier;
  return carrier == ltibia || carrier == rtibia || carrier == lfemur || carrier == rfemur;
}

FeatureRows database_signals(const MotionDatabase& database, std::span<const Signal> signals) {
  FeatureRows rows(database.num_frames(), static_cast<Eigen::Index>(3 * signals.size()));
  Turned turned;
  turned.find(signals);
  if (!turned.sites.empty())
    rows.rightCols(turned.num_columns()) = database_axes(database, turned.sites);
  for (std::size_t s = 0; s < signals.size(); ++s) {
    if (signals[s].channel == Channel::orientation) continue;
    const SiteRows& site = site_rows(database, signals[s].site);
    const auto along = static_cast<float>(signals[s].position_along_bone);
    auto signal = rows.middleCols(static_cast<Eigen::Index>(3 * s), 3);
    for (const Clip& clip : database.clips()) {
      const auto of_clip = [&](const ScaledRows& scaled) {
        return scaled.rows_of_clip(clip.begin, clip.num_frames());
      };
      if (signals[s].channel == Channel::gravity_direction)
        signal.middleRows(clip.begin, clip.num_frames()) = of_clip(site.gravity_direction);
      else
        signal.middleRows(clip.begin, clip.num_frames()) =
            (1.0F - along) * of_clip(site.specific_force_pivot) +
            along * of_clip(site.specific_force_end);
    }
  }
  return rows;
}

Eigen::RowVectorXf signal_row(const Reading& reading, std::span<const Signal> signals) {
  Eigen::RowVectorXf row(static_cast<Eigen::Index>(3 * signals.size()));
  put_signals(reading, signals, row);
  return row;
}

void put_signals(const Reading& reading, std::span<const Signal> signals,
                 Eigen::Ref<Eigen::RowVectorXf> row) {
  static thread_local Turned turned;
  turned.find(signals);
  if (!turned.sites.empty())
    put_axes_row(reading, turned.sensors, turned.sites, row.tail(turned.num_columns()));
  for (std::size_t s = 0; s < signals.size(); ++s) {
    if (signals[s].channel == Channel::orientation) continue;
    const auto& channel = signals[s].channel == Channel::gravity_direction
                              ? reading.gravity_direction
                              : reading.specific_force;
    row.segment<3>(static_cast<Eigen::Index>(3 * s)) =
        channel.col(signals[s].sensor).transpose().cast<float>();
  }
}

std::vector<bool> searched_frames(const MotionDatabase& database, bool use_tempo_copies,
                                  const std::vector<int>& excluded_clips) {
  std::vector<bool> is_searched(static_cast<std::size_t>(database.num_frames()), true);
  const auto leave_out = [&](const Clip& clip) {
    std::fill(is_searched.begin() + clip.begin, is_searched.begin() + clip.end, false);
  };
  for (const Clip& clip : database.clips())
    if (clip.tempo != 1.0 && !use_tempo_copies) leave_out(clip);
  for (const int clip : excluded_clips) {
    if (clip < 0 || clip >= static_cast<int>(database.clips().size()))
      throw ConfigError("excluded clip " + std::to_string(clip) + " is not in the database");
    leave_out(database.clips()[static_cast<std::size_t>(clip)]);
  }
  if (std::none_of(is_searched.begin(), is_searched.end(), [](bool b) { return b; }))
    throw ConfigError("every clip of the database is excluded");
  return is_searched;
}

}  // namespace sparse_mocap::retrieval
