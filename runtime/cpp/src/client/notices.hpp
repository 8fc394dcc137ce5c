// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

#include "rr/reader.hpp"
#include "rr/wire.hpp"

namespace rr::client {

/// What a service says of ends that it has ended: that an endpoint of a pipe was closed, or an
/// object released. An answer to connecting is read at once, a notice in turn with all other
/// messages. So a new end keeps how many notices were read before its answer, and those are of
/// others that had its place.
class Notices {
 public:
  [[nodiscard]] static bool is_one(const Entry& entry) {
    return entry.type == EntryType::pipe_closed ||
           entry.type == EntryType::service_path_released_req;
  }
  /// A message that has been read, and will be handled in its turn.
  void foresee(const Message& message) {
    EntryReader entries(message);
    for (Entry entry; entries.next(entry);) {
      if (is_one(entry)) ++read_;
    }
  }
  /// How many have been read; what an end keeps, from the thread that reads its answer.
  [[nodiscard]] std::uint64_t read() const { return read_; }
  /// The number of the one that is handled now. It means an end that has kept a smaller number.
  std::uint64_t next() { return ++handled_; }

 private:
  std::atomic<std::uint64_t> read_ = 0;
  std::uint64_t handled_ = 0;  // by whoever handles messages, one at a time
};

}  // namespace rr::client
