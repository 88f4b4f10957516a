// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "sparse_mocap/streams/drivers.hpp"

namespace sparse_mocap::streams::testing {

// Spaces between pairs of digits are passed over: "FA FF 30 00 D1".
inline Bytes from_hex(std::string_view text) {
  Bytes bytes;
  for (std::size_t i = 0; i + 1 < text.size();) {
    if (text[i] == ' ') {
      ++i;
      continue;
    }
    bytes.push_back(
        static_cast<std::uint8_t>(std::stoi(std::string(text.substr(i, 2)), nullptr, 16)));
    i += 2;
  }
  return bytes;
}

inline Bytes from_text(std::string_view text) { return {text.begin(), text.end()}; }

inline Bytes& operator+=(Bytes& a, const Bytes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

inline Bytes joined(const std::vector<Bytes>& packets) {
  Bytes all;
  for (const auto& packet : packets) all += packet;
  return all;
}

// SlimeVR's parser takes streams of datagrams with their length before each.
inline Bytes as_stream(std::string_view driver, const std::vector<Bytes>& packets) {
  if (driver != "slimevr") return joined(packets);
  Bytes all;
  for (const auto& packet : packets) {
    all.push_back(static_cast<std::uint8_t>(packet.size() >> 8));
    all.push_back(static_cast<std::uint8_t>(packet.size()));
    all += packet;
  }
  return all;
}

struct Parsed {
  std::vector<Sample> samples;
  Counters counters;
  std::vector<std::string> names;
  std::string message;

  std::uint64_t operator[](Count what) const { return counters[what]; }
};

enum class Pieces { whole, single, random };

inline Parsed parsed(std::string_view driver, ByteView bytes, const OptionMap& options = {},
                     Pieces pieces = Pieces::whole) {
  const auto parser = make_parser(driver, options);
  Parsed out;
  std::mt19937 random(7);
  while (!bytes.empty()) {
    std::size_t size = pieces == Pieces::single ? 1 : bytes.size();
    if (pieces == Pieces::random) size = std::min<std::size_t>(bytes.size(), 1 + random() % 97);
    parser->feed(bytes.first(size), out.samples);
    bytes = bytes.subspan(size);
  }
  out.counters = parser->counters();
  out.names = parser->sensor_names();
  out.message = parser->last_message();
  return out;
}

inline bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

inline bool same(const Sample& a, const Sample& b) {
  bool is_same = a.sensor == b.sensor && same(a.time_s, b.time_s) && a.counter == b.counter &&
                 a.flags == b.flags;
  for (int i = 0; i < 3; ++i)
    is_same = is_same && same(a.specific_force[i], b.specific_force[i]) &&
              same(a.angular_velocity[i], b.angular_velocity[i]);
  for (int i = 0; i < 4; ++i) is_same = is_same && same(a.orientation[i], b.orientation[i]);
  return is_same;
}

// However the bytes are cut, nothing differs.
inline void expect_same_in_pieces(std::string_view driver, ByteView bytes,
                                  const OptionMap& options = {}) {
  const auto whole = parsed(driver, bytes, options);
  for (const auto pieces : {Pieces::single, Pieces::random}) {
    const auto cut = parsed(driver, bytes, options, pieces);
    EXPECT_EQ(cut.counters, whole.counters) << driver;
    EXPECT_EQ(cut.names, whole.names) << driver;
    ASSERT_EQ(cut.samples.size(), whole.samples.size()) << driver;
    for (std::size_t i = 0; i < cut.samples.size(); ++i)
      ASSERT_TRUE(same(cut.samples[i], whole.samples[i])) << driver << " sample " << i;
  }
}

inline void expect_near(const Vec3& value, const Vec3& expected, double tolerance) {
  EXPECT_LT((value - expected).cwiseAbs().maxCoeff(), tolerance)
      << value.transpose() << " instead of " << expected.transpose();
}

}  // namespace sparse_mocap::streams::testing
