// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "rr/node_id.hpp"
#include "rr/visibility.hpp"
#include "rr/wire.hpp"

/// Whole messages as plain values that own everything, each field of the wire kept: for recorders,
/// debuggers and replays. Programs that only want the values use the readers, which copy nothing.
namespace RR_VISIBLE rr {

/// One element. In format 4 `flags` say which fields are on the wire (02, section 4); a code stands
/// for the text beside it, which is then not on the wire unless its own flag is set too. Fields
/// that are not on the wire are left as they are here, but for texts that a known code stands for.
struct ElementTree {
  std::uint8_t flags = 0;                 ///< which fields are on the wire
  std::string name;                       ///< empty for items of lists and int32 maps
  std::uint32_t name_code = 0;            ///< instead of the name; 0: none
  std::int32_t number = 0;                ///< of an item of a list, or the key of an int32 map
  ElementType type = ElementType::void_;  ///< what it is
  std::string type_name;                  ///< of structs, pods and namedarrays, qualified
  std::uint32_t type_name_code = 0;       ///< instead of the type name; 0: none
  std::string metadata;                   ///< mostly empty
  std::vector<std::byte> extended;        ///< what a later version of the format may add
  /// Items, string bytes or nested elements, as received. Written for a null only; otherwise the
  /// count of what is there is written.
  std::uint32_t count = 0;
  std::vector<std::byte> payload;     ///< packed items; empty for nested types
  std::vector<ElementTree> elements;  ///< of nested types

  /// Whether all fields are equal.
  bool operator==(const ElementTree&) const = default;
};

/// One entry; `flags` as above (02, section 3).
struct EntryTree {
  std::uint8_t flags = 0;               ///< which fields are on the wire
  EntryType type = EntryType::null;     ///< which request, answer or packet it is
  std::string service_path;             ///< of the object
  std::uint32_t service_path_code = 0;  ///< instead of the path; 0: none
  std::string member;                   ///< its name; empty where there is none
  std::uint32_t member_code = 0;        ///< instead of the member; 0: none
  std::uint32_t request_id = 0;         ///< which request an answer is for
  std::uint16_t error = 0;              ///< an ErrorCode; 0: none
  std::string metadata;                 ///< mostly empty
  std::vector<std::byte> extended;      ///< what a later version of the format may add
  std::vector<ElementTree> elements;    ///< arguments, results, values

  /// Whether all fields are equal.
  bool operator==(const EntryTree&) const = default;
};

/// One message; `flags` as above (02, section 2).
struct MessageTree {
  MessageVersion version = MessageVersion::v2;  ///< of the format
  std::uint8_t flags = 0;                       ///< which fields are on the wire
  NodeId sender_node;                           ///< zero while unknown
  NodeId receiver_node;                         ///< zero for any
  std::string sender_name;                      ///< empty for none
  std::string receiver_name;                    ///< empty for any
  std::uint32_t sender_endpoint = 0;    ///< number of the session's end at the sender; 0: none
  std::uint32_t receiver_endpoint = 0;  ///< the same at the receiver
  std::uint16_t priority = 0;           ///< format 4; mostly 0
  std::string metadata;                 ///< mostly empty
  std::uint16_t message_id = 0;         ///< counts the messages of a sender
  std::uint16_t message_res_id = 0;     ///< which message this one answers; 0: none
  /// The message's own table, in the order of the bytes.
  std::vector<std::pair<std::uint32_t, std::string>> strings;
  std::vector<std::byte> extended;  ///< what a later version of the format may add
  std::vector<EntryTree> entries;   ///< usually one

  /// Whether all fields are equal.
  bool operator==(const MessageTree&) const = default;
};

/// Reads any message that has the form of one: unlike a connection it takes one without entries,
/// and codes that stand for nothing, whose texts stay empty. Standard codes are always known.
/// Nesting is bounded by Limits::deepest. False, with `tree` in no certain state, when the bytes
/// are malformed.
bool read_tree(std::span<const std::byte> bytes, MessageTree& tree);
/// The bytes of a message. What read_tree took is given back byte for byte, provided that every
/// length in it had its shortest form (in format 2, that the reserved field of entries was 0).
/// Empty when it does not fit the format: in format 2 a text over 65,535 bytes; in format 4 a
/// number of entries other than one without the flag that announces it.
std::vector<std::byte> write_tree(const MessageTree& tree);

/// The same for a single element.
bool read_element_tree(std::span<const std::byte> bytes, MessageVersion version, ElementTree& tree);
/// The bytes of one element, as write_tree(). Empty when it does not fit the format.
std::vector<std::byte> write_element_tree(const ElementTree& tree, MessageVersion version);

}  // namespace rr
