// SPDX-License-Identifier: Apache-2.0
#include "conformance/harness/sharing.hpp"

#include <array>
#include <chrono>
#include <cstring>
#include <memory>
#include <rr/message_tree.hpp>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/cpp/src/channel/operations.hpp"
#include "runtime/cpp/src/channel/shared_carrier.hpp"
#include "runtime/cpp/src/platform/shared_memory.hpp"

namespace rr::conformance {
namespace {

constexpr Milliseconds answer_patience{3000};
constexpr std::size_t ring_size = 4096;  // so that messages go around it often
constexpr std::chrono::microseconds no_spin{0};

// The only entry of a message.
bool has_entry(const Bytes& bytes, rr::EntryType type, std::string_view member,
               rr::MessageTree& message) {
  return rr::read_tree(bytes, message) && message.entries.size() == 1 &&
         message.entries[0].type == type && message.entries[0].member == member;
}

rr::MessageTree message_of(rr::EntryType type, std::string_view member) {
  rr::MessageTree message;
  message.version = rr::MessageVersion::v2;
  rr::EntryTree& entry = message.entries.emplace_back();
  entry.type = type;
  entry.member = member;
  return message;
}

// Sends a request, and waits for its answer, in which names may be codes. Answers to what was sent
// earlier are left for others.
rr::MessageTree asked(Stream& stream, const rr::MessageTree& request, rr::EntryType answer_type) {
  stream.send(rr::write_tree(request));
  std::vector<Bytes> others;
  Bytes bytes;
  while (stream.receive(bytes, answer_patience) == Arrival::message) {
    rr::MessageTree answer;
    if (!rr::read_tree(bytes, answer) || answer.entries.size() != 1) break;
    const rr::EntryTree& entry = answer.entries[0];
    if (entry.type == answer_type && entry.member != channel::create_connection) {
      if (entry.error != 0) break;
      stream.put_back(others);
      return answer;
    }
    others.push_back(bytes);
  }
  throw std::runtime_error("there is no shared memory");
}

std::unique_ptr<channel::SharedCarrier> carrier_of(channel::SharedRings rings, bool is_service,
                                                   const Stream& stream) {
  return std::make_unique<channel::SharedCarrier>(std::move(rings), is_service, stream.descriptor(),
                                                  no_spin);
}

void ask_for_memory(Stream& stream) {
  using enum rr::EntryType;
  const rr::MessageTree answer =
      asked(stream, message_of(stream_check_capability, channel::shared_memory_capability),
            stream_check_capability_ret);
  const auto& elements = answer.entries[0].elements;
  if (elements.size() != 1 || elements[0].payload.size() != sizeof(std::uint32_t) ||
      elements[0].payload[0] != std::byte{channel::shared_memory_level}) {
    throw std::runtime_error("shared memory is not offered");
  }
  asked(stream, message_of(stream_op, channel::share_memory), stream_op_ret);
  std::error_code error;
  channel::SharedRings rings = channel::SharedRings::open(stream.take_handle(), error);
  if (!rings) throw std::runtime_error("the shared memory is wrong: " + error.message());
  stream.share(carrier_of(std::move(rings), false, stream));
}

void answer_level(Stream& stream) {
  rr::MessageTree answer =
      message_of(rr::EntryType::stream_check_capability_ret, channel::shared_memory_capability);
  rr::ElementTree& element = answer.entries[0].elements.emplace_back();
  element.name = "return";
  element.type = rr::ElementType::uint32;
  element.count = 1;
  element.payload.resize(sizeof(std::uint32_t));
  std::memcpy(element.payload.data(), &channel::shared_memory_level, element.payload.size());
  stream.send(rr::write_tree(answer));
}

void give_memory(Stream& stream) {
  platform::Descriptor handle;
  std::error_code error;
  channel::SharedRings rings = channel::SharedRings::make(ring_size, handle, error);
  if (!rings) throw std::runtime_error("cannot share memory: " + error.message());
  const Bytes answer =
      rr::write_tree(message_of(rr::EntryType::stream_op_ret, channel::share_memory));
  if (platform::send_with_handle(stream.descriptor(), answer, handle) !=
      static_cast<std::ptrdiff_t>(answer.size())) {
    throw std::runtime_error("cannot pass shared memory");
  }
  stream.share(carrier_of(std::move(rings), true, stream));
}

}  // namespace

void share_as_client(Stream& stream) {
  stream.set_filter([is_asked = false](Stream& line, const Bytes& bytes) mutable {
    rr::MessageTree message;
    if (is_asked ||
        !has_entry(bytes, rr::EntryType::stream_op_ret, channel::create_connection, message) ||
        message.entries[0].error != 0) {
      return false;
    }
    is_asked = true;
    ask_for_memory(line);
    return false;
  });
}

void share_as_service(Stream& stream) {
  stream.set_filter([](Stream& line, const Bytes& bytes) {
    rr::MessageTree message;
    if (has_entry(bytes, rr::EntryType::stream_check_capability, channel::shared_memory_capability,
                  message)) {
      answer_level(line);
      return true;
    }
    if (has_entry(bytes, rr::EntryType::stream_op, channel::share_memory, message)) {
      give_memory(line);
      return true;
    }
    return false;
  });
}

}  // namespace rr::conformance
