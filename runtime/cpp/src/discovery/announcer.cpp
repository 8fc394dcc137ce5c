// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/discovery/announcer.hpp"

#include <algorithm>
#include <utility>

#include "runtime/cpp/src/channel/texts.hpp"
#include "runtime/cpp/src/discovery/datagram_sender.hpp"
#include "runtime/cpp/src/discovery/packets.hpp"
#include "runtime/cpp/src/endpoint/service_index_types.hpp"

namespace rr::discovery {
namespace {

constexpr channel::Milliseconds shortly{500};
constexpr channel::Milliseconds least_gap{1'000};
constexpr channel::Milliseconds shortest_period{500};

}  // namespace

Announcer::Announcer(std::shared_ptr<channel::Reactor> reactor, NodeId id, std::string name,
                     std::function<std::vector<std::string>()> listening)
    : reactor_(std::move(reactor)),
      id_(id),
      name_(std::move(name)),
      listening_(std::move(listening)),
      nonce_(channel::random_letters()) {}

void Announcer::start(AnnounceOptions options) {
  options.period = std::max(channel::saturated(options.period), shortest_period);
  const MutexLock lock(mutex_);
  options_ = std::move(options);
  if (!alarm_) {
    alarm_ = std::make_shared<Alarm>(reactor_, [announcer = weak_from_this()] {
      if (const auto self = announcer.lock()) self->announce();
    });
  }
  due_ = channel::Clock::now() + shortly;
  alarm_->set(due_);
}

void Announcer::stop() {
  const MutexLock lock(mutex_);
  options_.reset();
  due_ = channel::never;
  if (alarm_) alarm_->cancel();
}

void Announcer::announce_soon() {
  const MutexLock lock(mutex_);
  if (!options_) return;
  const channel::Time now = channel::Clock::now();
  channel::Time when = now + shortly;
  if (last_ != channel::Time::min()) when = std::max(when, last_ + least_gap);
  if (when >= due_) return;
  due_ = when;
  alarm_->set(due_);
}

void Announcer::services_changed() {
  {
    const MutexLock lock(mutex_);
    nonce_ = channel::random_letters();
  }
  announce_soon();
}

std::string Announcer::nonce() const {
  const MutexLock lock(mutex_);
  return nonce_;
}

void Announcer::announce() {
  DiscoveryNetwork network;
  {
    const MutexLock lock(mutex_);
    if (!options_) return;
    network = options_->network;
    last_ = channel::Clock::now();
    due_ = last_ + options_->period;
    alarm_->set(due_);
  }
  send_from_all(network, [&](const LocalAddress& from) { return packets_for(from); });
}

// One for each URL by which this node may be reached at that address.
std::vector<std::string> Announcer::packets_for(const LocalAddress& from) const {
  std::vector<std::string> packets;
  const std::string nonce_now = nonce();
  for (const std::string& base : listening_()) {
    if (!base.starts_with("rr+tcp://") && !base.starts_with("rrs+tcp://")) continue;
    const std::string here = base.substr(0, base.find("://") + 3) + from.host() + ":";
    for (const std::string& reachable : reachable_urls(base, {from})) {
      if (!reachable.starts_with(here)) continue;
      packets.push_back(write_announcement(
          {id_, name_, service_index::service_url(reachable, id_, service_index::service_name),
           nonce_now}));
    }
  }
  return packets;
}

}  // namespace rr::discovery
