// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/sim/network.hpp"

#include <algorithm>
#include <cerrno>
#include <utility>

namespace rr::sim {
namespace {

// Above all descriptors of the system.
constexpr int first_descriptor = 1'000'000;

constexpr std::size_t most_datagrams = 200;

Network* network_of_run = nullptr;

}  // namespace

const void* any_file() {
  static const char object = 0;
  return &object;
}

// Files

void File::notify() {
  for (Epoll* const epoll : epolls_) epoll->changed(*this);
  run_.wake(any_file(), INT32_MAX);
}

// Epoll

void Epoll::close() {
  for (auto& [file, entry] : entries_) file->leave(*this);
  entries_.clear();
}

int Epoll::change(int operation, const std::shared_ptr<File>& file, const epoll_event* event) {
  const auto place = std::find_if(entries_.begin(), entries_.end(),
                                  [&](const auto& each) { return each.first == file; });
  if (operation == EPOLL_CTL_ADD) {
    if (place != entries_.end()) return -EEXIST;
    entries_.emplace_back(file, Entry{event->events, event->data, false});
    file->join(*this);
    changed(*file);
    return 0;
  }
  if (place == entries_.end()) return -ENOENT;
  if (operation == EPOLL_CTL_DEL) {
    file->leave(*this);
    entries_.erase(place);
    return 0;
  }
  place->second = {event->events, event->data, false};
  changed(*file);
  return 0;
}

void Epoll::changed(const File& file) {
  for (auto& [its, entry] : entries_) {
    if (its.get() != &file) continue;
    const std::uint32_t wanted = entry.events | EPOLLHUP | EPOLLERR;
    if ((file.ready() & wanted) == 0) return;
    entry.is_new = true;
    run_.wake(this, 1);
    return;
  }
}

void Epoll::forget(const File& file) {
  std::erase_if(entries_, [&](const auto& each) { return each.first.get() == &file; });
}

int Epoll::collect(std::span<epoll_event> found) {
  std::size_t count = 0;
  // From a random place on, since the order among several is the system's.
  const std::size_t size = entries_.size();
  const std::size_t first = size == 0 ? 0 : run_.random().below(size);
  for (std::size_t i = 0; i < size && count < found.size(); ++i) {
    auto& [file, entry] = entries_[(first + i) % size];
    if (!entry.is_new) continue;
    const std::uint32_t events = file->ready() & (entry.events | EPOLLHUP | EPOLLERR);
    if ((entry.events & EPOLLET) != 0 || events == 0) entry.is_new = false;
    if (events == 0) continue;
    found[count].events = events;
    found[count].data = entry.data;
    ++count;
  }
  return static_cast<int>(count);
}

int Epoll::wait(std::span<epoll_event> found, Nanoseconds deadline, const void* caller) {
  run_.point("poll", this, 0, caller);
  while (true) {
    const int count = collect(found);
    if (count != 0 || deadline <= run_.now()) return count;
    run_.wait("a socket", this, deadline, caller);
  }
}

// Streams

Stream::Stream(Scheduler& run) : File(run) {
  const Faults& faults = Faults::current();
  window_ = faults.smallest_window +
            run.random().below(faults.largest_window - faults.smallest_window + 1);
}

void Stream::join(const std::shared_ptr<Stream>& first, const std::shared_ptr<Stream>& second) {
  first->peer_ = second;
  second->peer_ = first;
}

std::size_t Stream::room() const {
  const auto peer = peer_.lock();
  if (!peer) return 0;
  const std::size_t used = under_way_ + peer->received_.size();
  return used >= window_ ? 0 : window_ - used;
}

std::uint32_t Stream::ready() const {
  if (is_connecting_) return 0;
  std::uint32_t events = 0;
  if (!received_.empty() || has_end_ || is_reset_ || !may_receive_) events |= EPOLLIN;
  if (has_end_ || is_reset_ || !may_receive_) events |= EPOLLRDHUP;
  if (is_reset_ || error_ != 0) events |= EPOLLERR | EPOLLHUP;
  if ((has_end_ || !may_receive_) && !may_send_) events |= EPOLLHUP;
  if (is_reset_ || !may_send_ || (peer_.expired() && !is_silent_) || room() != 0)
    events |= EPOLLOUT;
  return events;
}

// Things arrive in the order in which they are sent, each after a time of its own.
void Stream::deliver(std::function<void(Stream&)> what) {
  const auto delay = static_cast<Nanoseconds>(
      run_.random().below(static_cast<std::uint64_t>(Faults::current().longest_delay) + 1));
  last_arrival_ = std::max(last_arrival_ + 1, run_.now() + delay);
  run_.at(last_arrival_, [peer = peer_, what = std::move(what)] {
    if (const auto its = peer.lock()) what(*its);
  });
}

std::ptrdiff_t Stream::send(std::span<const std::byte> bytes) {
  if (is_reset_) return may_send_ ? -std::exchange(error_, EPIPE) : -EPIPE;
  if (!may_send_) return -EPIPE;
  if (is_connecting_) return -EAGAIN;
  const auto peer = peer_.lock();
  if (!peer && !is_silent_) return -EPIPE;
  // Sockets take a part only when they are full.
  const std::size_t size = std::min(bytes.size(), room());
  if (size == 0 && !bytes.empty()) return -EAGAIN;
  under_way_ += size;
  if (is_silent_) return static_cast<std::ptrdiff_t>(size);
  for (std::size_t done = 0; done < size;) {
    std::size_t length = size - done;
    if (length > 1 && run_.random().once_in(Faults::current().split_segments)) {
      length = 1 + run_.random().below(length);
    }
    const auto segment = bytes.subspan(done, length);
    deliver([copy = std::vector<std::byte>(segment.begin(), segment.end())](Stream& its) {
      its.arrive(copy);
    });
    done += length;
  }
  return static_cast<std::ptrdiff_t>(size);
}

void Stream::arrive(const std::vector<std::byte>& bytes) {
  if (is_silent_) return;
  if (const auto sender = peer_.lock()) sender->under_way_ -= bytes.size();
  if (is_closed_) {
    // Nobody reads this: the sender is told so.
    if (const auto sender = peer_.lock()) {
      deliver([](Stream& its) { its.arrive_reset(); });
    }
    return;
  }
  if (is_reset_) return;
  received_.insert(received_.end(), bytes.begin(), bytes.end());
  notify();
}

void Stream::arrive_end() {
  if (is_silent_ || is_closed_ || is_reset_) return;
  has_end_ = true;
  notify();
}

void Stream::arrive_reset() {
  if (is_silent_ || is_closed_ || is_reset_) return;
  is_reset_ = true;
  error_ = ECONNRESET;
  received_.clear();
  notify();
}

std::ptrdiff_t Stream::receive(std::span<std::byte> room, bool is_peek) {
  if (received_.empty() || !may_receive_) {
    if (is_reset_) {
      const int error = std::exchange(error_, 0);
      return error == 0 ? 0 : -error;
    }
    return has_end_ || !may_receive_ ? 0 : -EAGAIN;
  }
  // All that there is: programs may take a part for all (epoll(7), question 9).
  const std::size_t size = std::min(room.size(), received_.size());
  const auto end = received_.begin() + static_cast<std::ptrdiff_t>(size);
  std::copy(received_.begin(), end, room.begin());
  if (is_peek) return static_cast<std::ptrdiff_t>(size);
  const auto peer = peer_.lock();
  const bool was_full = peer && peer->room() == 0;
  received_.erase(received_.begin(), end);
  if (was_full && !is_silent_) {
    run_.at(run_.now() + 20'000, [its = peer_] {
      if (const auto sender = its.lock()) sender->notify();
    });
  }
  return static_cast<std::ptrdiff_t>(size);
}

void Stream::shut_down(bool receiving, bool sending) {
  if (sending && may_send_ && !is_connecting_) {
    may_send_ = false;
    deliver([](Stream& its) { its.arrive_end(); });
  }
  if (receiving) may_receive_ = false;
  notify();
}

void Stream::close() {
  if (is_closed_) return;
  const bool loses = resets_at_close || !received_.empty();
  if (loses) {
    deliver([](Stream& its) { its.arrive_reset(); });
  } else {
    shut_down(false, true);
  }
  is_closed_ = true;
  received_.clear();
}

void Stream::reset() {
  arrive_reset();
  if (const auto peer = peer_.lock()) peer->arrive_reset();
}

void Stream::fall_silent() {
  is_silent_ = true;
  if (const auto peer = peer_.lock()) peer->is_silent_ = true;
}

void Stream::finish(int error) {
  is_connecting_ = false;
  error_ = error;
  is_reset_ = error != 0;
  notify();
}

// Listeners

void Listener::add(std::shared_ptr<Stream> accepted) {
  waiting_.push_back(std::move(accepted));
  notify();
}

std::shared_ptr<Stream> Listener::take() {
  if (waiting_.empty()) return nullptr;
  auto first = std::move(waiting_.front());
  waiting_.pop_front();
  return first;
}

void Listener::close() {
  for (const auto& each : waiting_) each->reset();
  waiting_.clear();
  Network::current()->stop_listening(*this);
}

// Datagrams

void Datagrams::arrive(std::uint16_t sender, const std::vector<std::byte>& content) {
  if (received_.size() == most_datagrams) return;
  received_.emplace_back(sender, content);
  notify();
}

std::ptrdiff_t Datagrams::receive(std::span<std::byte> room, bool is_peek, std::uint16_t& sender) {
  if (received_.empty()) return -EAGAIN;
  const auto& [from, content] = received_.front();
  sender = from;
  const std::size_t size = std::min(room.size(), content.size());
  std::copy_n(content.begin(), size, room.begin());
  if (!is_peek) received_.pop_front();
  return static_cast<std::ptrdiff_t>(size);
}

// The network

Network::Network(Scheduler& run) : run_(run) { network_of_run = this; }
Network::~Network() { network_of_run = nullptr; }
Network* Network::current() { return network_of_run; }

int Network::open(std::shared_ptr<File> file) {
  // The lowest free number, as of a system: mistakes with closed descriptors show.
  int number = first_descriptor;
  for (const auto& [used, its] : files_) {
    if (used != number) break;
    ++number;
  }
  files_.emplace(number, std::move(file));
  return number;
}

std::shared_ptr<File> Network::find(int descriptor) const {
  const auto place = files_.find(descriptor);
  return place == files_.end() ? nullptr : place->second;
}

void Network::replace(int descriptor, std::shared_ptr<File> file) {
  files_.at(descriptor) = std::move(file);
}

bool Network::close(int descriptor) {
  const auto place = files_.find(descriptor);
  if (place == files_.end()) return false;
  const std::shared_ptr<File> file = std::move(place->second);
  files_.erase(place);
  for (const auto& [number, each] : files_) {
    if (auto* const epoll = dynamic_cast<Epoll*>(each.get())) {
      epoll->forget(*file);
      file->leave(*epoll);
    }
  }
  file->close();
  return true;
}

int Network::bind(Unbound& socket, std::uint16_t port) {
  if (port == 0) {
    while (listeners_.contains({AF_INET, next_port_}) ||
           listeners_.contains({AF_INET6, next_port_})) {
      ++next_port_;
    }
    port = next_port_++;
  }
  if (listeners_.contains({socket.family, port})) return -EADDRINUSE;
  socket.port = port;
  return 0;
}

int Network::listen(int descriptor) {
  const auto socket = find_as<Unbound>(descriptor);
  if (!socket) return -EINVAL;
  if (listeners_.contains({socket->family, socket->port})) return -EADDRINUSE;
  auto listener = std::make_shared<Listener>(run_);
  listener->port = socket->port;
  listener->family = socket->family;
  listener->is_blocking = socket->is_blocking;
  listeners_[{socket->family, socket->port}] = listener.get();
  replace(descriptor, std::move(listener));
  return 0;
}

void Network::stop_listening(const Listener& listener) {
  listeners_.erase({listener.family, listener.port});
}

int Network::connect(int descriptor, std::uint16_t port) {
  const auto socket = find_as<Unbound>(descriptor);
  if (!socket) return -EISCONN;
  auto client = std::make_shared<Stream>(run_);
  client->family = socket->family;
  client->is_blocking = socket->is_blocking;
  client->send_timeout = socket->send_timeout;
  client->local_port = next_port_++;
  client->remote_port = port;
  client->begin();
  replace(descriptor, client);
  const auto delay = static_cast<Nanoseconds>(
      run_.random().below(static_cast<std::uint64_t>(Faults::current().longest_delay) + 1));
  run_.at(run_.now() + delay, [this, client] {
    if (network_of_run != this) return;
    const auto place = listeners_.find({client->family, client->remote_port});
    if (place == listeners_.end()) return client->finish(ECONNREFUSED);
    auto accepted = std::make_shared<Stream>(run_);
    accepted->family = client->family;
    accepted->local_port = client->remote_port;
    accepted->remote_port = client->local_port;
    Stream::join(client, accepted);
    client->finish(0);
    place->second->add(std::move(accepted));
  });
  return -EINPROGRESS;
}

void Network::place(Datagrams& socket, std::uint16_t port) {
  socket.port = port == 0 ? next_port_++ : port;
}

void Network::send_to_all(const Datagrams& sender, std::uint16_t port,
                          std::span<const std::byte> content) {
  const Faults& faults = Faults::current();
  const std::vector<std::byte> copy(content.begin(), content.end());
  for (const auto& [number, file] : files_) {
    const auto receiver = std::dynamic_pointer_cast<Datagrams>(file);
    if (!receiver || receiver->family != sender.family || receiver->port != port) continue;
    if (run_.random().once_in(faults.lost_datagrams)) continue;
    for (int left = run_.random().once_in(faults.doubled_datagrams) ? 2 : 1; left != 0; --left) {
      const auto delay = static_cast<Nanoseconds>(
          run_.random().below(static_cast<std::uint64_t>(faults.longest_delay) + 1));
      run_.at(run_.now() + delay,
              [copy, from = sender.port, its = std::weak_ptr<Datagrams>(receiver)] {
                if (const auto to = its.lock()) to->arrive(from, copy);
              });
    }
  }
}

std::vector<std::shared_ptr<Stream>> Network::streams() const {
  std::vector<std::shared_ptr<Stream>> found;
  for (const auto& [number, file] : files_) {
    if (auto stream = std::dynamic_pointer_cast<Stream>(file)) found.push_back(std::move(stream));
  }
  return found;
}

std::string Network::text() const {
  std::size_t streams = 0;
  for (const auto& [number, file] : files_) {
    if (dynamic_cast<const Stream*>(file.get()) != nullptr) ++streams;
  }
  return std::to_string(files_.size()) + " descriptors, " + std::to_string(streams) +
         " of connections, " + std::to_string(listeners_.size()) + " that listen";
}

}  // namespace rr::sim
