// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "rr/mutex.hpp"
#include "rr/options.hpp"
#include "rr/visibility.hpp"
#include "runtime/cpp/src/platform/address.hpp"

namespace rr::channel {

class MetricsText;

/// The state of a node for programs that watch it, and which of them may ask. Any thread.
class RR_INSIDE Status {
 public:
  /// Throws rr::Error (invalid_argument) for places that are none.
  explicit Status(const MetricsOptions& options);

  /// Before anybody asks, or from then on: writes whole families. Called on any thread, for as long
  /// as this lives; runs no code of the program.
  using Source = std::function<void(MetricsText&)>;
  void add(Source source);
  /// All sources, in their order, as OpenMetrics text.
  [[nodiscard]] std::string metrics() const;

  void set_fault(std::string why);
  /// Empty: the node is well.
  [[nodiscard]] std::string fault() const;

  /// Whether a peer may ask: an address as remote_address_of() writes it.
  [[nodiscard]] bool may_ask(std::string_view remote_address) const;
  /// Whether this is a name of this machine, as is_own_host(), or one that the options add.
  [[nodiscard]] bool is_own_name(std::string_view host) const;

 private:
  // Addresses of which the first bits are those of one.
  struct Network {
    platform::IpAddress address;
    unsigned bits = 0;
  };
  static Network network_of(const std::string& text);
  static bool contains(const Network& network, const platform::IpAddress& address);

  std::vector<Network> from_;
  bool is_for_all_ = false;
  std::vector<std::string> hosts_;  // in lower case

  mutable Mutex mutex_;
  std::vector<Source> sources_ RR_GUARDED_BY(mutex_);
  std::string fault_ RR_GUARDED_BY(mutex_);
};

}  // namespace rr::channel
