// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <stdexcept>

namespace sparse_mocap {

// A skeleton that is not a human body, or whose joints are not recognised; what() says why.
class MappingError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace sparse_mocap
