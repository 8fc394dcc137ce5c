// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "rr/buffer.hpp"
#include "rr/error.hpp"
#include "rr/reader.hpp"
#include "runtime/cpp/src/channel/connection.hpp"

namespace rr::endpoint {

/// A request that has no answer yet. Whoever takes it out of the table ends it, by exactly one of
/// the two functions, which may neither wait nor run user code.
class Pending {
 public:
  virtual void answer(const Message& message, const Entry& entry, const MemoryRef& owner,
                      channel::Laters& laters) = 0;
  virtual void fail(const Error& error, channel::Laters& laters) = 0;

  /// True once it has been in a table, to the thread that put it there.
  [[nodiscard]] bool was_added() const { return was_added_; }

 protected:
  Pending() = default;
  ~Pending() = default;

 private:
  friend class PendingTable;
  std::uint32_t id_ = 0;
  bool is_open_ = false;
  bool was_added_ = false;
  Pending* next_ = nullptr;
};

/// The open requests of one endpoint, by their numbers. Not synchronized.
class PendingTable {
 public:
  /// Gives the request its number: they start at 1 and grow by 1; numbers in use are skipped.
  std::uint32_t add(Pending& request);
  /// The next number, for a request whose answer nobody waits for.
  std::uint32_t skip();
  /// Null when there is none of this number.
  Pending* take(std::uint32_t id);
  /// False when somebody else has taken it.
  bool take(Pending& request);
  /// Any one; null when there is none.
  Pending* take_any();

 private:
  Pending** find(std::uint32_t id);
  void grow();

  std::vector<Pending*> buckets_;  // chains, by the lowest bits of the number
  std::size_t size_ = 0;
  std::uint32_t next_id_ = 1;
};

}  // namespace rr::endpoint
