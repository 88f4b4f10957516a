// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "formats/format_test_support.hpp"
#include "sparse_mocap/formats/acclaim.hpp"

namespace sparse_mocap::testing {

// root - thigh - shin, thigh - fin; `length 0.0254` makes a unit of the file a metre.
inline const std::string kAsf =
    "# a small skeleton\n"         // 1
    ":version 1.10\n"              // 2
    ":name small\n"                // 3
    ":units\n"                     // 4
    "  mass 1.0\n"                 // 5
    "  length 0.0254\n"            // 6
    "  angle deg\n"                // 7
    ":documentation\n"             // 8
    "  here we begin\n"            // 9
    ":root\n"                      // 10
    "  order TX TY TZ RX RY RZ\n"  // 11
    "  axis XYZ\n"                 // 12
    "  position 0 0 0\n"           // 13
    "  orientation 0 0 0\n"        // 14
    ":bonedata\n"                  // 15
    "  begin\n"                    // 16
    "    id 1\n"                   // 17
    "    name thigh\n"             // 18
    "    direction 0 -1 0\n"       // 19
    "    length 0.5\n"             // 20
    "    axis 0 0 0 XYZ\n"         // 21
    "    dof rx ry rz\n"           // 22
    "    limits (-160.0 20.0)\n"   // 23
    "           (-70.0 70.0)\n"    // 24
    "           (-inf inf)\n"      // 25
    "  end\n"                      // 26
    "  begin\n"                    // 27
    "    id 2\n"                   // 28
    "    name shin\n"              // 29
    "    direction 0 -1 0\n"       // 30
    "    length 0.4\n"             // 31
    "    axis 0 0 0 XYZ\n"         // 32
    "    dof rx\n"                 // 33
    "    limits (0 0)\n"           // 34
    "  end\n"                      // 35
    "  begin\n"                    // 36
    "    id 3\n"                   // 37
    "    name fin\n"               // 38
    "    direction 1 0 0\n"        // 39
    "    length 0.1\n"             // 40
    "    axis 0 0 0 XYZ\n"         // 41
    "  end\n"                      // 42
    ":hierarchy\n"                 // 43
    "  begin\n"                    // 44
    "    root thigh\n"             // 45
    "    thigh shin fin\n"         // 46
    "  end\n";                     // 47

inline const std::string kAmc =
    "#!OML:ASF small\n"    // 1
    ":FULLY-SPECIFIED\n"   // 2
    ":DEGREES\n"           // 3
    "1\n"                  // 4
    "root 1 2 3 0 0 0\n"   // 5
    "thigh 0 0 0\n"        // 6
    "shin 0\n"             // 7
    "2\n"                  // 8
    "root 1 2 3 0 0 90\n"  // 9
    "thigh 90 90 0\n"      // 10
    "shin 90\n";           // 11

inline AcclaimSkeleton read_asf_text(const std::string& text, const ReadOptions& options = {}) {
  const TemporaryFolder folder;
  auto asf = read_asf(folder.write("small.asf", text), options);
  EXPECT_EQ(joined(check_skeleton(asf.skeleton)), "");
  EXPECT_EQ(asf.channels.size(), asf.skeleton.joints().size());
  return asf;
}

inline MotionFile read_acclaim_text(const std::string& asf, const std::string& amc,
                                    const ReadOptions& options = {}) {
  const TemporaryFolder folder;
  folder.write("small.asf", asf);
  return sound(read_motion_file(folder.write("small_01.amc", amc), options));
}

}  // namespace sparse_mocap::testing
