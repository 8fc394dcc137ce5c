// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "rr/message_tree.hpp"
#include "rr/node_id.hpp"

/// The inputs of the service fuzzer: what a client sends on one connection.
namespace rr::fuzz {

using Bytes = std::vector<std::byte>;

/// Under this name the service is offered, as that of the captures is.
inline constexpr std::string_view service_name = "conformance";

/// The ends of a session. An input names the service's by a number that stands for the one that it
/// has not been told yet; no text, length or code contains these four bytes by chance.
inline constexpr std::uint32_t client_endpoint = 1001;
inline constexpr std::uint32_t service_endpoint_place = 0x07070707;

/// The nodes of the captures.
NodeId client_node();
NodeId service_node();
inline constexpr std::string_view client_node_name = "conformance.client";
inline constexpr std::string_view service_node_name = "conformance.server";

/// The messages of an input, by the sizes that they announce; the last part is the rest when that
/// does not go on with a message.
std::vector<std::span<const std::byte>> split_messages(std::span<const std::byte> input);

/// Writes a number over all places that stand for it.
void name_service_endpoint(std::span<std::byte> input, std::uint32_t number);
/// Where the first message begins that has such a place; the size of the input if none has.
std::size_t find_service_endpoint(std::span<const std::byte> input);

/// The first message of a client, which offers format 4 and its string table, or not.
MessageTree create_connection(bool offer_v4, bool offer_strings);
/// A message of one entry outside of, or in, a session.
MessageTree special_request(MessageVersion version, EntryType type, std::string_view path);
MessageTree session_request(MessageVersion version, EntryType type, std::string_view path,
                            std::string_view member);
/// An element with a name.
ElementTree named_element(std::string_view name, ElementType type, Bytes payload);

/// Changes the format of a message and what it needs for that.
void change_version(MessageTree& message, MessageVersion version);

}  // namespace rr::fuzz
