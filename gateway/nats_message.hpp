// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "gateway/carrier.hpp"

/// Messages as NATS has them. Properties are headers of the same name. Values keep their letters
/// but `%`, what is no printable ASCII, and spaces at both ends, which are `%XX`; an empty value is
/// `%`. Besides, `rr-correlation` is hexadecimal, and `rr-expiry` a number of seconds. The topic of
/// the response is the reply subject.
namespace rr::gateway {

/// What travels.
struct NatsMessage {
  std::string subject;
  std::string reply{};  ///< where answers go; empty: nowhere
  Bytes payload{};
  Properties headers{};
  std::string heard_at{};      ///< of what arrives: the subject of the subscription
  bool is_unanswered = false;  ///< of what arrives: nobody listens to what was published with reply
};

/// Bytes that count for the broker's limit: of headers and payload.
std::size_t size_of(const NatsMessage& message);
/// The first header of a name; nothing for none.
std::optional<std::string_view> header_of(const NatsMessage& message, std::string_view name);

/// A value of a property as that of a header.
std::string header_text(std::string_view value);
/// The reverse. What is not encoded stays as it is: others may publish, too.
std::string value_of_header(std::string_view text);

/// Without its retained flag.
NatsMessage nats_message_of(const Message& message);
/// The reverse, and not retained. Nothing for a subject that no topic has.
std::optional<Message> message_of(NatsMessage message);
/// The expiry of a message; nothing: never.
std::optional<std::chrono::seconds> expiry_of(const NatsMessage& message);

}  // namespace rr::gateway
