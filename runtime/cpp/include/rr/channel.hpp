// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "rr/buffer.hpp"
#include "rr/url.hpp"
#include "rr/visibility.hpp"

/// Custom transports between nodes; docs/howto/channels.md has an example.
namespace RR_VISIBLE rr {

/// What a channel is like.
struct ChannelTraits {
  /// Bytes of the largest message that it carries; 0: as large as the nodes allow.
  std::uint32_t message_limit = 0;
  bool is_local = false;      ///< both ends are on one machine
  bool is_encrypted = false;  ///< nothing between the ends can read or change what it carries
  bool is_lossy = false;      ///< messages may get lost: their calls end with their time-outs
  /// A URL leads to one service only, and need not name it: MessageChannel::service_at().
  bool has_one_service = false;
};

/// What a link tells the node. All of it may be called on any thread, also inside MessageLink::send
/// and after MessageLink::close, when nothing happens.
class LinkUser {
 public:
  virtual ~LinkUser() = default;
  /// A whole message has come. False when the node cannot take it yet, and has not: it is to be
  /// given again after MessageLink::resume(). The owner keeps the bytes, which may not change any
  /// more; arrays that are received share them.
  virtual bool received(MemoryRef owner, std::span<const std::byte> message) = 0;
  /// The same for bytes that are copied.
  virtual bool received(std::span<const std::byte> message) = 0;
  /// There is room again after MessageLink::send() has returned false.
  virtual void has_room() = 0;
  /// Nothing comes any more, nor can be sent.
  virtual void ended() = 0;
};

/// One connection of a channel: carries whole messages of at least 16 bytes in both directions, in
/// order. Each function is called by one thread at a time; send() and resume() may run at once.
class MessageLink {
 public:
  virtual ~MessageLink() = default;
  /// The address of this side as it may stand in a URL, `scheme://host:port`; empty if unknown.
  [[nodiscard]] virtual std::string local_url() const { return {}; }
  /// The first call: messages go to `user` from now on.
  virtual void start(std::shared_ptr<LinkUser> user) = 0;
  /// Takes a message over and sends it; may not block. The owner keeps the bytes. False when there
  /// is no room for it: it is given again after LinkUser::has_room().
  virtual bool send(MemoryRef owner, std::span<const std::byte> message) = 0;
  /// What LinkUser::received() has refused can be taken now.
  virtual void resume() {}
  /// The last call but the destructor, once: what was sent before should still arrive. May not
  /// block.
  virtual void close() = 0;
};

/// A listener; ends with the object.
class LinkListener {
 public:
  virtual ~LinkListener() = default;
  /// Where: `scheme://host:port`, without a query.
  [[nodiscard]] virtual std::vector<std::string> urls() const = 0;
};

/// A way to reach other nodes, named by the scheme of their URLs, which NodeOptions::channels
/// gives it. A node calls it from several threads; it must outlive neither the node nor its links.
class MessageChannel {
 public:
  virtual ~MessageChannel() = default;
  /// What the channel is like. Asked once for each connection and listener.
  [[nodiscard]] virtual ChannelTraits traits() const = 0;
  /// Connects to where the URL says; the handshake is the node's. Blocks until the deadline. Throws
  /// rr::Error.
  virtual std::unique_ptr<MessageLink> connect(const Url& url,
                                               std::chrono::steady_clock::time_point deadline) = 0;
  /// The service that a URL without one means; connect() follows. Blocks until the deadline. Throws
  /// rr::Error. Empty where the URL has to name it.
  virtual std::string service_at(const Url& /*url*/,
                                 std::chrono::steady_clock::time_point /*deadline*/) {
    return {};
  }
  /// Gives each new link to `accept`, on any thread. Throws rr::Error; one that cannot listen
  /// throws invalid_operation.
  virtual std::unique_ptr<LinkListener> listen(
      const Url& url, std::function<void(std::unique_ptr<MessageLink>)> accept) = 0;
};

}  // namespace rr
