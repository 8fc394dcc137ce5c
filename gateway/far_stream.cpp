// SPDX-License-Identifier: Apache-2.0
#include "gateway/far_stream.hpp"

#include <utility>

#include "gateway/properties.hpp"

namespace rr::gateway {
namespace {

constexpr std::chrono::milliseconds confirm_period{200};
constexpr std::uint64_t confirm_count = 128;

}  // namespace

FarStream::FarStream(const ServiceAddress& address, const std::string& path,
                     const std::string& member, Reader reader, StreamReader::Sink sink,
                     Function<bool()> has_room)
    : topic_(member_topic(address, path, member)),
      ask_topic_(request_topic(address, {Verb::stream, reader.user, path, member})),
      confirm_topic_(request_topic(address, {Verb::confirm, reader.user, path, member})),
      who_(std::move(reader)),
      has_room_(std::move(has_room)),
      reader_(std::move(sink), {}) {}

void FarStream::redirect(StreamReader::Sink sink, Function<bool()> has_room) {
  reader_.set_sink(std::move(sink));
  has_room_ = std::move(has_room);
}

void FarStream::receive(Message message, Outbox& outbox) {
  if (!has_room_()) return;
  reader_.receive(std::move(message), Clock::now());
  ask(outbox);
  if (reader_.position() >= confirmed_number_ + confirm_count) confirm(outbox);
}

void FarStream::reconnected(Outbox& outbox) {
  reader_.reconnected();
  ask(outbox);
}

void FarStream::tick(Outbox& outbox) {
  if (!has_room_()) return;
  ask(outbox);
  if (Clock::now() - confirmed_ >= confirm_period) confirm(outbox);
}

void FarStream::ask(Outbox& outbox) {
  const auto ask = reader_.ask(Clock::now());
  if (!ask) return;
  Message message{ask_topic_, {}};
  message.properties = {{"reader", who_.name},
                        {"from", std::to_string(ask->from)},
                        {"count", std::to_string(ask->count)}};
  message.response_topic = who_.reply_topic;
  // Asked again if it does not come: nothing for a broker to keep.
  message.expiry = std::chrono::seconds(2);
  outbox.add(std::move(message));
}

void FarStream::confirm(Outbox& outbox) {
  const auto number = reader_.unconfirmed();
  if (!number) return;
  confirmed_ = Clock::now();
  confirmed_number_ = *number;
  Message message{confirm_topic_, {}};
  message.properties = {{"reader", who_.name},
                        {"stream", hex_text(reader_.epoch())},
                        {"number", std::to_string(*number)}};
  outbox.add(std::move(message));
  reader_.confirmed(*number);
}

}  // namespace rr::gateway
