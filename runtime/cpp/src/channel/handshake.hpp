// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "rr/node_id.hpp"
#include "rr/options.hpp"
#include "rr/reader.hpp"
#include "rr/url.hpp"
#include "runtime/cpp/src/channel/capabilities.hpp"
#include "runtime/cpp/src/channel/carrier.hpp"
#include "runtime/cpp/src/channel/socket.hpp"

namespace rr::channel {

struct PeerProof;

/// A way to another node on which both sides have agreed how to talk.
struct Agreed {
  Descriptor socket;
  std::unique_ptr<Carrier> carrier;          // null: none
  NodeId certified_node;                     // what the other side has proved to be; zero: nothing
  std::shared_ptr<const PeerProof> proof{};  // and with what
  NodeId remote_node;
  std::string remote_name;
  Agreement agreement;
  // The two messages that did it.
  std::vector<std::byte> request;
  std::vector<std::byte> answer;
};

/// The answer of a server has a name or two and a few codes.
inline constexpr std::size_t longest_answer = 64 * 1024;

/// What a client says first (04, section 4.1).
std::vector<std::byte> create_connection_request(const Url& url, const NodeOptions& options);

/// Checks the answer to it, and fills in what it says (04, section 4.3). `place` names the other
/// side in errors. Throws rr::Error.
void check_create_connection(std::span<const std::byte> answer, const Url& url,
                             const NodeOptions& options, const std::string& place, Agreed& agreed);

/// What a client asks for a stream capability (04, section 4.5).
std::vector<std::byte> capability_request(std::string_view capability, const Agreed& agreed,
                                          const NodeOptions& options);
/// The level in the answer to it. Throws rr::Error.
std::uint32_t check_capability(std::span<const std::byte> answer, std::string_view capability,
                               const Agreed& agreed, const NodeOptions& options,
                               const std::string& place);
/// What a client asks for memory that both sides share.
std::vector<std::byte> share_memory_request(const Agreed& agreed, const NodeOptions& options);
/// What comes with such memory.
struct SharedTerms {
  bool has_slots = false;  ///< for wires
};
/// What the answer to it brings; nothing when there is no memory. Throws rr::Error.
std::optional<SharedTerms> check_share_memory(std::span<const std::byte> answer,
                                              const Agreed& agreed, const NodeOptions& options,
                                              const std::string& place);
/// Whether a node wants slots for its wires, where it shares memory: what a tap records has to come
/// by messages.
[[nodiscard]] inline bool wants_slots(const NodeOptions& options) { return options.tap == nullptr; }

/// What a client says before everything else to change over to TLS (04, section 6).
std::vector<std::byte> start_tls_request(const Url& url, bool is_mutual);

/// Checks the answer to it, and returns who the other side says it is. Throws rr::Error.
NodeId check_start_tls(std::span<const std::byte> answer, const Url& url,
                       const NodeOptions& options, const std::string& place);

}  // namespace rr::channel
