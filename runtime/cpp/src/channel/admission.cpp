// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/admission.hpp"

#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/logging.hpp"
#include "runtime/cpp/src/channel/metrics.hpp"

namespace rr::channel {
namespace {

constexpr std::chrono::seconds between_warnings{1};

bool is_full(std::size_t count, std::size_t limit) { return limit != 0 && count >= limit; }

}  // namespace

bool Admission::Place::take(const std::shared_ptr<Connection>& connection) {
  const MutexLock lock(admission_->mutex_);
  connection_ = connection;
  return is_counted_;
}

void Admission::Place::set_authorised(bool is_authorised) {
  const MutexLock lock(admission_->mutex_);
  if (!is_counted_ || is_stranger_ != is_authorised) return;
  if (is_authorised) {
    admission_->remove_stranger(*this);
  } else {
    admission_->add_stranger(*this);
  }
}

void Admission::Place::leave() {
  const MutexLock lock(admission_->mutex_);
  if (is_counted_) admission_->remove(*this);
}

Admission::Admission(std::shared_ptr<const NodeOptions> options, std::shared_ptr<Metrics> metrics)
    : options_(std::move(options)), metrics_(std::move(metrics)) {}

std::shared_ptr<Admission::Place> Admission::enter(std::string address) {
  auto place = std::make_shared<Place>(shared_from_this(), std::move(address));
  std::vector<Leaving> leaving;
  {
    const MutexLock lock(mutex_);
    if (is_full(count_, options_->max_connections) && !choose(strangers_, leaving)) {
      if (metrics_) metrics_->count_beyond_limit();
      return nullptr;
    }
    if (is_full(strangers_.size(), options_->max_connections_before_session)) {
      choose(strangers_, leaving);
    }
    const auto same = by_address_.find(place->address_);
    if (same != by_address_.end() &&
        is_full(same->second.size(), options_->max_connections_per_address)) {
      choose(same->second, leaving);
    }
    ++count_;
    place->admission_->mutex_.assert_held();  // this one's, here and below
    place->is_counted_ = true;
    add_stranger(*place);
  }
  if (metrics_) metrics_->count_accepted();
  close(leaving);
  return place;
}

bool Admission::give_way() {
  std::vector<Leaving> leaving;
  {
    const MutexLock lock(mutex_);
    if (!choose(strangers_, leaving)) return false;
  }
  close(leaving);
  return true;
}

void Admission::add_stranger(Place& place) {
  place.admission_->mutex_.assert_held();
  place.is_stranger_ = true;
  place.in_all_ = strangers_.insert(strangers_.end(), &place);
  if (place.address_.empty()) return;
  Places& same = by_address_[place.address_];
  place.in_address_ = same.insert(same.end(), &place);
}

void Admission::remove_stranger(Place& place) {
  place.admission_->mutex_.assert_held();
  place.is_stranger_ = false;
  strangers_.erase(place.in_all_);
  if (place.address_.empty()) return;
  const auto same = by_address_.find(place.address_);
  same->second.erase(place.in_address_);
  if (same->second.empty()) by_address_.erase(same);
}

void Admission::remove(Place& place) {
  place.admission_->mutex_.assert_held();
  if (place.is_stranger_) remove_stranger(place);
  place.is_counted_ = false;
  --count_;
}

// The oldest of these leaves: it counts no longer, and is to be closed under no lock.
bool Admission::choose(const Places& places, std::vector<Leaving>& leaving) {
  if (places.empty()) return false;
  Place& oldest = *places.front();
  oldest.admission_->mutex_.assert_held();
  leaving.push_back({oldest.connection_.lock(), oldest.address_});
  remove(oldest);
  return true;
}

void Admission::close(const std::vector<Leaving>& leaving) {
  for (const Leaving& each : leaving) {
    if (metrics_) metrics_->count_beyond_limit();
    const std::string from = each.address.empty() ? std::string() : " (" + each.address + ")";
    warn("the oldest connection without a session" + from + " is closed to make room for another");
    if (!each.connection) continue;
    each.connection->close(
        Error(ErrorCode::connection_error, "the node has too many connections without a session"));
  }
}

void Admission::warn(const std::string& text) {
  if (!has_log(*options_)) return;
  std::size_t unwarned = 0;
  {
    const MutexLock lock(warning_);
    const Time now = Clock::now();
    if (now < next_warning_) {
      ++unwarned_;
      return;
    }
    next_warning_ = now + between_warnings;
    unwarned = std::exchange(unwarned_, 0);
  }
  const std::string more =
      unwarned == 0 ? std::string() : " (" + std::to_string(unwarned) + " more were not logged)";
  log(*options_, LogLevel::warning, text + more);
}

std::size_t Admission::size() const {
  const MutexLock lock(mutex_);
  return count_;
}

std::size_t Admission::strangers() const {
  const MutexLock lock(mutex_);
  return strangers_.size();
}

}  // namespace rr::channel
