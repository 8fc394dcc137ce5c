// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/account.hpp"

#include <algorithm>

#include "runtime/cpp/src/channel/channel.hpp"

namespace rr::channel {
namespace {

// How many times what is left for the others one account may hold.
constexpr std::size_t share = 2;

constexpr std::size_t rounded_up(std::size_t bytes, std::size_t unit) {
  return (bytes + unit - 1) / unit * unit;
}

constexpr std::size_t mib = 1024 * 1024;
// A stranger sends small messages: connections before a session have less each.
constexpr std::size_t stranger_reserve = 8 * 1024;

}  // namespace

Pools make_pools(const NodeOptions& options) {
  const Budget& budget = options.budget;
  const std::size_t for_messages = std::size_t{options.limits.message_size} * 13 / 4;
  const std::size_t sessions =
      budget.sessions != 0 ? budget.sessions : std::max(39 * mib, for_messages);
  const auto make = [](std::size_t bytes, std::size_t reserve, std::size_t largest) {
    return std::make_shared<Pool>(bytes, reserve, largest);
  };
  return {make(budget.before_session, std::min(budget.reserve, stranger_reserve),
               options.size_before_connect),
          make(sessions, budget.reserve, options.limits.message_size)};
}

Pool::Pool(std::size_t limit, std::size_t reserve, std::size_t largest)
    : limit_(limit),
      reserve_(reserve),
      messages_(std::max(limit / 2, std::min(largest, limit))),
      rests_(std::min(largest, limit / 3)) {}

std::size_t Pool::held() const {
  const MutexLock lock(mutex_);
  return held_;
}

bool Pool::lend(std::size_t held, std::size_t more, Use use) {
  const bool is_lent = lend_under_lock(held, more, use);
  if (!is_lent && on_full_ != nullptr) on_full_();
  return is_lent;
}

bool Pool::lend_under_lock(std::size_t held, std::size_t more, Use use) {
  const MutexLock lock(mutex_);
  if (held + more > reserve_) {
    const std::size_t limit = limit_of(use);
    if (held_ > limit || more > limit - held_) return false;
    const bool is_shared = use == Use::part || use == Use::other;
    if (is_shared && held + more > share * (limit - held_ - more)) return false;
  }
  held_ += more;
  peak_ = std::max(peak_, held_);
  return true;
}

std::size_t Pool::limit_of(Use use) const {
  switch (use) {
    case Use::part:
      return messages_ - rests_;
    case Use::rest:
      return messages_;
    case Use::reading:
      return std::max(messages_, limit_ - limit_ / 4);
    case Use::making:
      return limit_ - limit_ / 16;
    default:
      return limit_;
  }
}

bool Pool::is_mostly_free(std::size_t more) const {
  const MutexLock lock(mutex_);
  return held_ <= limit_ / 4 && more <= limit_ / 4 - held_;
}

void Pool::lend_anyway(std::size_t bytes) {
  const MutexLock lock(mutex_);
  held_ += bytes;
  peak_ = std::max(peak_, held_);
}

void Pool::take_back(std::size_t bytes) {
  std::size_t fallen = 0;
  {
    const MutexLock lock(mutex_);
    held_ -= bytes;
    if (on_fall_ != nullptr && peak_ - held_ >= fall_) {
      fallen = peak_ - held_;
      peak_ = held_;
    }
  }
  if (fallen != 0) on_fall_(fallen);
}

Account::Account(std::shared_ptr<Pool> pool, std::size_t limit)
    : limit_(limit), pool_(std::move(pool)) {}

Account::~Account() { pool_->take_back(lent_); }

bool Account::draw_under_lock(std::size_t bytes, Use use) {
  const bool may_exceed = use == Use::present;
  const std::size_t reused = std::min(bytes, offered_);
  bytes -= reused;
  if (reused != 0 && use == Use::other) use = Use::answer;
  if (!may_exceed && (held_ > limit_ || bytes > limit_ - held_)) return false;
  const std::size_t wanted = held_ + bytes;
  if (wanted > lent_) {
    // The rounding must not be what is refused.
    const std::size_t rounded = rounded_up(wanted, quantum);
    if (pool_->lend(lent_, rounded - lent_, use)) {
      lent_ = rounded;
    } else if (pool_->lend(lent_, wanted - lent_, use)) {
      lent_ = wanted;
    } else if (may_exceed) {
      pool_->lend_anyway(wanted - lent_);
      lent_ = wanted;
    } else {
      return false;
    }
  }
  held_ = wanted;
  offered_ -= reused;
  return true;
}

bool Account::draw(std::size_t bytes) {
  const MutexLock lock(mutex_);
  return draw_under_lock(bytes, Use::other);
}

bool Account::draw_part(std::size_t bytes) {
  const MutexLock lock(mutex_);
  return draw_under_lock(bytes, Use::part);
}

bool Account::draw_rest(std::size_t bytes) {
  const MutexLock lock(mutex_);
  return draw_under_lock(bytes, Use::rest);
}

bool Account::draw_reading(std::size_t bytes) {
  const MutexLock lock(mutex_);
  return draw_under_lock(bytes, Use::reading);
}

bool Account::draw_making(std::size_t bytes) {
  const MutexLock lock(mutex_);
  return draw_under_lock(bytes, Use::making);
}

bool Account::draw_ahead(std::size_t bytes) {
  const MutexLock lock(mutex_);
  return pool_->is_mostly_free(bytes) && draw_under_lock(bytes, Use::other);
}

void Account::draw_anyway(std::size_t bytes) {
  const MutexLock lock(mutex_);
  draw_under_lock(bytes, Use::present);
}

void Account::give_back(std::size_t bytes) {
  const MutexLock lock(mutex_);
  give_back_under_lock(bytes);
}

void Account::offer(std::size_t bytes) {
  const MutexLock lock(mutex_);
  offered_ += bytes;
}

void Account::end_offer(std::size_t bytes) {
  const MutexLock lock(mutex_);
  const std::size_t left = std::min(bytes, offered_);
  offered_ -= left;
  if (left != 0) give_back_under_lock(left);
}

void Account::give_back_under_lock(std::size_t bytes) {
  held_ -= std::min(bytes, held_);
  // One quantum stays, so that an account that goes up and down does not lock its pool each time.
  const std::size_t needed = held_ == 0 ? 0 : rounded_up(held_, quantum) + quantum;
  if (lent_ <= needed) return;
  pool_->take_back(lent_ - needed);
  lent_ = needed;
}

void Account::move_to(std::shared_ptr<Pool> pool) {
  const MutexLock lock(mutex_);
  pool->lend_anyway(held_);
  pool_->take_back(lent_);
  lent_ = held_;
  pool_ = std::move(pool);
}

std::size_t Account::held() const {
  const MutexLock lock(mutex_);
  return held_;
}

bool Charge::add(std::size_t bytes) {
  if (account_ && !account_->draw(bytes)) return false;
  bytes_ += bytes;
  return true;
}

bool Charge::add_part(std::size_t bytes) {
  if (account_ && !account_->draw_part(bytes)) return false;
  bytes_ += bytes;
  return true;
}

bool Charge::add_rest(std::size_t bytes) {
  if (account_ && !account_->draw_rest(bytes)) return false;
  bytes_ += bytes;
  return true;
}

bool Charge::add_reading(std::size_t bytes) {
  if (account_ && !account_->draw_reading(bytes)) return false;
  bytes_ += bytes;
  return true;
}

bool Charge::add_making(std::size_t bytes) {
  if (account_ && !account_->draw_making(bytes)) return false;
  bytes_ += bytes;
  return true;
}

bool Charge::add_ahead(std::size_t bytes) {
  if (account_ && !account_->draw_ahead(bytes)) return false;
  bytes_ += bytes;
  return true;
}

void Charge::add_anyway(std::size_t bytes) {
  if (account_) account_->draw_anyway(bytes);
  bytes_ += bytes;
}

bool Charge::can_add(std::size_t bytes) const {
  if (!account_) return true;
  if (!account_->draw(bytes)) return false;
  account_->give_back(bytes);
  return true;
}

void Charge::reduce(std::size_t bytes) {
  bytes = std::min(bytes, bytes_);
  if (bytes == 0) return;
  if (account_) account_->give_back(bytes);
  bytes_ -= bytes;
}

}  // namespace rr::channel
