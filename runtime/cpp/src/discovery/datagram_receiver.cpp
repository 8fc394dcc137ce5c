// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/discovery/datagram_receiver.hpp"

#include <array>
#include <string>
#include <system_error>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/discovery/interfaces.hpp"
#include "runtime/cpp/src/discovery/packets.hpp"
#include "runtime/cpp/src/platform/datagrams.hpp"

namespace rr::discovery {
namespace {

// A flood must leave time for others: so many datagrams are read in a row, and then none for a
// while, in which the kernel drops what is too much.
constexpr int datagrams_in_a_row = 256;
constexpr channel::Milliseconds rest{50};

}  // namespace

std::vector<const char*> groups_of(const DiscoveryNetwork& network, bool is_loopback) {
  std::vector<const char*> groups;
  if (network.node_local) groups.emplace_back("ff01::ba86");
  if (network.link_local && !is_loopback) groups.emplace_back("ff02::ba86");
  if (network.site_local && !is_loopback) groups.emplace_back("ff05::ba86");
  return groups;
}

class DatagramReceiver::Socket final : public channel::Pollable,
                                       public channel::Timer,
                                       public std::enable_shared_from_this<Socket> {
 public:
  Socket(std::shared_ptr<channel::Reactor> reactor, channel::Descriptor socket, Handler handler)
      : reactor_(std::move(reactor)), socket_(std::move(socket)), handler_(std::move(handler)) {}
  ~Socket() { reactor_->cancel(*this); }

  void start() { reactor_->add(socket_.get(), channel::ready::input, *this); }
  void stop() {
    is_stopped_ = true;
    reactor_->remove(socket_.get());
    reactor_->retire(shared_from_this());
  }
  [[nodiscard]] int descriptor() const { return socket_.get(); }

  void on_ready(std::uint32_t /*events*/) override {
    // While it rests, or another thread reads, nothing is to be done: what is there is read then.
    if (is_busy_.exchange(true)) return;
    read_some();
  }

 private:
  void on_timer() override {
    reactor_->post([self = shared_from_this()] { self->read_some(); });
  }

  void read_some() {
    std::array<char, longest_packet + 1> bytes;
    for (int i = 0; i < datagrams_in_a_row && !is_stopped_; ++i) {
      channel::Address sender;
      const std::ptrdiff_t size = platform::receive_datagram(socket_.get(), bytes, sender);
      if (size >= 0) {
        handler_(std::string_view(bytes.data(), static_cast<std::size_t>(size)), sender);
        continue;
      }
      if (size == platform::broken) continue;  // an error that was waiting is taken
      is_busy_ = false;
      // One may have come between the two, and its event have been passed over.
      if (!platform::has_datagram(socket_.get()) || is_busy_.exchange(true)) return;
    }
    if (!is_stopped_) {
      reactor_->schedule(*this, weak_from_this(), channel::Clock::now() + rest);
    }
  }

  const std::shared_ptr<channel::Reactor> reactor_;
  const channel::Descriptor socket_;
  const Handler handler_;
  std::atomic<bool> is_stopped_{false};
  std::atomic<bool> is_busy_{false};
};

DatagramReceiver::DatagramReceiver(std::shared_ptr<channel::Reactor> reactor,
                                   DiscoveryNetwork network, Handler handler)
    : reactor_(std::move(reactor)), network_(std::move(network)), handler_(std::move(handler)) {}

DatagramReceiver::~DatagramReceiver() { stop(); }

// Null when the family cannot be listened to.
std::shared_ptr<DatagramReceiver::Socket> DatagramReceiver::open(channel::Family family,
                                                                 std::error_code& error) {
  channel::Descriptor socket =
      platform::open_datagrams(platform::any_address(family, network_.port), std::nullopt, error);
  if (!socket) return nullptr;
  return std::make_shared<Socket>(reactor_, std::move(socket), handler_);
}

void DatagramReceiver::start() {
  {
    const MutexLock lock(mutex_);
    std::error_code error;
    const auto v4 = open(channel::Family::v4, error);
    if (!v4) {
      throw Error(ErrorCode::connection_error, "cannot listen to discovery at port " +
                                                   std::to_string(network_.port) + ": " +
                                                   error.message());
    }
    sockets_.push_back(v4);
    v6_ = open(channel::Family::v6, error);
    if (v6_) sockets_.push_back(v6_);
    for (const auto& socket : sockets_) socket->start();
  }
  join_groups();
}

void DatagramReceiver::stop() {
  std::vector<std::shared_ptr<Socket>> sockets;
  {
    const MutexLock lock(mutex_);
    sockets.swap(sockets_);
    v6_.reset();
  }
  for (const auto& socket : sockets) socket->stop();
}

void DatagramReceiver::join_groups() {
  std::set<unsigned> present;
  const MutexLock lock(mutex_);
  if (!v6_) return;
  for (const LocalAddress& local : local_addresses()) {
    if (!local.is_v6()) continue;
    present.insert(local.interface_number);
    if (joined_.contains(local.interface_number)) continue;
    for (const char* const group : groups_of(network_, false)) {
      platform::join_group(v6_->descriptor(), platform::parse_ip(group).value(),
                           local.interface_number);
    }
  }
  joined_ = std::move(present);
}

}  // namespace rr::discovery
