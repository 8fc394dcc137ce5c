// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "rr/error.hpp"
#include "rr/options.hpp"
#include "rr/reader.hpp"
#include "rr/writer.hpp"
#include "runtime/cpp/src/channel/capabilities.hpp"
#include "runtime/cpp/src/channel/peer_layers.hpp"

/// What a connection answers by itself: stream operations and connection tests (04, sections 4
/// to 6).
namespace rr::channel {

/// What these answers say of this side.
struct OwnSide {
  const NodeOptions& options;
  const LinkTerms& link;
  const PeerLayers& layers;
  const NodeId& remote_node;  ///< zero until the other side has said who it is
  MessageVersion version;     ///< agreed
  bool is_server;
  bool may_share = false;  ///< memory with the client
};

/// Whether an entry is for the connection itself, be it an answer to one of its own requests.
[[nodiscard]] bool is_own(EntryType type);

/// What follows from an answer once it has been sent.
struct OwnAnswer {
  bool is_answer = false;  ///< the writer has one to be sent
  /// The other side has said who it is, and what is agreed with it; before the answer is sent.
  std::optional<Agreement> agreement{};
  bool begins_tls = false;
  bool is_mutual = false;      ///< the client wants its certificate to be asked for
  bool shares_memory = false;  ///< with a memory; where there is none refuse() has another answer
  bool has_slots = false;      ///< and wires may have slots
};

/// Writes answers to entries that are is_own().
class OwnRequests {
 public:
  OwnRequests(const OwnSide& side, Writer& writer) : side_(side), writer_(writer) {}
  [[nodiscard]] OwnAnswer answer(const Message& message, const Entry& entry);
  /// The answer to a stream operation that is not possible, for people.
  void refuse(const Message& message, const Entry& entry, std::string_view why);
  /// The request that keeps a connection alive.
  void write_test();

 private:
  OwnAnswer answer_stream_op(const Message& message, const Entry& entry);
  OwnAnswer answer_create_connection(const Message& message, const Entry& entry);
  OwnAnswer answer_start_tls(const Message& message, const Entry& entry);
  OwnAnswer answer_share_memory(const Message& message, const Entry& entry);
  OwnAnswer answer_capability(const Message& message, const Entry& entry);
  OwnAnswer answer_test(const Message& message, const Entry& entry);
  void write_refusal(const Message& message, const Entry& entry, ErrorCode code,
                     std::string_view why);
  [[nodiscard]] bool is_for_this_node(const Message& message) const;
  [[nodiscard]] MessageHeader header_to(const Message& message) const;

  const OwnSide& side_;
  Writer& writer_;
};

}  // namespace rr::channel
