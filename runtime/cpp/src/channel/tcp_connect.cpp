// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/tcp_connect.hpp"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <exception>
#include <optional>
#include <utility>

#include "rr/error.hpp"
#include "rr/reader.hpp"
#include "rr/writer.hpp"
#include "runtime/cpp/src/channel/interruption.hpp"
#include "runtime/cpp/src/channel/operations.hpp"

namespace rr::channel {
namespace {

// 04, section 1.
constexpr Milliseconds next_address_delay{5};
// The answer has a name or two and a few codes.
constexpr std::size_t longest_answer = 64 * 1024;
constexpr std::size_t smallest_header = 10;

[[noreturn]] void fail(ErrorCode code, std::string message) {
  throw Error(code, std::move(message));
}

// The failure that a type 2 entry reports.
Error reported_error(Decoder& decoder, const Entry& entry) {
  Element name;
  Element text;
  const bool has_name =
      find_element(decoder, entry.elements, entry.element_count, "errorname", name);
  const bool has_text =
      find_element(decoder, entry.elements, entry.element_count, "errorstring", text);
  return {static_cast<ErrorCode>(entry.error), std::string(has_name ? name.text() : ""),
          std::string(has_text ? text.text() : "the other side refused the connection")};
}

// One address on its way from nothing to an agreed connection. Each step throws what ends it.
class Attempt {
 public:
  Attempt(const Address& address, const Url& url, const NodeOptions& options)
      : url_(url),
        options_(options),
        socket_(::socket(address.family(), SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    if (!socket_) fail(ErrorCode::connection_error, std::strerror(errno));
    // The socket blocks, which connecting must not.
    const timeval no_time{0, 1};
    setsockopt(socket_.get(), SOL_SOCKET, SO_SNDTIMEO, &no_time, sizeof no_time);
    if (connect(socket_.get(), reinterpret_cast<const sockaddr*>(&address.storage), address.size) ==
        0) {
      begin_handshake();
    } else if (errno != EINPROGRESS && errno != EAGAIN && errno != EINTR) {
      fail(ErrorCode::connection_error,
           "cannot connect to " + address.text() + ": " + std::strerror(errno));
    }
    text_ = address.text();
  }

  [[nodiscard]] pollfd wanted() const {
    return {socket_.get(), static_cast<short>(is_connected_ ? POLLIN : POLLOUT), 0};
  }

  // What came of it, once poll() has found something.
  std::optional<Agreed> go_on() {
    if (!is_connected_) {
      int error = 0;
      socklen_t size = sizeof error;
      getsockopt(socket_.get(), SOL_SOCKET, SO_ERROR, &error, &size);
      if (error != 0) {
        fail(ErrorCode::connection_error,
             "cannot connect to " + text_ + ": " + std::strerror(error));
      }
      begin_handshake();
      return std::nullopt;
    }
    return receive_answer();
  }

 private:
  void begin_handshake() {
    is_connected_ = true;
    const timeval for_ever{};
    setsockopt(socket_.get(), SOL_SOCKET, SO_SNDTIMEO, &for_ever, sizeof for_ever);
    set_stream_options(socket_.get());
    Writer writer;
    write_create_connection(writer,
                            {.sender_node = options_.id,
                             .receiver_node = url_.node_id,
                             .sender_name = options_.name,
                             .receiver_name = url_.node_name},
                            offered_codes(options_.client_offer));
    request_ = writer.copy();
    for (const Piece& piece : writer.pieces()) {
      // A new socket has room for one small message.
      if (::send(socket_.get(), piece.data, piece.size, MSG_DONTWAIT | MSG_NOSIGNAL) !=
          static_cast<ssize_t>(piece.size)) {
        fail(ErrorCode::connection_error, "the connection to " + text_ + " broke");
      }
    }
  }

  std::optional<Agreed> receive_answer() {
    // No more than the answer, so that nothing behind it gets lost.
    const std::size_t have = bytes_.size();
    const std::size_t wanted = size_ == 0 ? smallest_header : size_;
    bytes_.resize(wanted);
    const ssize_t received = recv(socket_.get(), bytes_.data() + have, wanted - have, MSG_DONTWAIT);
    bytes_.resize(have + static_cast<std::size_t>(std::max<ssize_t>(received, 0)));
    if (received == 0) {
      fail(ErrorCode::connection_error, text_ + " closed the connection");
    }
    if (received < 0) {
      if (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR) return std::nullopt;
      fail(ErrorCode::connection_error, "the connection to " + text_ + " broke");
    }
    if (bytes_.size() != wanted) return std::nullopt;
    if (size_ == 0) {
      Limits limits = options_.limits;
      limits.message_size = longest_answer;
      size_ = message_size(bytes_, limits);
      if (size_ == 0) fail(ErrorCode::protocol_error, text_ + " speaks another protocol");
      return receive_answer();
    }
    return check_answer();
  }

  Agreed check_answer() {
    const auto message = std::make_unique<Message>();
    Entry entry;
    if (!read_message(bytes_, options_.limits, false, *message, nullptr) ||
        !EntryReader(*message).next(entry) || entry.type != EntryType::stream_op_ret ||
        entry.member != create_connection) {
      fail(ErrorCode::protocol_error, text_ + " speaks another protocol");
    }
    Decoder decoder(message->version, &message->strings);
    // An old server does not know the operation; it is used as such servers are.
    if (entry.error != 0 && static_cast<ErrorCode>(entry.error) != ErrorCode::protocol_error) {
      throw reported_error(decoder, entry);
    }
    if ((!url_.node_name.empty() && url_.node_name != message->sender_name) ||
        (!url_.node_id.is_any() && url_.node_id != message->sender_node)) {
      fail(ErrorCode::connection_error, "the node at " + text_ + " is not the one wanted");
    }
    Agreement agreement;
    Element element;
    if (entry.error == 0 &&
        find_element(decoder, entry.elements, entry.element_count, "capabilities", element)) {
      const auto codes = read_codes(element);
      const auto agreed = codes ? agree(*codes, options_.client_offer) : std::nullopt;
      if (!agreed) fail(ErrorCode::protocol_error, text_ + " agreed to what was not offered");
      agreement = *agreed;
    }
    return {std::move(socket_), message->sender_node, std::string(message->sender_name),
            agreement,          std::move(request_),  bytes_};
  }

  const Url& url_;
  const NodeOptions& options_;
  Descriptor socket_;
  std::string text_;
  bool is_connected_ = false;
  std::vector<std::byte> request_;
  std::vector<std::byte> bytes_;
  std::size_t size_ = 0;  // of the answer, once known
};

// Several addresses at once: what each has come to, and what the last failure was.
class Attempts {
 public:
  Attempts(const Url& url, const NodeOptions& options) : url_(url), options_(options) {}

  void begin(const Address& address) {
    keep_failure([&] { attempts_.push_back(std::make_unique<Attempt>(address, url_, options_)); });
  }
  [[nodiscard]] bool empty() const { return attempts_.empty(); }

  std::optional<Agreed> wait(Time until) {
    std::vector<pollfd> wanted;
    for (const auto& attempt : attempts_) wanted.push_back(attempt->wanted());
    const Interruption* const interruption = Interruption::current();
    if (interruption != nullptr) wanted.push_back({interruption->descriptor(), POLLIN, 0});
    poll(wanted.data(), wanted.size(), poll_milliseconds(until));
    if (interruption != nullptr && interruption->is_interrupted()) {
      fail(ErrorCode::operation_cancelled, "connecting was given up");
    }
    std::optional<Agreed> agreed;
    for (std::size_t i = 0; i < attempts_.size() && !agreed; ++i) {
      if (wanted[i].revents == 0) continue;
      if (!keep_failure([&] { agreed = attempts_[i]->go_on(); })) attempts_[i].reset();
    }
    std::erase(attempts_, nullptr);
    return agreed;
  }

  [[noreturn]] void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
    fail(ErrorCode::connection_error, "no answer from `" + url_.host + "` in time");
  }

 private:
  template <class Step>
  bool keep_failure(Step&& step) {
    try {
      step();
      return true;
    } catch (const Error&) {
      failure_ = std::current_exception();
      return false;
    }
  }

  const Url& url_;
  const NodeOptions& options_;
  std::vector<std::unique_ptr<Attempt>> attempts_;
  std::exception_ptr failure_;
};

}  // namespace

Agreed connect_stream(const Url& url, const NodeOptions& options, Time deadline) {
  const std::vector<Address> addresses = resolve(url.host, url.port);
  Attempts attempts(url, options);
  std::size_t next = 0;
  Time next_at = Clock::now();
  while (true) {
    const Time now = Clock::now();
    if (next < addresses.size() && (now >= next_at || attempts.empty())) {
      attempts.begin(addresses[next++]);
      next_at = now + next_address_delay;
      continue;
    }
    if (attempts.empty() || now >= deadline) attempts.rethrow();
    const Time until = next < addresses.size() ? std::min(next_at, deadline) : deadline;
    if (auto agreed = attempts.wait(until)) return std::move(*agreed);
  }
}

}  // namespace rr::channel
