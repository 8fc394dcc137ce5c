// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/fuzz/conversation_mutation.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "rr/reader.hpp"

namespace rr::fuzz {
namespace {

// A byte mutation may lengthen what it is given by so much.
constexpr std::size_t room = 64;

std::vector<Bytes> parts_of(std::span<const std::byte> input) {
  std::vector<Bytes> parts;
  for (const auto part : split_messages(input)) parts.emplace_back(part.begin(), part.end());
  return parts;
}

Bytes join(const std::vector<Bytes>& parts) {
  Bytes bytes;
  for (const Bytes& part : parts) bytes.insert(bytes.end(), part.begin(), part.end());
  return bytes;
}

}  // namespace

Bytes ConversationMutation::mutate(std::span<const std::byte> input) {
  Parts parts = parts_of(input);
  if (parts.empty() || random_.one_in(100)) {
    parts.clear();
    add_beginning(parts);
    add_request(parts);
    return join(parts);
  }
  if (random_.one_in(16)) {
    parts = {join(parts)};
    mutate_raw(parts.front());
    return join(parts);
  }
  for (std::uint32_t left = 1 + random_.below(3); left != 0 && !parts.empty(); --left) {
    const std::uint32_t choice = random_.below(20);
    Bytes& part = random_.pick(parts);
    if (choice < 3) {
      rearrange(parts);
    } else if (choice < 5) {
      add_request(parts);
    } else if (choice < 7) {
      mutate_raw(part);
      const auto size = static_cast<std::uint32_t>(part.size());
      if (size >= smallest_message && !random_.one_in(4)) {
        std::memcpy(part.data() + 4, &size, sizeof size);
      }
    } else {
      mutate_message(part, parts);
    }
  }
  return join(parts);
}

Bytes ConversationMutation::cross(std::span<const std::byte> first,
                                  std::span<const std::byte> second) {
  Parts parts = parts_of(first);
  Parts others = parts_of(second);
  if (parts.empty() || others.empty()) return join(parts);
  switch (random_.below(3)) {
    case 0: {  // the beginning of one, the end of the other
      parts.resize(1 + random_.below(parts.size()));
      const auto from = static_cast<std::ptrdiff_t>(random_.below(others.size()));
      parts.insert(parts.end(), others.begin() + from, others.end());
      break;
    }
    case 1: {
      const auto place = static_cast<std::ptrdiff_t>(random_.below(parts.size() + 1));
      parts.insert(parts.begin() + place, random_.pick(others));
      break;
    }
    default:
      mutate_message(random_.pick(parts), others);
      break;
  }
  return join(parts);
}

// How most clients begin, up to being connected to the service.
void ConversationMutation::add_beginning(Parts& parts) {
  const bool offer_v4 = !random_.one_in(3);
  parts.push_back(write_tree(create_connection(offer_v4, random_.one_in(2))));
  const EntryType type =
      random_.one_in(3) ? EntryType::connect_client : EntryType::connect_client_combined;
  const MessageVersion version = offer_v4 ? MessageVersion::v4 : MessageVersion::v2;
  parts.push_back(write_tree(special_request(version, type, service_name)));
}

void ConversationMutation::add_request(Parts& parts) {
  MessageMutation mutation(random_, mutate_bytes_);
  const auto place = static_cast<std::ptrdiff_t>(random_.below(parts.size() + 1));
  parts.insert(parts.begin() + place, write_tree(mutation.random_request()));
}

void ConversationMutation::rearrange(Parts& parts) {
  const auto from = static_cast<std::ptrdiff_t>(random_.below(parts.size()));
  const auto to = static_cast<std::ptrdiff_t>(random_.below(parts.size()));
  switch (random_.below(4)) {
    case 0:
      parts.erase(parts.begin() + from);
      break;
    case 1: {
      Bytes copy = parts[static_cast<std::size_t>(from)];
      parts.insert(parts.begin() + to, std::move(copy));
      break;
    }
    case 2:
      std::swap(parts[static_cast<std::size_t>(from)], parts[static_cast<std::size_t>(to)]);
      break;
    default:
      parts.resize(static_cast<std::size_t>(from) + 1);
      break;
  }
}

void ConversationMutation::mutate_raw(Bytes& part) {
  const std::size_t size = part.size();
  part.resize(size + room);
  part.resize(mutate_bytes_(reinterpret_cast<std::uint8_t*>(part.data()), size, part.size()));
}

void ConversationMutation::mutate_message(Bytes& part, const Parts& others) {
  MessageTree tree;
  if (!read_tree(part, tree)) {
    mutate_raw(part);
    return;
  }
  MessageTree other;
  if (!read_tree(random_.pick(others), other)) other = tree;
  MessageMutation mutation(random_, mutate_bytes_);
  for (std::uint32_t left = 1 + random_.below(4); left != 0; --left) mutation.mutate(tree, other);
  Bytes written = write_tree(tree);
  if (!written.empty()) part = std::move(written);
}

}  // namespace rr::fuzz
