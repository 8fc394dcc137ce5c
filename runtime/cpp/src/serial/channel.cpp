// SPDX-License-Identifier: Apache-2.0
// `rr+serial`: links to the node that offers the board in this process.
#include "rr/channel.hpp"

#include <mutex>
#include <utility>

#include "rr/error.hpp"
#include "rr/serial.hpp"
#include "runtime/cpp/src/serial/lines.hpp"

namespace rr::serial {
namespace {

/// A link that uses a line until it is closed.
class LineLink final : public MessageLink {
 public:
  explicit LineLink(std::unique_ptr<Lines::User> user)
      : user_(std::move(user)), link_(user_->line().connect()) {}

  void start(std::shared_ptr<LinkUser> user) override { link_->start(std::move(user)); }
  bool send(MemoryRef owner, std::span<const std::byte> message) override {
    return link_->send(std::move(owner), message);
  }
  void resume() override { link_->resume(); }
  void close() override {
    link_->close();
    user_.reset();
  }

 private:
  std::unique_ptr<Lines::User> user_;
  const std::unique_ptr<MessageLink> link_;
};

class SerialChannel final : public MessageChannel {
 public:
  [[nodiscard]] ChannelTraits traits() const override {
    return {.is_local = true, .has_one_service = true};
  }

  std::string service_at(const Url& url, Deadline deadline) override {
    const auto user = lines_->take(place_of(url), deadline);
    std::string name = user->line().wait(deadline);
    // connect() is next, and finds the board met.
    user->keep_until(deadline);
    return name;
  }

  std::unique_ptr<MessageLink> connect(const Url& url, Deadline deadline) override {
    auto user = lines_->take(place_of(url), deadline);
    (void)user->line().wait(deadline);
    return std::make_unique<LineLink>(std::move(user));
  }

  std::unique_ptr<LinkListener> listen(const Url& /*url*/,
                                       std::function<void(std::unique_ptr<MessageLink>)>) override {
    throw Error(
        ErrorCode::invalid_operation,
        "`rr+serial` leads to boards; nobody listens there (rr::BoardBridge offers boards)");
  }

 private:
  static BoardPlace place_of(const Url& url) {
    const bool has_path = !url.path.empty() && url.path != "/";
    if (url.host.empty() != has_path) {
      throw Error(ErrorCode::invalid_argument,
                  "a URL with `rr+serial` has the path of a port, `rr+serial:///dev/ttyUSB0`, or "
                  "the host and port of a board, `rr+serial://192.168.1.20:4000`");
    }
    const bool is_six = url.host.find(':') != std::string::npos;
    BoardPlace place =
        BoardPlace::parse((has_path ? url.path
                                    : "tcp://" + (is_six ? "[" + url.host + "]" : url.host) + ":" +
                                          std::to_string(url.port)) +
                          "?" + url.query);
    // The service is asked for by its name, and keeps the one that the sketch gives it.
    place.name.clear();
    return place;
  }

  const std::shared_ptr<Lines> lines_ = Lines::of_process();
};

}  // namespace
}  // namespace rr::serial

namespace rr {

std::shared_ptr<MessageChannel> serial_channel() {
  return std::make_shared<serial::SerialChannel>();
}

}  // namespace rr
