// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <rr/channel.hpp>

/// Carries messages as packets of a local socket, at most `limit` bytes each, at a name that the
/// host of the URL gives: `packets://name/?service=...`.
class PacketChannel : public rr::MessageChannel {
 public:
  static constexpr std::uint32_t limit = 100'000;

  rr::ChannelTraits traits() const override { return {.message_limit = limit, .is_local = true}; }
  std::unique_ptr<rr::MessageLink> connect(const rr::Url& url,
                                           std::chrono::steady_clock::time_point deadline) override;
  std::unique_ptr<rr::LinkListener> listen(
      const rr::Url& url, std::function<void(std::unique_ptr<rr::MessageLink>)> accept) override;
};
