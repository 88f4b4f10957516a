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

struct Line {
  double height = 0.0;  // at the centre
  double slope = 0.0;
};

// How far apart the lowest tenth of the heights are: only these touch a line.
double spacing_of_lowest(std::vector<double>& heights) {
  const auto tenth = static_cast<std::ptrdiff_t>(heights.size() / 10);
  std::nth_element(heights.begin(), heights.begin() + tenth, heights.end());
  const double lowest = *std::min_element(heights.begin(), heights.begin() + tenth + 1);
  return std::max(
      (heights[static_cast<std::size_t>(tenth)] - lowest) / static_cast<double>(1 + tenth), 1e-9);
}

// The mean of all lines that the points allow, each as likely as it makes the lateness: near an
// edge arrivals are spread evenly, so that a line which leaves room for one more below them all is
// less likely by e (Pitman's estimator; the likeliest line rests on two points alone and is a third
// further off). The line above all arrivals tells the slope too where lateness ends as sharply as
// it begins, as by a radio's slots; its word counts half, for delays have a largest value by habit
// only.
Line mean_line(const std::vector<Point>& points, double centre, double limit) {
  std::vector<Point> turned;
  for (const Point& p : points) turned.push_back({p.x, -p.y});
  const std::vector<Point> below = lower_hull(points), above = lower_hull(turned);
  const double likeliest = std::clamp(slope_at(below, centre), -limit, limit);
  std::vector<double> heights, depths;
  for (const Point& p : points) heights.push_back(p.y - likeliest * p.x);
  for (const double height : heights) depths.push_back(-height);
  const double unit = spacing_of_lowest(heights);
  const double unit_above = std::max(spacing_of_lowest(depths), unit);
  const double reach = 40.0 * unit / (points.back().x - points.front().x);
  const double height = height_below(below, likeliest, centre);
  const double depth = height_below(above, -likeliest, centre);
  double weights = 0.0;
  Line sum;
  constexpr int kSteps = 80;
  for (int step = -kSteps; step <= kSteps; ++step) {
    const double slope = likeliest + reach * step / kSteps;
    if (std::abs(slope) > limit) continue;
    const double own_height = height_below(below, slope, centre);
    const double own_depth = height_below(above, -slope, centre);
    const double weight =
        std::exp((own_height - height) / unit + 0.5 * (own_depth - depth) / unit_above);
    weights += weight;
    sum.height += weight * own_height;
    sum.slope += weight * slope;
  }
  return {sum.height / weights - unit, sum.slope / weights};
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
  if (num_segments_ == 0 || was_reset(device_s, arrival_s)) start_segment(device_s, arrival_s);
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

void ClockModel::start_segment(double device_s, double arrival_s) {
  ++num_segments_;
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
  Line line{points.front().y, drift_};
  if (points.size() >= 2) line = mean_line(points, centre_s, settings_.largest_drift);
  drift_ = line.slope;
  intercept_s_ = line.height - line.slope * centre_s;
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
