// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/fuzz/service_exchange.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sanitizer/lsan_interface.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string_view>
#include <utility>

#include "rr/reader.hpp"
#include "runtime/cpp/fuzz/fuzzed_service.hpp"
#include "runtime/cpp/fuzz/promise.hpp"

namespace rr::fuzz {
namespace {

// Smaller than usual, so that an input can come near it.
constexpr std::uint32_t largest_message = 48 * 1024;
// A socket's buffer holds more; what it does not hold is lost when the connection ends.
constexpr std::size_t surely_received = 64 * 1024;
// Answered in its turn, by which the client knows that all in front of it has been handled.
constexpr std::uint32_t marker_request_id = 0xB0B0B0B0;
constexpr std::uint64_t runs_per_clean_client = 64;
constexpr std::uint64_t runs_per_search_for_leaks = 2048;

void send_all(int descriptor, std::span<const std::byte> bytes) {
  // A node that has closed the connection takes nothing any more.
  const ssize_t sent = ::send(descriptor, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  promise(sent == static_cast<ssize_t>(bytes.size()) || (sent < 0 && errno == EPIPE),
          "an input fits into the socket's buffer");
}

// Pieces that the node is to receive one by one. Their sizes depend on the input only.
std::vector<std::span<const std::byte>> cut(std::span<const std::byte> bytes) {
  auto seed = static_cast<std::uint32_t>(bytes.size());
  for (const std::byte each : bytes) seed = seed * 31 + std::to_integer<std::uint32_t>(each);
  if (seed % 8 != 0) return {bytes};
  std::vector<std::span<const std::byte>> pieces;
  while (!bytes.empty()) {
    seed = seed * 1664525 + 1013904223;
    pieces.push_back(bytes.first(1 + (seed >> 16) % bytes.size()));
    bytes = bytes.subspan(pieces.back().size());
  }
  return pieces;
}

void await_reading(int descriptor) {
  await("the node reads what is sent to it", [&] {
    int unread = 0;
    pollfd poll_descriptor{descriptor, 0, 0};
    const bool is_over = poll(&poll_descriptor, 1, 0) == 1;  // it may leave things unread then
    return is_over || ioctl(descriptor, TIOCOUTQ, &unread) != 0 || unread == 0;
  });
}

Bytes marker() {
  MessageTree message = special_request(MessageVersion::v2, EntryType::get_node_info, "");
  message.entries.front().request_id = marker_request_id;
  return write_tree(message);
}

bool answers_marker(const MessageTree& message) {
  const EntryTree& entry = message.entries.front();
  return entry.type == EntryType::get_node_info_ret && entry.request_id == marker_request_id;
}

void check_message(std::span<const std::byte> bytes, MessageTree& tree) {
  Message message;
  const char* what = "";
  if (!read_message(bytes, Limits{}, true, message, &what)) promise(false, what);
  promise(read_tree(bytes, tree), "a message that is sent has the form of one");
  promise(!tree.entries.empty(), "a message that is sent has entries");
}

// What came behind the last whole message.
void check_end(std::span<const std::byte> end, std::size_t received) {
  constexpr std::string_view not_our_protocol = "HTTP/1.1 404 File Not Found\r\n";
  if (end.empty() || received > surely_received) return;
  const std::string_view text(reinterpret_cast<const char*>(end.data()), end.size());
  promise(text == not_our_protocol && received == end.size(), "messages are sent wholly");
}

// Takes whole messages from the front; what is left stays.
template <class Take>
void take_messages(Bytes& bytes, const Take& take) {
  std::span<const std::byte> left = bytes;
  MessageTree tree;
  while (left.size() >= smallest_message) {
    const std::size_t size = message_size(left, Limits{});
    if (size == 0 || size > left.size()) break;
    check_message(left.first(size), tree);
    take(tree);
    left = left.subspan(size);
  }
  bytes.erase(bytes.begin(), bytes.end() - static_cast<std::ptrdiff_t>(left.size()));
}

NodeOptions node_options() {
  NodeOptions options;
  options.name = service_node_name;
  options.id = service_node();
  // So many as there are duties: no thread takes over from one that the system has suspended, and
  // the same input always does the same.
  options.max_threads = 2;
  options.server_offer = {};
  options.limits.message_size = largest_message;
  options.size_before_connect = largest_message / 2;
  return options;
}

}  // namespace

ServiceExchange::ServiceExchange() : node_(node_options()) {}

void ServiceExchange::run(std::span<const std::byte> input) {
  if (input.size() > longest_input) return;
  offer_service();
  converse(input, [](const MessageTree&) {});
  if (++runs_ % runs_per_clean_client == 0) {
    take_service_away();
    offer_service();
    serve_clean_client();
  }
  take_service_away();
  if (runs_ % runs_per_search_for_leaks == 0) {
    promise(__lsan_do_recoverable_leak_check() == 0, "no memory is lost");
  }
}

void ServiceExchange::offer_service() {
  life_ = std::make_shared<const int>(0);
  ServiceOptions options;
  options.attributes = {{"gain", 0.75}, {"place", VarValue("bench 4")}};
  options.on_client_connected = [this](const ServiceClient& client) { send_rest(client.endpoint); };
  service_ = node_.register_service(std::string(service_name), make_fuzzed_root(life_),
                                    std::move(options));
}

void ServiceExchange::take_service_away() {
  service_->close();
  service_ = {};
  // Answers that were kept for later hold on to their connection as long as to the object.
  await("a closed connection goes", [&] { return fcntl(adopted_, F_GETFD) < 0; });
  await("a closed service leaves no object behind", [&] { return life_.use_count() == 1; });
}

// May be called by a thread of the node, before it reads on, or when the connection has ended.
void ServiceExchange::send_rest(std::uint32_t service_endpoint) {
  const std::lock_guard lock(mutex_);
  if (!std::exchange(must_send_rest_, false)) return;
  name_service_endpoint(rest_, service_endpoint);
  send_all(client_, rest_);
  if (!waits_for_answer_) ::shutdown(client_, SHUT_WR);
}

void ServiceExchange::converse(std::span<const std::byte> input, const Taker& take) {
  int ends[2];
  promise(socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) == 0, "there are sockets");
  client_ = ends[0];
  adopted_ = ends[1];
  const auto first = input.first(find_service_endpoint(input));
  const auto rest = input.subspan(first.size());
  rest_.assign(rest.begin(), rest.end());
  must_send_rest_ = !rest.empty();

  // What can be there before the node looks saves it from being woken twice.
  const auto pieces = cut(first);
  if (pieces.size() > 1) node_.adopt(adopted_);
  for (const auto piece : pieces) {
    send_all(client_, piece);
    if (pieces.size() > 1) await_reading(client_);
  }
  if (rest.empty()) {
    if (!waits_for_answer_) ::shutdown(client_, SHUT_WR);
  } else {
    send_all(client_, marker());
  }
  if (pieces.size() <= 1) node_.adopt(adopted_);

  Bytes received;
  std::size_t size = 0;
  std::byte buffer[16 * 1024];
  while (true) {
    const ssize_t got = recv(client_, buffer, sizeof buffer, 0);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    size += static_cast<std::size_t>(got);
    received.insert(received.end(), buffer, buffer + got);
    take_messages(received, [&](const MessageTree& message) {
      if (answers_marker(message)) send_rest(service_endpoint_place);
      take(message);
    });
  }
  check_end(received, size);
  {
    const std::lock_guard lock(mutex_);
    must_send_rest_ = false;
  }
  ::close(client_);
  await("the client of a closed connection goes", [&] { return service_->clients().empty(); });
}

void ServiceExchange::serve_clean_client() {
  Bytes input;
  const auto add = [&](const MessageTree& message) {
    const Bytes bytes = write_tree(message);
    input.insert(input.end(), bytes.begin(), bytes.end());
  };
  const double number = 2.5;
  Bytes payload(sizeof number);
  std::memcpy(payload.data(), &number, sizeof number);
  MessageTree call =
      session_request(MessageVersion::v4, EntryType::function_call_req, "conformance.funcs", "add");
  call.entries.front().elements = {named_element("a", ElementType::double_, payload),
                                   named_element("b", ElementType::double_, payload)};
  add(create_connection(true, false));
  add(special_request(MessageVersion::v4, EntryType::connect_client, service_name));
  add(call);
  double sum = 0;
  std::string answers;       // said when this fails
  waits_for_answer_ = true;  // nothing is done for who has gone
  converse(input, [&](const MessageTree& message) {
    const EntryTree& entry = message.entries.front();
    answers += " type " + std::to_string(static_cast<int>(entry.type)) + " error " +
               std::to_string(entry.error);
    for (const ElementTree& element : entry.elements) {
      if (element.name != "errorstring") continue;
      answers.append(": ").append(reinterpret_cast<const char*>(element.payload.data()),
                                  element.payload.size());
    }
    answers += ";";
    if (entry.type != EntryType::function_call_res) return;
    ::shutdown(client_, SHUT_WR);
    if (entry.elements.empty()) return;
    const Bytes& result = entry.elements.front().payload;
    if (result.size() == sizeof sum) std::memcpy(&sum, result.data(), sizeof sum);
  });
  waits_for_answer_ = false;
  promise(sum == number + number, ("a clean client is served; answers:" + answers).c_str());
}

}  // namespace rr::fuzz
