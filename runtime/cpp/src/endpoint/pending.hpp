// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "rr/buffer.hpp"
#include "rr/error.hpp"
#include "rr/reader.hpp"
#include "runtime/cpp/src/channel/connection.hpp"

namespace rr::endpoint {

/// What a request asks for, as far as its answer says it again: the type, of which the answer's is
/// one more, the path and the member (07, section 1).
class Asked {
 public:
  Asked() = default;
  /// The texts may go before the answer comes.
  Asked(EntryType type, std::string_view path, std::string_view member);
  /// The texts stay for as long as the request is open: what a blocking call has. They are compared
  /// as they are, which is quicker.
  static Asked while_open(EntryType type, std::string_view path, std::string_view member);

  /// Where a generator is that a request opens.
  struct Opening {
    std::string path;
    std::string member;
  };
  /// The same of a request that opens a generator.
  static Asked opening(EntryType type, std::string_view path, std::string_view member);
  /// Null for other requests.
  [[nodiscard]] const std::shared_ptr<const Opening>& opened() const { return opening_; }
  /// False for an entry that answers something else. A path or member that it leaves out is right.
  [[nodiscard]] bool is_answered_by(const Entry& entry) const;

 private:
  // A text that stays, or the hash of one that may be gone when the answer comes.
  struct Text {
    const char* letters = nullptr;  // null for a hash
    std::size_t size_or_hash = 0;
  };

  [[nodiscard]] bool is_path(std::string_view path) const;
  [[nodiscard]] bool is_member(std::string_view member) const;

  EntryType type_ = EntryType::null;
  Text path_;
  Text member_;
  std::shared_ptr<const Opening> opening_;
};

/// A request that has no answer yet. Whoever takes it out of the table ends it, by exactly one of
/// the two functions, which may neither wait nor run user code.
class Pending {
 public:
  virtual void answer(const Message& message, const Entry& entry, const MemoryRef& owner,
                      channel::DeferredCallbacks& deferred) = 0;
  virtual void fail(const Error& error, channel::DeferredCallbacks& deferred) = 0;

  /// True once it has been in a table, to the thread that put it there.
  [[nodiscard]] bool was_added() const { return was_added_; }

 protected:
  Pending() = default;
  ~Pending() = default;

 private:
  friend class PendingTable;
  Asked asked_;
  std::uint32_t id_ = 0;
  bool is_open_ = false;
  bool was_added_ = false;
  Pending* next_ = nullptr;
};

/// The open requests of one endpoint, by their numbers. Not synchronized.
class PendingTable {
 public:
  /// Gives the request its number: they start at 1 and grow by 1; numbers in use are skipped.
  std::uint32_t add(Pending& request, Asked asked);
  /// The next number, for a request whose answer nobody waits for.
  std::uint32_t skip();
  struct Answered {
    Pending* request = nullptr;  ///< null when the entry answers none that is open
    bool is_foreign = false;     ///< there is one of its number, which asked for something else
    /// It answers the opening of a generator that nobody waits for any more: where that is.
    std::shared_ptr<const Asked::Opening> abandoned{};
  };
  /// The request that an entry answers. One that asked for something else stays open.
  Answered take_answered(const Entry& entry);
  /// False when somebody else has taken it.
  bool take(Pending& request);
  /// Any one; null when there is none.
  Pending* take_any();
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  Pending** find(std::uint32_t id);
  Pending* take(Pending** link);
  /// Remembers a request that is taken without its answer, if it opens a generator.
  void abandon(const Pending& request);
  std::shared_ptr<const Asked::Opening> take_abandoned(const Entry& entry);
  void grow();

  std::vector<Pending*> buckets_;  // chains, by the lowest bits of the number
  std::size_t size_ = 0;
  std::uint32_t next_id_ = 1;
  std::map<std::uint32_t, Asked> abandoned_;  // openings of generators, by their numbers
};

}  // namespace rr::endpoint
