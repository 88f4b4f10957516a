// SPDX-License-Identifier: GPL-3.0-or-later
//
// Recorded streams of an MTi with what another program decoded from them; they are not in the
// repository, see formats/format_test_support.hpp.
#include <fstream>
#include <map>
#include <sstream>

#include "formats/format_test_support.hpp"
#include "sparse_mocap/streams/orientation.hpp"
#include "streams/stream_test_support.hpp"

namespace sparse_mocap::streams {
namespace {

using namespace testing;
using sparse_mocap::testing::real_data;

// One packet of the decoder's text: "Acceleration(Float32):" and indented "X:-0.017" lines.
using Packet = std::map<std::string, std::vector<double>>;

std::string file_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::vector<Packet> read_golden(const std::filesystem::path& path) {
  std::istringstream text(file_text(path));
  std::vector<Packet> packets(1);
  std::string field;
  for (std::string line; std::getline(text, line);) {
    if (line.empty()) {
      packets.emplace_back();
    } else if (line[0] != ' ') {
      field = line.substr(0, line.find_first_of("(:"));
      packets.back()[field];
    } else {
      const auto colon = line.find(':');
      const auto value =
          line.substr(colon == std::string::npos || field == "UTCTime" ? 2 : colon + 1);
      packets.back()[field].push_back(std::atof(value.c_str()));
    }
  }
  std::erase_if(packets, [](const Packet& packet) { return packet.empty(); });
  return packets;
}

Vec3 vector_of(const Packet& packet, const std::string& field) {
  const auto& v = packet.at(field);
  return {v.at(0), v.at(1), v.at(2)};
}

Quat expected_rotation(const Packet& packet) {
  if (packet.contains("Quaternion")) {
    const auto& q = packet.at("Quaternion");
    return Quat(q[0], q[1], q[2], q[3]);
  }
  const Vec3 rad = vector_of(packet, "EulerAngles") * kRadiansPerDegree;
  return Quat(Eigen::AngleAxisd(rad[2], Vec3::UnitZ()) * Eigen::AngleAxisd(rad[1], Vec3::UnitY()) *
              Eigen::AngleAxisd(rad[0], Vec3::UnitX()));
}

void check(const Sample& sample, const Packet& packet) {
  EXPECT_EQ(sample.counter, std::int64_t(packet.at("PacketCounter")[0]));
  EXPECT_NEAR(sample.time_s, packet.at("SampleTimeFine")[0] * 1e-4, 1e-9);
  if (packet.contains("Acceleration")) {
    EXPECT_EQ(sample.specific_force, vector_of(packet, "Acceleration"));
  }
  EXPECT_EQ(sample.angular_velocity.allFinite(), packet.contains("RateOfTurn"));
  if (packet.contains("RateOfTurn")) {
    EXPECT_EQ(sample.angular_velocity, vector_of(packet, "RateOfTurn"));
  }
  if (packet.contains("MagneticField")) {
    EXPECT_EQ(sample.magnetic_field, vector_of(packet, "MagneticField"));
  }
  const bool turns = packet.contains("Quaternion") || packet.contains("EulerAngles");
  EXPECT_EQ(sample.has_orientation(), turns);
  if (!turns) return;
  const Quat q = expected_rotation(packet);
  EXPECT_LT(z_up_from_orientation(sample.orientation).angularDistance(q.normalized()), 1e-6);
  if (!packet.contains("FreeAcceleration")) return;
  const Vec3 in_world = q.normalized() * sample.specific_force;
  expect_near(in_world, vector_of(packet, "FreeAcceleration") + Vec3(0, 0, 9.81), 1e-5);
  EXPECT_TRUE(sample.flags & kGravityRestored);
}

TEST(XsensStreams, DecodeAsAnotherProgramDoes) {
  SKIP_WITHOUT_REAL_DATA("imu/xsens_mt_streams");
  const auto folder = real_data("imu/xsens_mt_streams") / "testdata";
  for (const char* number : {"1", "2", "3", "4", "5"}) {
    SCOPED_TRACE(number);
    const auto bytes = from_text(file_text(folder / number / "output.bin"));
    auto packets = read_golden(folder / number / "output.golden");
    const auto result = parsed("xsens_mt", bytes);
    EXPECT_EQ(result[Count::frames], packets.size());
    EXPECT_EQ(result[Count::bad_checksums] + result[Count::skipped_bytes] +
                  result[Count::malformed] + result[Count::unknown_types] +
                  result[Count::missing_samples] + result[Count::repeated],
              0u);
    std::erase_if(packets, [](const Packet& packet) {
      return !packet.contains("Acceleration") && !packet.contains("FreeAcceleration") &&
             !packet.contains("Quaternion");
    });
    ASSERT_EQ(result.samples.size(), packets.size());
    ASSERT_GT(packets.size(), 50u);
    for (std::size_t i = 0; i < packets.size(); ++i) check(result.samples[i], packets[i]);
    expect_same_in_pieces("xsens_mt", bytes);
  }
}

}  // namespace
}  // namespace sparse_mocap::streams
