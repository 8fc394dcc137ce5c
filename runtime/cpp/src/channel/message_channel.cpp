// SPDX-License-Identifier: Apache-2.0
// Channels that carry whole messages: those of programs, and the one inside the process.
#include <array>
#include <utility>

#include "rr/channel.hpp"
#include "rr/error.hpp"
#include "runtime/cpp/src/channel/accept.hpp"
#include "runtime/cpp/src/channel/channel.hpp"
#include "runtime/cpp/src/channel/connected.hpp"
#include "runtime/cpp/src/channel/interruption.hpp"
#include "runtime/cpp/src/channel/message_carrier.hpp"

namespace rr::channel {
namespace {

/// The channel of one scheme.
class MessageLinks final : public Channel, public std::enable_shared_from_this<MessageLinks> {
 public:
  MessageLinks(ChannelContext context, std::string scheme, std::shared_ptr<MessageChannel> channel)
      : context_(std::move(context)), scheme_(std::move(scheme)), channel_(std::move(channel)) {}

  [[nodiscard]] ChannelTraits traits(std::string_view /*scheme*/) const override {
    ChannelTraits traits = channel_->traits();
    const std::uint32_t limit = context_.options->limits.message_size;
    if (traits.message_limit == 0 || traits.message_limit > limit) traits.message_limit = limit;
    return traits;
  }

  std::shared_ptr<Connection> connect(const Url& url, Time deadline,
                                      const AcceptHandler& make_receiver) override {
    Agreed agreed;
    auto link = channel_->connect(url, deadline);
    if (!link) throw Error(ErrorCode::connection_error, "`" + scheme_ + "` has given no link");
    LinkTerms terms = terms_of(*link);
    agreed.carrier = std::make_unique<MessageCarrier>(std::move(link), agreed.socket);
    agree(url, deadline, agreed);
    return connected(context_, std::move(agreed), std::move(terms), make_receiver);
  }

  std::string service_at(const Url& url, Time deadline) override {
    return channel_->service_at(url, deadline);
  }

  std::unique_ptr<Listener> listen(const Url& url, AcceptHandler accept) override {
    class Listening final : public Listener {
     public:
      explicit Listening(std::unique_ptr<LinkListener> listener) : listener_(std::move(listener)) {}
      [[nodiscard]] std::vector<std::string> urls() const override { return listener_->urls(); }

     private:
      const std::unique_ptr<LinkListener> listener_;
    };
    auto listener = channel_->listen(url, [self = weak_from_this(), accept = std::move(accept)](
                                              std::unique_ptr<MessageLink> link) {
      if (const auto alive = self.lock()) alive->take(std::move(link), accept);
    });
    if (!listener) throw Error(ErrorCode::invalid_operation, "`" + scheme_ + "` cannot listen");
    return std::make_unique<Listening>(std::move(listener));
  }

 private:
  LinkTerms terms_of(const MessageLink& link) const {
    LinkTerms terms = tcp_terms(*context_.options, scheme_);
    terms.traits = channel_->traits();
    terms.local_url = link.local_url();
    if (terms.local_url.empty()) terms.local_url = scheme_ + "://";
    return terms;
  }

  void take(std::unique_ptr<MessageLink> link, const AcceptHandler& accept) const {
    if (!link) return;
    try {
      Descriptor socket;
      LinkTerms terms = terms_of(*link);
      auto carrier = std::make_unique<MessageCarrier>(std::move(link), socket);
      accept_connection(context_, std::move(socket), std::move(terms), std::move(carrier), accept);
    } catch (const std::exception&) {
      // It has been closed, which the other side finds out.
    }
  }

  void agree(const Url& url, Time deadline, Agreed& agreed) const {
    agreed.request = create_connection_request(url, *context_.options);
    const platform::Buffer piece{agreed.request.data(), agreed.request.size()};
    if (agreed.carrier->send({&piece, 1}) != static_cast<std::ptrdiff_t>(agreed.request.size())) {
      throw Error(ErrorCode::connection_error, "the connection by `" + scheme_ + "` broke");
    }
    while (true) {
      Frame answer;
      const std::ptrdiff_t size = agreed.carrier->receive(answer, false);
      if (size > 0) {
        check_create_connection(answer.bytes, url, *context_.options, "`" + scheme_ + "`", agreed);
        return;
      }
      if (size != platform::nothing_now) {
        throw Error(ErrorCode::connection_error, "the other side closed the connection");
      }
      wait(agreed.socket.get(), deadline);
    }
  }

  void wait(int socket, Time deadline) const {
    using platform::ready::input;
    std::array<platform::Awaited, 2> wanted{{{socket, input}, {-1, input}}};
    const Interruption* const interruption = Interruption::current();
    if (interruption != nullptr) wanted[1].socket = interruption->descriptor();
    const bool is_found = platform::wait_for_any(wanted, deadline);
    if (interruption != nullptr && interruption->is_interrupted()) {
      throw Error(ErrorCode::operation_cancelled, "connecting was given up");
    }
    if (!is_found) {
      throw Error(ErrorCode::connection_error, "no answer by `" + scheme_ + "` in time");
    }
  }

  const ChannelContext context_;
  const std::string scheme_;
  const std::shared_ptr<MessageChannel> channel_;
};

}  // namespace

std::shared_ptr<Channel> make_message_channel(ChannelContext context, std::string scheme,
                                              std::shared_ptr<MessageChannel> channel) {
  return std::make_shared<MessageLinks>(std::move(context), std::move(scheme), std::move(channel));
}

}  // namespace rr::channel
