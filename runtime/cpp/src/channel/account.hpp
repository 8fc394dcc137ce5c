// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>

#include "rr/mutex.hpp"

namespace rr::channel {

/// A pool of bytes that the peers of a node share: those in sessions have one, those before a
/// session another. An account draws on it for one connection.
///
/// One account gets at most twice what would then be left for the others, so that a single peer may
/// hold two thirds of the pool and many peers equal shares; and always a small reserve, so that a
/// full pool does not stop small messages.
///
/// What comes leaves room for what is made of it, so that peers do not wait for each other:
/// messages may fill half of the pool, or as much as one of them takes; what is read from them goes
/// up to three quarters; what handlers make leaves a sixteenth; answers, and what is kept, have all
/// of it. Messages that come in parts leave room for the rest of the largest, at most a third of
/// the pool.
class Pool {
 public:
  /// `largest`: a message.
  Pool(std::size_t limit, std::size_t reserve, std::size_t largest = 0);
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  /// Bytes that may be drawn in all; reserves come on top.
  [[nodiscard]] std::size_t limit() const { return limit_; }
  /// Bytes that are drawn now.
  [[nodiscard]] std::size_t held() const;
  /// Before it is used: called, on any thread, each time `bytes` less are held than were before,
  /// with how many less. It may use neither accounts nor pools.
  void set_on_fall(std::size_t bytes, std::function<void(std::size_t fallen)> on_fall) {
    fall_ = bytes;
    on_fall_ = std::move(on_fall);
  }
  /// Before it is used: called, on any thread, each time it refuses. The same holds for it.
  void set_on_full(std::function<void()> on_full) { on_full_ = std::move(on_full); }

 private:
  friend class Account;
  // What is drawn for: a part of a message, all that is missing of one, what is read from one, what
  // a handler makes, an answer for which some was drawn already, anything else, or what is there
  // anyway. How far it may fill the pool, and whether beyond the share of one account.
  enum class Use : std::uint8_t { part, rest, reading, making, answer, other, present };

  // `more` bytes for an account that has `held`. False, and nothing happens, when they are too
  // many.
  bool lend(std::size_t held, std::size_t more, Use use);
  bool lend_under_lock(std::size_t held, std::size_t more, Use use);
  [[nodiscard]] std::size_t limit_of(Use use) const;
  [[nodiscard]] bool is_mostly_free(std::size_t more) const;
  void lend_anyway(std::size_t bytes);
  void take_back(std::size_t bytes);

  const std::size_t limit_;
  const std::size_t reserve_;
  const std::size_t messages_;  // may take so much
  const std::size_t rests_;     // of which parts leave so much
  std::size_t fall_ = 0;
  std::function<void(std::size_t)> on_fall_;
  std::function<void()> on_full_;
  mutable Mutex mutex_;
  std::size_t held_ RR_GUARDED_BY(mutex_) = 0;
  std::size_t peak_ RR_GUARDED_BY(mutex_) = 0;  // of held_, since it has last fallen far
};

/// For accounts that their pool alone limits.
inline constexpr std::size_t no_limit = static_cast<std::size_t>(-1);

/// What one connection makes this node hold, in bytes: messages that arrive, wait or are handled,
/// answers and packets that wait to be sent, what a session keeps (docs/reference/limits.md). Any
/// thread.
class Account {
 public:
  /// `limit` bytes at most, whatever the pool has.
  Account(std::shared_ptr<Pool> pool, std::size_t limit);
  ~Account();
  Account(const Account&) = delete;
  Account& operator=(const Account&) = delete;

  /// False, and nothing happens, when this peer holds too much with so many bytes more.
  [[nodiscard]] bool draw(std::size_t bytes);
  /// The same for a part of what is of use only when it is whole: leaves room for rests.
  [[nodiscard]] bool draw_part(std::size_t bytes);
  /// The same for all that is missing of it: as long as the pool has so much this peer may hold
  /// more than its share. Otherwise several could wait for each other.
  [[nodiscard]] bool draw_rest(std::size_t bytes);
  /// The same for what is read from a message that is there.
  [[nodiscard]] bool draw_reading(std::size_t bytes);
  /// The same for what the handler of a request makes.
  [[nodiscard]] bool draw_making(std::size_t bytes);
  /// For what may never come: only while three quarters of the pool stay free.
  [[nodiscard]] bool draw_ahead(std::size_t bytes);
  /// For what has come about already: goes beyond the limits.
  void draw_anyway(std::size_t bytes);
  void give_back(std::size_t bytes);
  /// Of the bytes that are held so many may be drawn once more, by whoever comes first: what they
  /// were drawn for is about to be drawn in another place.
  void offer(std::size_t bytes);
  /// Gives back what is left of so many that were offered.
  void end_offer(std::size_t bytes);
  /// What is held, and what comes, counts in another pool from now on.
  void move_to(std::shared_ptr<Pool> pool);
  [[nodiscard]] std::size_t held() const;

 private:
  using Use = Pool::Use;
  bool draw_under_lock(std::size_t bytes, Use use) RR_REQUIRES(mutex_);
  void give_back_under_lock(std::size_t bytes) RR_REQUIRES(mutex_);

  // The pool is asked for so much at once, so that most draws do not lock it.
  static constexpr std::size_t quantum = 16 * 1024;

  const std::size_t limit_;
  mutable Mutex mutex_;
  std::shared_ptr<Pool> pool_ RR_GUARDED_BY(mutex_);
  std::size_t held_ RR_GUARDED_BY(mutex_) = 0;
  std::size_t lent_ RR_GUARDED_BY(mutex_) = 0;     // by the pool: held_ or more
  std::size_t offered_ RR_GUARDED_BY(mutex_) = 0;  // of held_
};

/// Bytes of an account, for as long as this exists.
class Charge {
 public:
  Charge() = default;
  explicit Charge(std::shared_ptr<Account> account) : account_(std::move(account)) {}
  ~Charge() { clear(); }
  Charge(Charge&& other) noexcept
      : account_(std::move(other.account_)), bytes_(std::exchange(other.bytes_, 0)) {}
  Charge& operator=(Charge&& other) noexcept {
    std::swap(account_, other.account_);
    std::swap(bytes_, other.bytes_);
    return *this;
  }

  [[nodiscard]] std::size_t bytes() const { return bytes_; }
  [[nodiscard]] bool has_account() const { return account_ != nullptr; }
  /// False, and nothing happens, when the account refuses. Without an account there is no limit.
  [[nodiscard]] bool add(std::size_t bytes);
  /// The same with Account::draw_part().
  [[nodiscard]] bool add_part(std::size_t bytes);
  /// The same with Account::draw_rest().
  [[nodiscard]] bool add_rest(std::size_t bytes);
  /// The same with Account::draw_reading().
  [[nodiscard]] bool add_reading(std::size_t bytes);
  /// The same with Account::draw_making().
  [[nodiscard]] bool add_making(std::size_t bytes);
  /// The same with Account::draw_ahead().
  [[nodiscard]] bool add_ahead(std::size_t bytes);
  void add_anyway(std::size_t bytes);
  /// Whether add() would do; another thread may be faster.
  [[nodiscard]] bool can_add(std::size_t bytes) const;
  /// At most what it has.
  void reduce(std::size_t bytes);
  void clear() {
    if (bytes_ != 0) reduce(bytes_);
  }

 private:
  friend class OfferedCharge;

  std::shared_ptr<Account> account_;
  std::size_t bytes_ = 0;
};

/// Offers what a charge has (Account::offer) for as long as this exists; the charge has nothing
/// then.
class OfferedCharge {
 public:
  explicit OfferedCharge(Charge&& charge)
      : account_(std::move(charge.account_)), bytes_(std::exchange(charge.bytes_, 0)) {
    if (account_ && bytes_ != 0) account_->offer(bytes_);
  }
  ~OfferedCharge() {
    if (account_ && bytes_ != 0) account_->end_offer(bytes_);
  }
  OfferedCharge(const OfferedCharge&) = delete;
  OfferedCharge& operator=(const OfferedCharge&) = delete;

 private:
  const std::shared_ptr<Account> account_;
  const std::size_t bytes_;
};

}  // namespace rr::channel
