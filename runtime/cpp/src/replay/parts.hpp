// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include "rr/message_tree.hpp"

/// Parts of messages that are new each time the same is done: who plays a recording puts them aside
/// before it compares, and renames them before it sends.
namespace rr::replay {

/// Live generator indices by recorded ones.
using Generators = std::map<std::int32_t, std::int32_t>;
/// Live endpoint numbers by recorded ones.
using Endpoints = std::map<std::uint32_t, std::uint32_t>;

/// The first element of that name; null when there is none.
const ElementTree* find_named(const std::vector<ElementTree>& elements, std::string_view name);
ElementTree* find_named(std::vector<ElementTree>& elements, std::string_view name);
/// Of an element that holds one int32.
std::optional<std::int32_t> int32_of(const ElementTree& element);

/// The version text of a library: the recorded one is put into the live entry.
void put_aside_client_version(const EntryTree& recorded, EntryTree& live);
/// The same for the `packettime` of a wire, when both have a sound one.
void put_aside_packet_time(const EntryTree& recorded, EntryTree& live);
/// The same for the ports in connection URLs (`rr+tcp://host:port/...`) that are equal otherwise.
void put_aside_ports(const EntryTree& recorded, EntryTree& live);
/// The service gives an index with the answer to the call of a generator: notes it, and puts the
/// recorded one into the live entry.
void put_aside_generator_index(const EntryTree& recorded, EntryTree& live, Generators& generators);
/// Replaces the index in a request for a generator by what `generators` says; others stay.
void rename_generator(EntryTree& entry, const Generators& generators);
/// Puts the elements of an error into the order of the recorded one, when both have the same names.
void put_in_order(const EntryTree& recorded, EntryTree& live);

/// Replaces the endpoint numbers of a message by what `names` says; others stay.
void rename_endpoints(MessageTree& message, const Endpoints& names);
/// The side that sends names its endpoint: the first time it is seen, it is noted.
void learn_endpoint(const MessageTree& recorded, const MessageTree& live, Endpoints& endpoints);

/// The answer to a connection test that has just come; empty when that is none.
std::vector<std::byte> connection_test_answer(const MessageTree& test);

}  // namespace rr::replay
