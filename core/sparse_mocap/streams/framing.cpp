// SPDX-License-Identifier: GPL-3.0-or-later
#include "sparse_mocap/streams/framing.hpp"

#include <algorithm>

namespace sparse_mocap::streams {

void FrameScanner::feed(ByteView bytes, Counters& counters,
                        const std::function<Head(ByteView)>& inspect,
                        const std::function<void(ByteView)>& accept) {
  while (!bytes.empty()) {
    const std::size_t taken = std::min(bytes.size(), 2 * capacity_ - pending_.size());
    pending_.insert(pending_.end(), bytes.begin(),
                    bytes.begin() + static_cast<std::ptrdiff_t>(taken));
    bytes = bytes.subspan(taken);
    scan(counters, inspect, accept);
  }
}

void FrameScanner::scan(Counters& counters, const std::function<Head(ByteView)>& inspect,
                        const std::function<void(ByteView)>& accept) {
  ByteView rest(pending_);
  while (!rest.empty()) {
    Head head = inspect(rest);
    if (head.kind == Head::Kind::need_more) {
      if (rest.size() < capacity_) break;
      head = Head::skip();
    }
    if (head.kind == Head::Kind::frame) {
      is_skipping_ = false;
      accept(rest.first(head.size));
      rest = rest.subspan(head.size);
    } else {
      counters[Count::resyncs] += is_skipping_ ? 0 : 1;
      ++counters[Count::skipped_bytes];
      is_skipping_ = true;
      rest = rest.subspan(1);
    }
  }
  pending_.erase(pending_.begin(), pending_.end() - static_cast<std::ptrdiff_t>(rest.size()));
}

void FrameScanner::reset() {
  pending_.clear();
  is_skipping_ = false;
}

void LineSplitter::feed(ByteView bytes, Counters& counters,
                        const std::function<void(ByteView)>& accept) {
  while (!bytes.empty()) {
    const auto end = std::ranges::find(bytes, std::uint8_t{'\n'});
    const auto length = static_cast<std::size_t>(end - bytes.begin());
    if (is_too_long_ || line_.size() + length > kLongestLine) {
      counters[Count::overruns] += is_too_long_ ? 0 : 1;
      counters[Count::skipped_bytes] += length + line_.size();
      is_too_long_ = true;
      line_.clear();
    } else {
      line_.insert(line_.end(), bytes.begin(), end);
    }
    if (end == bytes.end()) return;
    if (!is_too_long_) accept(line_);
    is_too_long_ = false;
    line_.clear();
    bytes = bytes.subspan(length + 1);
  }
}

void LineSplitter::reset() {
  line_.clear();
  is_too_long_ = false;
}

}  // namespace sparse_mocap::streams
