// SPDX-License-Identifier: Apache-2.0
// The protocol is Boost.Beast's; it is given memory to read from and write to instead of a socket.
#include "runtime/cpp/src/channel/web_socket.hpp"

#include <array>
#include <atomic>
#include <boost/asio/bind_executor.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/rfc7230.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <optional>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/components.hpp"
#include "runtime/cpp/src/channel/memory_stream.hpp"
#include "runtime/cpp/src/channel/status_page.hpp"

namespace rr::channel {

namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
namespace websocket = boost::beast::websocket;

constexpr const char* protocol_name = "robotraconteur.robotraconteur.com";
// 04, section 2.2.
constexpr std::uint32_t longest_header = 8192;
constexpr std::size_t read_size = 16 * 1024;
// Connections that hold a copy of the page at once: strangers who do not read it cost no more.
constexpr unsigned most_open_pages = 8;
// First letters of the methods of HTTP. Web sockets begin with `GET` alone.
constexpr std::string_view method_letters = "GHPDOCT";

// What a node lets pages do.
struct WebRules {
  std::vector<std::string> origins;
  std::shared_ptr<const WebPage> page;   // null: none is served
  std::shared_ptr<const Status> status;  // null: not shown
};

// What all web sockets of a node live in.
struct Home {
  explicit Home(WebRules of_node) : rules(std::move(of_node)) {}

  const WebRules rules;
  std::atomic<unsigned> open_pages{0};   // connections that were answered with the page
  std::atomic<unsigned> open_states{0};  // the same with the node's state
  asio::io_context context{};  // where timers of the library, which are never started, register
};

using Stream = websocket::stream<MemoryStream, false>;
using Request = http::request<http::empty_body>;

std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

// What both sides have in common: frames.
class WebSocketLayer : public Layer {
 public:
  explicit WebSocketLayer(std::shared_ptr<Home> home)
      : home_(std::move(home)),
        executor_(home_->context, ends_),
        stream_(std::in_place, home_->context, ends_) {
    stream_->binary(true);
    stream_->auto_fragment(false);
    stream_->read_message_max(
        0);  // a message of ours may be of any number of frames, or one of many
  }
  ~WebSocketLayer() override {
    stream_.reset();
    ends_.reading.reset();
    ends_.work.clear();
  }

  void send(std::span<const std::byte> plain, Bytes& wire) override {
    stream_->async_write(asio::buffer(plain.data(), plain.size()),
                         bound([](beast::error_code, std::size_t) {}));
    ends_.run();
    take_out(wire);
  }
  [[nodiscard]] bool is_open() const override { return is_open_; }
  [[nodiscard]] bool has_ended() const override { return has_ended_; }

 protected:
  void take_frames(std::span<const std::byte> wire, Bytes& plain, Bytes& reply) {
    append(ends_.in, wire);
    plain_ = &plain;
    ends_.run();
    plain_ = nullptr;
    take_out(reply);
    if (!failure_.empty()) throw Error(ErrorCode::connection_error, failure_);
  }
  void open() {
    is_open_ = true;
    read_on();
  }
  void fail(std::string why) {
    if (failure_.empty()) failure_ = std::move(why);
  }
  void take_out(Bytes& to) {
    append(to, ends_.out);
    ends_.out.clear();
  }

  // To be called when what it ends has happened, in MemoryEnds::run().
  template <class Handler>
  asio::executor_binder<Handler, MemoryExecutor> bound(Handler handler) {
    return asio::bind_executor(executor_, std::move(handler));
  }
  [[nodiscard]] Stream& stream() { return *stream_; }
  [[nodiscard]] MemoryEnds& ends() { return ends_; }

 private:
  void read_on() {
    const auto handle = [this](beast::error_code error, std::size_t size) {
      if (error) {
        has_ended_ = true;
        if (error != websocket::error::closed) {
          fail("the other side breaks the web socket protocol: " + error.message());
        }
        return;
      }
      if (size != 0 && stream_->got_text()) {
        fail("the other side sends text where messages are bytes");
        return;
      }
      append(*plain_, std::span(buffer_).first(size));
      read_on();
    };
    stream_->async_read_some(asio::buffer(buffer_), bound(handle));
  }

  const std::shared_ptr<Home> home_;
  MemoryEnds ends_;
  const MemoryExecutor executor_;
  std::optional<Stream> stream_;
  std::array<std::byte, read_size> buffer_;
  Bytes* plain_ = nullptr;
  std::string failure_;
  bool is_open_ = false;
  bool has_ended_ = false;
};

class WebSocketClient final : public WebSocketLayer {
 public:
  WebSocketClient(std::shared_ptr<Home> home, const Url& url)
      : WebSocketLayer(std::move(home)),
        host_((url.host.find(':') == std::string::npos ? url.host : "[" + url.host + "]") + ":" +
              std::to_string(url.port)),
        target_((url.path.empty() ? "/" : url.path) + (url.query.empty() ? "" : "?" + url.query)) {
    stream().set_option(websocket::stream_base::decorator([](websocket::request_type& request) {
      request.set(http::field::sec_websocket_protocol, protocol_name);
      request.set(http::field::connection, "Upgrade");  // as the reference library spells it
    }));
  }

  void begin(Bytes& wire) override {
    const auto handle = [this](beast::error_code error) {
      if (error == websocket::error::upgrade_declined) {
        fail("the other side refuses web sockets: HTTP " + std::to_string(answer_.result_int()));
      } else if (error) {
        fail("the other side does not speak web sockets: " + error.message());
      } else if (answer_.count(http::field::sec_websocket_protocol) != 0 &&
                 !beast::iequals(answer_[http::field::sec_websocket_protocol], protocol_name)) {
        fail("the other side speaks another protocol over web sockets");
      } else {
        open();
      }
    };
    stream().async_handshake(answer_, host_, target_, bound(handle));
    ends().run();
    take_out(wire);
  }
  void receive(std::span<const std::byte> wire, Bytes& plain, Bytes& reply) override {
    take_frames(wire, plain, reply);
  }

 private:
  const std::string host_;
  const std::string target_;
  websocket::response_type answer_;
};

// One connection's share in the pages that are open at once.
class OpenPage {
 public:
  explicit OpenPage(std::atomic<unsigned>& all) : all_(all) {}
  ~OpenPage() {
    if (is_taken_) all_.fetch_sub(1);
  }
  OpenPage(const OpenPage&) = delete;
  OpenPage& operator=(const OpenPage&) = delete;
  /// False when there are too many.
  bool take() {
    is_taken_ = all_.fetch_add(1) < most_open_pages;
    if (!is_taken_) all_.fetch_sub(1);
    return is_taken_;
  }
  [[nodiscard]] bool is_taken() const { return is_taken_; }

 private:
  std::atomic<unsigned>& all_;
  bool is_taken_ = false;
};

class WebSocketServer final : public WebSocketLayer {
 public:
  WebSocketServer(const std::shared_ptr<Home>& home, WebClient client)
      : WebSocketLayer(home),
        rules_(home->rules),
        client_(std::move(client)),
        page_(home->open_pages),
        state_(home->open_states) {
    parser_.header_limit(longest_header);
  }

  void begin(Bytes& /*wire*/) override {}
  void receive(std::span<const std::byte> wire, Bytes& plain, Bytes& reply) override {
    if (is_open()) {
      take_frames(wire, plain, reply);
      return;
    }
    // The client closes once it has read the answer.
    if (page_.is_taken() || state_.is_taken()) return;
    append(head_, wire);
    beast::error_code error;
    const std::size_t used = parser_.put(asio::const_buffer(head_.data(), head_.size()), error);
    head_.erase(head_.begin(), head_.begin() + static_cast<std::ptrdiff_t>(used));
    if (error == http::error::need_more) {
      if (head_.size() > longest_header) refuse(http::status::bad_request, reply);
      return;
    }
    if (error) refuse(http::status::bad_request, reply);
    if (!parser_.is_header_done()) return;
    if (rules_.status != nullptr && answer_state(parser_.get(), reply)) return;
    const http::status status = judge(parser_.get());
    if (status == http::status::ok) {
      if (!page_.take()) refuse(http::status::service_unavailable, reply);
      append(reply, bytes_of(rules_.page->answer()));
      return;
    }
    if (status != http::status::switching_protocols) refuse(status, reply);
    accept(reply);
    const Bytes rest = std::exchange(head_, {});
    take_frames(rest, plain, reply);
  }

 private:
  // False for a request that is not for the node's state.
  bool answer_state(const Request& request, Bytes& reply) {
    const std::string_view target = text_of(request.target());
    const auto header = [&](auto field) {
      return request.count(field) == 0 ? std::optional<std::string_view>()
                                       : std::optional(text_of(request[field]));
    };
    const auto page = status_page(*rules_.status,
                                  {.method = text_of(request.method_string()),
                                   .path = target.substr(0, target.find('?')),
                                   .host = text_of(request[http::field::host]),
                                   .origin = header(http::field::origin),
                                   .fetch_site = header("Sec-Fetch-Site"),
                                   .from = client_.address,
                                   .may_be_clear = client_.is_encrypted || !client_.must_encrypt},
                                  rules_.origins);
    if (!page) return false;
    const bool is_refused = page->status >= 400 && page->status < 500;
    if (!is_refused && !state_.take()) refuse(http::status::service_unavailable, reply);
    append(reply, bytes_of(page->bytes));
    if (is_refused) {
      throw Error(ErrorCode::connection_error,
                  "the node's state was refused: HTTP " + std::to_string(page->status));
    }
    return true;
  }
  template <class Text>
  static std::string_view text_of(const Text& text) {
    return {text.data(), text.size()};
  }

  // In the order of 04, section 2.2. `ok`: the page is asked for.
  [[nodiscard]] http::status judge(const Request& request) const {
    if (request.method() != http::verb::get) return http::status::not_found;
    if (request.version() != 11) return http::status::bad_request;
    const std::string_view target(request.target().data(), request.target().size());
    const std::string_view path = target.substr(0, target.find('?'));
    const bool has_one_query = target.find('?') == target.rfind('?');
    if ((path != "/" && path != "*") || !has_one_query) return http::status::not_found;
    if (asks_for_page(request)) {
      return is_own_host(host_of(request)) ? http::status::ok : http::status::misdirected_request;
    }
    if (!http::token_list(request[http::field::upgrade]).exists("websocket") ||
        request.count(http::field::sec_websocket_key) == 0 ||
        !http::token_list(request[http::field::sec_websocket_version]).exists("13")) {
      return http::status::upgrade_required;
    }
    if (request.count(http::field::sec_websocket_protocol) != 0 &&
        !http::token_list(request[http::field::sec_websocket_protocol]).exists(protocol_name)) {
      return http::status::upgrade_required;
    }
    const auto origin = request[http::field::origin];
    if (request.count(http::field::origin) != 0 &&
        !may_connect({origin.data(), origin.size()}, request)) {
      return http::status::forbidden;
    }
    return http::status::switching_protocols;
  }

  [[nodiscard]] bool asks_for_page(const Request& request) const {
    return rules_.page != nullptr && request.count(http::field::upgrade) == 0;
  }
  static std::string host_of(const Request& request) {
    return std::string(request[http::field::host]);
  }
  // The page that this node has served has the origin that it is asked at.
  [[nodiscard]] bool may_connect(std::string_view origin, const Request& request) const {
    if (is_allowed_origin(origin, rules_.origins)) return true;
    const std::string host = host_of(request);
    const std::string own = (client_.is_encrypted ? "https://" : "http://") + host;
    return rules_.page != nullptr && host.find('*') == std::string::npos && is_own_host(host) &&
           is_allowed_origin(origin, {own});
  }

  [[noreturn]] void refuse(http::status status, Bytes& reply) {
    const auto reason = http::obsolete_reason(status);
    append(reply, bytes_of("HTTP/1.1 " + std::to_string(static_cast<unsigned>(status)) + " " +
                           std::string(reason) +
                           "\r\nUpgrade: websocket\r\nSec-WebSocket-Protocol: " + protocol_name +
                           "\r\nSec-WebSocket-Version: 13\r\nConnection: close\r\n"
                           "Content-Length: 0\r\n\r\n"));
    throw Error(ErrorCode::connection_error,
                "a web socket was refused: HTTP " + std::to_string(static_cast<unsigned>(status)));
  }

  // The library accepts; its answer is put into the words that clients of this protocol know.
  void accept(Bytes& reply) {
    bool is_accepted = false;
    stream().async_accept(parser_.get(),
                          bound([&](beast::error_code error) { is_accepted = !error; }));
    ends().run();
    Bytes answer;
    take_out(answer);
    if (!is_accepted) refuse(http::status::bad_request, reply);
    http::response_parser<http::empty_body> parsed;
    beast::error_code error;
    parsed.put(asio::const_buffer(answer.data(), answer.size()), error);
    append(reply, bytes_of("HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\n"
                           "Connection: Upgrade\r\nSec-WebSocket-Accept: " +
                           std::string(parsed.get()[http::field::sec_websocket_accept]) +
                           "\r\nSec-WebSocket-Protocol: " + protocol_name +
                           "\r\nSec-WebSocket-Version: 13\r\n\r\n"));
    open();
  }

  const WebRules& rules_;  // of the home
  const WebClient client_;
  OpenPage page_;
  OpenPage state_;
  http::request_parser<http::empty_body> parser_;
  Bytes head_;  // of the request, that the parser has not used
};

class BeastWebSockets final : public WebSockets {
 public:
  explicit BeastWebSockets(WebRules rules) : home_(std::make_shared<Home>(std::move(rules))) {}

  std::unique_ptr<Layer> make_client(const Url& url) override {
    return std::make_unique<WebSocketClient>(home_, url);
  }
  std::unique_ptr<Layer> make_server(WebClient client) override {
    return std::make_unique<WebSocketServer>(home_, std::move(client));
  }
  [[nodiscard]] bool is_request(std::byte first) const override {
    const auto letter = static_cast<char>(first);
    if (home_->rules.status == nullptr) return letter == 'G';
    return method_letters.find(letter) != std::string_view::npos;
  }

 private:
  const std::shared_ptr<Home> home_;
};

std::shared_ptr<WebSockets> make(const WebSocketOptions& options,
                                 std::shared_ptr<const Status> status) {
  return std::make_shared<BeastWebSockets>(
      WebRules{allowed_origins(options), served_page(options), std::move(status)});
}

}  // namespace

}  // namespace rr::channel

const rr::channel::WebComponent rr_component_web = {&rr::channel::make};
