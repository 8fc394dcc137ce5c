// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/epoll.h>
#include <sys/socket.h>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "runtime/cpp/sim/faults.hpp"
#include "runtime/cpp/sim/scheduler.hpp"

namespace rr::sim {

class Epoll;

/// What a descriptor of a run is. Its events are those of poll(2).
class File {
 public:
  explicit File(Scheduler& run) : run_(run) {}
  virtual ~File() = default;
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  /// What holds now: POLLIN, POLLOUT, POLLRDHUP, POLLHUP, POLLERR.
  [[nodiscard]] virtual std::uint32_t ready() const = 0;
  /// The program has closed the last descriptor.
  virtual void close() {}

  void join(Epoll& epoll) { epolls_.push_back(&epoll); }
  void leave(Epoll& epoll) { std::erase(epolls_, &epoll); }

 protected:
  /// Something has happened that one may wait for.
  void notify();
  Scheduler& run_;

 private:
  std::vector<Epoll*> epolls_;
};

/// The object of threads in poll(2): any change of any file wakes them.
const void* any_file();

/// eventfd(2), as a flag.
class Event final : public File {
 public:
  using File::File;
  [[nodiscard]] std::uint32_t ready() const override {
    return std::uint32_t{EPOLLOUT} | (is_set_ ? std::uint32_t{EPOLLIN} : 0U);
  }
  void set() {
    is_set_ = true;
    notify();
  }
  bool take() { return std::exchange(is_set_, false); }

 private:
  bool is_set_ = false;
};

/// epoll(7), edge-triggered or not.
class Epoll final : public File {
 public:
  using File::File;
  struct Entry {
    std::uint32_t events = 0;
    epoll_data_t data{};
    bool is_new = false;  // something has happened since it was reported
  };

  [[nodiscard]] std::uint32_t ready() const override { return 0; }
  void close() override;
  /// Results are those of epoll_ctl(2) and epoll_wait(2), with an error's number negative.
  int change(int operation, const std::shared_ptr<File>& file, const epoll_event* event);
  int wait(std::span<epoll_event> found, Nanoseconds deadline, const void* caller);

  void changed(const File& file);
  void forget(const File& file);

 private:
  int collect(std::span<epoll_event> found);
  std::vector<std::pair<std::shared_ptr<File>, Entry>> entries_;
};

/// One end of a connection.
class Stream final : public File {
 public:
  explicit Stream(Scheduler& run);

  /// Joins two ends. The first has connected to the second.
  static void join(const std::shared_ptr<Stream>& first, const std::shared_ptr<Stream>& second);

  [[nodiscard]] std::uint32_t ready() const override;
  void close() override;

  /// Bytes sent; -EAGAIN, -EPIPE, -ECONNRESET.
  std::ptrdiff_t send(std::span<const std::byte> bytes);
  /// Bytes received, 0 at the end; -EAGAIN, -ECONNRESET.
  std::ptrdiff_t receive(std::span<std::byte> room, bool is_peek);
  void shut_down(bool receiving, bool sending);
  /// As a cut cable that is noticed: both ends see a reset, what is under way is lost.
  void reset();
  /// As a cut cable that nobody notices: nothing arrives any more, in either direction.
  void fall_silent();

  /// Of a connection that is being made.
  void begin() { is_connecting_ = true; }
  void finish(int error);
  [[nodiscard]] bool is_connecting() const { return is_connecting_; }
  int take_error() { return std::exchange(error_, 0); }
  [[nodiscard]] bool is_joined() const { return !peer_.expired(); }

  bool resets_at_close = false;  ///< SO_LINGER of 0
  bool is_blocking = true;
  Nanoseconds receive_timeout = never;  ///< SO_RCVTIMEO
  Nanoseconds send_timeout = never;     ///< SO_SNDTIMEO
  std::uint16_t local_port = 0;
  std::uint16_t remote_port = 0;
  sa_family_t family = AF_INET;

 private:
  void arrive(const std::vector<std::byte>& bytes);
  void arrive_end();
  void arrive_reset();
  void deliver(std::function<void(Stream&)> what);
  [[nodiscard]] std::size_t room() const;

  std::weak_ptr<Stream> peer_;
  std::deque<std::byte> received_;
  std::size_t under_way_ = 0;     // from here to the peer, not yet in its queue
  std::size_t window_ = 65'536;   // of what this end sends
  Nanoseconds last_arrival_ = 0;  // at the peer, of what this end sent
  int error_ = 0;
  bool is_connecting_ = false;
  bool is_silent_ = false;
  bool has_end_ = false;  // the peer sends no more, and all has arrived
  bool is_reset_ = false;
  bool may_send_ = true;
  bool may_receive_ = true;
  bool is_closed_ = false;
};

/// A listening socket.
class Listener final : public File {
 public:
  using File::File;
  [[nodiscard]] std::uint32_t ready() const override {
    return waiting_.empty() ? 0U : std::uint32_t{EPOLLIN};
  }
  void close() override;
  void add(std::shared_ptr<Stream> accepted);
  std::shared_ptr<Stream> take();

  std::uint16_t port = 0;
  sa_family_t family = AF_INET;
  bool is_blocking = true;

 private:
  std::deque<std::shared_ptr<Stream>> waiting_;
};

/// A socket of UDP. All sockets of its family at a port get what is sent there.
class Datagrams final : public File {
 public:
  using File::File;
  [[nodiscard]] std::uint32_t ready() const override {
    return std::uint32_t{EPOLLOUT} | (received_.empty() ? 0U : std::uint32_t{EPOLLIN});
  }
  void arrive(std::uint16_t sender, const std::vector<std::byte>& content);
  /// Bytes of the next one, cut to the room; -EAGAIN when there is none.
  std::ptrdiff_t receive(std::span<std::byte> room, bool is_peek, std::uint16_t& sender);

  std::uint16_t port = 0;
  sa_family_t family = AF_INET;

 private:
  std::deque<std::pair<std::uint16_t, std::vector<std::byte>>> received_;
};

/// A socket of which it is not known yet whether it connects or listens.
class Unbound final : public File {
 public:
  using File::File;
  [[nodiscard]] std::uint32_t ready() const override { return EPOLLHUP; }
  sa_family_t family = AF_INET;
  std::uint16_t port = 0;
  bool is_blocking = true;
  Nanoseconds send_timeout = never;
};

/// The descriptors and ports of a run.
class Network {
 public:
  explicit Network(Scheduler& run);
  ~Network();
  Network(const Network&) = delete;
  Network& operator=(const Network&) = delete;
  static Network* current();

  /// A descriptor for a file.
  int open(std::shared_ptr<File> file);
  /// Null for a descriptor that is none of the run.
  [[nodiscard]] std::shared_ptr<File> find(int descriptor) const;
  template <class Kind>
  [[nodiscard]] std::shared_ptr<Kind> find_as(int descriptor) const {
    return std::dynamic_pointer_cast<Kind>(find(descriptor));
  }
  void replace(int descriptor, std::shared_ptr<File> file);
  bool close(int descriptor);

  /// Fails with EADDRINUSE.
  int bind(Unbound& socket, std::uint16_t port);
  int listen(int descriptor);
  /// Begins to connect.
  int connect(int descriptor, std::uint16_t port);
  void stop_listening(const Listener& listener);
  /// Gives a socket of UDP a port, which others may have too; 0: one of its own.
  void place(Datagrams& socket, std::uint16_t port);
  /// Some get lost, come twice, or overtake others.
  void send_to_all(const Datagrams& sender, std::uint16_t port, std::span<const std::byte> content);

  /// Connections that exist, by descriptor of one of their ends.
  [[nodiscard]] std::vector<std::shared_ptr<Stream>> streams() const;
  [[nodiscard]] std::size_t open_count() const { return files_.size(); }
  [[nodiscard]] std::string text() const;
  Scheduler& run() { return run_; }

 private:
  using Place = std::pair<sa_family_t, std::uint16_t>;
  Scheduler& run_;
  std::map<int, std::shared_ptr<File>> files_;
  std::map<Place, Listener*> listeners_;
  std::uint16_t next_port_ = 20'000;
};

}  // namespace rr::sim
