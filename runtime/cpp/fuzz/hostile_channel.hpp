// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "rr/channel.hpp"
#include "runtime/cpp/fuzz/hostile_script.hpp"

namespace rr::fuzz {

inline constexpr std::string_view hostile_scheme = "rr+hostile";
/// Where the service is that follows the script.
inline constexpr std::string_view hostile_url = "rr+hostile://fuzz/?service=conformance";

/// Leads to a service of which there is nothing but what it sends: each message of the client is
/// answered before its sending returns, so that no time passes and no other thread is needed.
class HostileChannel final : public MessageChannel {
 public:
  explicit HostileChannel(const RecordedService& recorded);

  /// The input that the service follows from now on.
  void follow(std::span<const std::byte> input) { script_->start(input); }
  /// Connections that the node has not destroyed yet.
  [[nodiscard]] int links() const { return *links_; }

  [[nodiscard]] ChannelTraits traits() const override { return {.is_local = true}; }
  std::unique_ptr<MessageLink> connect(const Url& url,
                                       std::chrono::steady_clock::time_point deadline) override;
  std::unique_ptr<LinkListener> listen(
      const Url& url, std::function<void(std::unique_ptr<MessageLink>)> accept) override;

 private:
  const std::shared_ptr<HostileScript> script_;
  const std::shared_ptr<std::atomic<int>> links_ = std::make_shared<std::atomic<int>>(0);
};

}  // namespace rr::fuzz
