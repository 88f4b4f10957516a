// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/sensors/clock.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace sparse_mocap {
namespace {

constexpr double kTogether_s = 1e-3;

struct Point {
  double x = 0.0, y = 0.0;
};

double slope_between(const Point& a, const Point& b) { return (b.y - a.y) / (b.x - a.x); }

// The lower convex hull of points with ascending x.
std::vector<Point> lower_hull(const std::vector<Point>& points) {
  std::vector<Point> hull;
  for (const Point& p : points) {
    while (hull.size() >= 2 &&
           slope_between(hull[hull.size() - 2], hull.back()) >= slope_between(hull.back(), p))
      hull.pop_back();
    hull.push_back(p);
  }
  return hull;
}

// The slope of the hull below x.
double slope_at(const std::vector<Point>& hull, double x) {
  if (hull.size() < 2) return 0.0;
  std::size_t i = 1;
  while (i + 1 < hull.size() && hull[i].x < x) ++i;
  return slope_between(hull[i - 1], hull[i]);
}

// The height at x of the highest line of this slope that is below the hull.
double height_below(const std::vector<Point>& hull, double slope, double x) {
  double height = std::numeric_limits<double>::infinity();
  for (const Point& p : hull) height = std::min(height, p.y + slope * (x - p.x));
  return height;
}

}  // namespace

ClockModel::ClockModel(ClockSettings settings) : settings_(settings) {
  if (!(settings.largest_drift > 0.0 && settings.largest_drift < 0.5 && settings.window_s > 1.0 &&
        settings.largest_step_s > 0.0))
    throw std::invalid_argument("ClockModel: a setting is out of its range");
}

double ClockModel::observe(double device_s, double arrival_s) {
  if (!std::isfinite(device_s) || !std::isfinite(arrival_s))
    throw std::invalid_argument("ClockModel: a time is not finite");
  if (num_segments_ == 0 || was_reset(device_s, arrival_s)) {
    num_at_begin_ = 1;
    start_segment(device_s, arrival_s);
  } else if (has_fallen_behind(device_s, arrival_s)) {
    num_at_begin_ = num_late_;
    start_segment(device_s, arrival_s);
  }
  add(device_s - origin_device_s_, arrival_s - origin_host_s_);
  last_device_s_ = std::max(last_device_s_, device_s);
  last_host_s_ = std::max(last_host_s_, host_time_s(device_s));
  return last_host_s_;
}

// A clock set back, or one that runs ahead of what has arrived.
bool ClockModel::was_reset(double device_s, double arrival_s) const {
  return device_s < last_device_s_ - settings_.largest_step_s ||
         host_time_s(device_s) > arrival_s + settings_.largest_step_s;
}

bool ClockModel::has_fallen_behind(double device_s, double arrival_s) {
  if (arrival_s - host_time_s(device_s) <= settings_.late_s) {
    num_late_ = 0;
    return false;
  }
  if (num_late_ == 0) late_since_s_ = arrival_s;
  ++num_late_;
  return arrival_s - late_since_s_ >= settings_.late_for_s;
}

void ClockModel::start_segment(double device_s, double arrival_s) {
  ++num_segments_;
  num_late_ = 0;
  buckets_.clear();
  origin_device_s_ = last_device_s_ = device_s;
  origin_host_s_ = arrival_s;
  intercept_s_ = 0.0;
  if (num_segments_ == 1) drift_ = 0.0;  // a restarted device keeps its crystal
}

void ClockModel::add(double device_s, double arrival_s) {
  const auto second = static_cast<std::int64_t>(std::floor(device_s));
  const auto lateness = [&](double device, double arrival) {
    return arrival - intercept_s_ - (1.0 + drift_) * device;
  };
  auto at = std::find_if(buckets_.rbegin(), buckets_.rend(),
                         [&](const Bucket& bucket) { return bucket.second <= second; });
  bool is_news = false;
  if (at == buckets_.rend() || at->second != second) {
    Bucket bucket;
    bucket.second = second;
    bucket.device_s = device_s;
    bucket.arrival_s = arrival_s;
    at = std::make_reverse_iterator(std::next(buckets_.insert(at.base(), bucket)));
    is_news = true;
  } else if (lateness(device_s, arrival_s) < lateness(at->device_s, at->arrival_s)) {
    at->device_s = device_s;
    at->arrival_s = arrival_s;
    is_news = true;
  }
  at->device_sum += device_s;
  at->arrival_sum += arrival_s;
  ++at->count;
  const double oldest_s = last_device_s_ - origin_device_s_ - settings_.window_s;
  while (buckets_.size() > 1 && static_cast<double>(buckets_.front().second) < oldest_s)
    buckets_.pop_front();
  if (is_news) fit();
}

void ClockModel::fit() {
  // Against device time itself, so that slopes are drifts.
  std::vector<Point> points;
  double centre_s = 0.0;
  for (std::size_t i = 0; i < buckets_.size(); ++i) {
    const Bucket& bucket = buckets_[i];
    // What came together with a later sample says nothing that the later one does not.
    if (i + 1 < buckets_.size() && buckets_[i + 1].arrival_s < bucket.arrival_s + kTogether_s)
      continue;
    points.push_back({bucket.device_s, bucket.arrival_s - bucket.device_s});
    centre_s += bucket.device_s;
  }
  centre_s /= static_cast<double>(points.size());
  const std::vector<Point> hull = lower_hull(points);
  if (hull.size() >= 2)
    drift_ =
        std::clamp(slope_at(hull, centre_s), -settings_.largest_drift, settings_.largest_drift);
  intercept_s_ = height_below(hull, drift_, 0.0);
}

double ClockModel::host_time_s(double device_s) const {
  const double device = device_s - origin_device_s_;
  return origin_host_s_ + intercept_s_ + device + drift_ * device;
}

double ClockModel::offset_s() const { return host_time_s(0.0); }

double ClockModel::drift_ppm() const { return 1e6 * drift_; }

double ClockModel::mean_lateness_s() const {
  double sum = 0.0;
  int count = 0;
  for (const Bucket& bucket : buckets_) {
    sum += bucket.arrival_sum - bucket.count * intercept_s_ - (1.0 + drift_) * bucket.device_sum;
    count += bucket.count;
  }
  return count == 0 ? 0.0 : sum / count;
}

}  // namespace sparse_mocap
