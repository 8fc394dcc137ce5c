// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/discovery/node_discovery.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/discovery/datagram_sender.hpp"
#include "runtime/cpp/src/discovery/local_nodes.hpp"
#include "runtime/cpp/src/discovery/packets.hpp"
#include "runtime/cpp/src/discovery/waiting.hpp"
#include "runtime/cpp/src/endpoint/service_index_types.hpp"

namespace rr::discovery {
namespace {

using channel::Milliseconds;

// How often new interfaces are looked for, and old announcements forgotten (05, section 1).
constexpr Milliseconds tick_period{5'000};
constexpr int requests_at_once = 3;
// Asked again so soon after the last request, it waits longer (05, section 3).
constexpr Milliseconds request_burst_gap{1'000};
constexpr Milliseconds request_rest{5'000};

// Without the port, which says nothing of who it is.
std::string sender_text(channel::Address address) {
  address.set_port(0);
  return address.text();
}

bool has_scheme(const std::string& url, const std::vector<std::string>& schemes) {
  return schemes.empty() || std::any_of(schemes.begin(), schemes.end(), [&](const auto& scheme) {
           return url.starts_with(scheme + "://");
         });
}

}  // namespace

NodeDiscovery::NodeDiscovery(subscription::Host host,
                             std::function<std::vector<std::string>()> listening)
    : host_(std::move(host)),
      announcer_(std::make_shared<Announcer>(host_.core->context().reactor,
                                             host_.core->options().id, host_.core->options().name,
                                             std::move(listening))),
      watch_(std::make_shared<ServiceWatch>(host_)),
      notifier_(std::make_shared<subscription::Notifier>(host_.core)) {}

void NodeDiscovery::check_open() const {
  if (has_ended_) throw Error(ErrorCode::invalid_operation, "the node is shut down");
}

// Under the lock, which the node's end takes, too: what runs things aside may be gone after that.
void NodeDiscovery::run_aside(std::function<void()> work) {
  const MutexLock lock(mutex_);
  check_open();
  host_.run_aside(std::move(work));
}

std::shared_ptr<Alarm> NodeDiscovery::alarm(void (NodeDiscovery::*method)()) {
  return std::make_shared<Alarm>(host_.core->context().reactor, [weak = weak_from_this(), method] {
    if (const auto self = weak.lock()) ((*self).*method)();
  });
}

void NodeDiscovery::announce(AnnounceOptions options) {
  const MutexLock lock(mutex_);
  check_open();
  host_.core->start();
  announcer_->start(std::move(options));
}

void NodeDiscovery::listen(ListenOptions options) {
  const MutexLock one_at_a_time(changing_);
  {
    const MutexLock lock(mutex_);
    check_open();
  }
  host_.core->start();
  auto receiver = std::make_shared<DatagramReceiver>(
      host_.core->context().reactor, options.network,
      [weak = weak_from_this()](std::string_view packet, const channel::Address& sender) {
        if (const auto self = weak.lock()) self->hear(packet, sender);
      });
  options.lifetime = channel::saturated(options.lifetime);
  NodeTable table({options.max_nodes, options.max_nodes_of_sender, options.lifetime});
  auto listening = std::make_unique<Listening>(Listening{options,
                                                         receiver,
                                                         alarm(&NodeDiscovery::tick),
                                                         alarm(&NodeDiscovery::send_request),
                                                         NodeId::random(),
                                                         0,
                                                         {},
                                                         std::move(table)});
  std::unique_ptr<Listening> before;
  {
    const MutexLock lock(mutex_);
    before = std::exchange(listening_, std::move(listening));
  }
  if (before) {
    before->receiver->stop();
    notify_lost(before->table.all());
  }
  try {
    receiver->start();
  } catch (...) {
    const MutexLock lock(mutex_);
    listening_.reset();
    throw;
  }
  bool has_ended = false;
  {
    const MutexLock lock(mutex_);
    has_ended = has_ended_;
    const Milliseconds period =
        std::min(tick_period, std::max(options.lifetime / 4, Milliseconds(10)));
    if (listening_) listening_->tick->set(channel::Clock::now() + period);
  }
  if (has_ended) {
    receiver->stop();
    throw Error(ErrorCode::invalid_operation, "the node is shut down");
  }
  scan_local_nodes();
  request();
}

void NodeDiscovery::stop_listening() {
  const MutexLock one_at_a_time(changing_);
  std::unique_ptr<Listening> before;
  {
    const MutexLock lock(mutex_);
    before = std::move(listening_);
  }
  if (!before) return;
  before->receiver->stop();
  notify_lost(before->table.all());
}

bool NodeDiscovery::is_listening() const {
  const MutexLock lock(mutex_);
  return listening_ != nullptr;
}

void NodeDiscovery::ensure_listening() {
  {
    const MutexLock lock(mutex_);
    check_open();
    if (listening_) return;
  }
  listen({});
}

void NodeDiscovery::request() {
  const MutexLock lock(mutex_);
  check_open();
  if (!listening_) {
    throw Error(ErrorCode::invalid_operation, "a node that does not listen cannot ask for others");
  }
  if (listening_->requests_left > 0) return;
  const channel::Time now = channel::Clock::now();
  const bool is_again = listening_->last_request != channel::Time() &&
                        now < listening_->last_request + request_burst_gap;
  listening_->requests_left = requests_at_once;
  listening_->asking->set(now + (is_again ? request_rest : random_between(250, 1000)));
}

void NodeDiscovery::send_request() {
  DiscoveryNetwork network;
  NodeId asker;
  {
    const MutexLock lock(mutex_);
    if (!listening_ || listening_->requests_left == 0) return;
    network = listening_->options.network;
    asker = listening_->asker;
    listening_->last_request = channel::Clock::now();
    if (--listening_->requests_left > 0) {
      listening_->asking->set(listening_->last_request + random_between(900, 1500));
    }
  }
  send_from_all(
      network, [&](const LocalAddress&) { return std::vector<std::string>{write_request(asker)}; });
}

void NodeDiscovery::hear(std::string_view packet, const channel::Address& sender) {
  if (const auto announcement = read_announcement(packet, sender)) {
    take(*announcement, sender_text(sender));
    return;
  }
  const auto asker = read_request(packet);
  if (!asker) return;
  {
    const MutexLock lock(mutex_);
    if (!listening_ || listening_->asker == *asker) return;
  }
  announcer_->announce_soon();
}

void NodeDiscovery::take(const Announcement& announcement, const std::string& sender) {
  if (announcement.node == host_.core->options().id) return;
  const MutexLock lock(mutex_);
  if (!listening_) return;
  const NodeTable::News news = listening_->table.hear(announcement, sender, channel::Clock::now());
  if (news == NodeTable::News::refused) return;
  const auto known = listening_->table.find(announcement.node);
  if (!known) return;
  watch_->heard(*known);
  if (news == NodeTable::News::found) on_detected_.notify(*notifier_, known->node);
}

void NodeDiscovery::tick() {
  std::shared_ptr<DatagramReceiver> receiver;
  std::vector<KnownNode> lost;
  {
    const MutexLock lock(mutex_);
    if (!listening_) return;
    receiver = listening_->receiver;
  }
  receiver->join_groups();
  scan_local_nodes();
  {
    const MutexLock lock(mutex_);
    if (!listening_) return;
    const channel::Time now = channel::Clock::now();
    lost = listening_->table.forget_old(now);
    const Milliseconds period =
        std::min(tick_period, std::max(listening_->options.lifetime / 4, Milliseconds(10)));
    listening_->tick->set(now + period);
  }
  notify_lost(lost);
}

void NodeDiscovery::scan_local_nodes() {
  {
    const MutexLock lock(mutex_);
    if (!listening_ || !listening_->options.local) return;
  }
  for (const Announcement& node : find_local_nodes()) take(node, "local");
}

void NodeDiscovery::notify_lost(const std::vector<KnownNode>& lost) {
  for (const KnownNode& known : lost) {
    watch_->lost(known.node.id);
    const MutexLock lock(mutex_);
    on_lost_.notify(*notifier_, known.node);
  }
}

void NodeDiscovery::end() {
  std::unique_ptr<Listening> before;
  {
    const MutexLock lock(mutex_);
    has_ended_ = true;
    before = std::move(listening_);
    on_detected_.end(*notifier_);
    on_lost_.end(*notifier_);
  }
  announcer_->stop();
  end_.interrupt();
  watch_->end();
  if (before) before->receiver->stop();
}

// Looking

std::vector<DetectedNode> NodeDiscovery::detected_nodes() const {
  std::vector<DetectedNode> result;
  const MutexLock lock(mutex_);
  if (!listening_) return result;
  for (KnownNode& known : listening_->table.all()) {
    host_.core->found_urls().add(known.node.urls);
    result.push_back(std::move(known.node));
  }
  return result;
}

void NodeDiscovery::look_first(const FindOptions& options) {
  ensure_listening();
  scan_local_nodes();
  if (options.wait.count() <= 0) return;
  request();
  wait_for_either(end_, channel::after(channel::Clock::now(), options.wait));
  if (end_.is_interrupted()) {
    throw Error(ErrorCode::operation_cancelled, "the node is shut down");
  }
}

std::vector<DetectedNode> NodeDiscovery::update_detected_nodes(std::chrono::milliseconds wait) {
  look_first({.wait = wait});
  return detected_nodes();
}

std::vector<DetectedNode> NodeDiscovery::find_nodes(
    const FindOptions& options, const std::function<bool(const DetectedNode&)>& is_wanted) {
  look_first(options);
  std::vector<DetectedNode> result;
  for (DetectedNode& node : detected_nodes()) {
    if (!is_wanted(node)) continue;
    std::erase_if(node.urls,
                  [&](const std::string& url) { return !has_scheme(url, options.schemes); });
    for (std::string& url : node.urls) url = service_index::exchange_service(url, {});
    if (!node.urls.empty()) result.push_back(std::move(node));
  }
  return result;
}

std::vector<FoundService> NodeDiscovery::find_services(const std::optional<std::string>& type,
                                                       const FindOptions& options) {
  look_first(options);
  std::vector<FoundService> result;
  for (FoundService& service :
       watch_->look(channel::after(channel::Clock::now(), options.timeout))) {
    const auto& others = service.implements;
    if (type && service.object_type != *type &&
        std::find(others.begin(), others.end(), *type) == others.end()) {
      continue;
    }
    std::erase_if(service.urls,
                  [&](const std::string& url) { return !has_scheme(url, options.schemes); });
    if (service.urls.empty()) continue;
    host_.core->found_urls().add(service.urls);
    result.push_back(std::move(service));
  }
  return result;
}

// The program knows the URLs of a node that it is told of.
Function<void(const DetectedNode&)> NodeDiscovery::remembering(
    Function<void(const DetectedNode&)> function) const {
  return [core = host_.core, function = std::move(function)](const DetectedNode& node) {
    core->found_urls().add(node.urls);
    function(node);
  };
}

Subscription NodeDiscovery::on_detected(Function<void(const DetectedNode&)> function) {
  const MutexLock lock(mutex_);
  check_open();
  const auto listener = on_detected_.add(remembering(std::move(function)));
  if (listening_) {
    for (const KnownNode& known : listening_->table.all()) {
      notifier_->add([listener, node = known.node] { listener->call(node); });
    }
  }
  return Subscription(listener);
}

Subscription NodeDiscovery::on_lost(Function<void(const DetectedNode&)> function) {
  const MutexLock lock(mutex_);
  check_open();
  return Subscription(on_lost_.add(remembering(std::move(function))));
}

}  // namespace rr::discovery
