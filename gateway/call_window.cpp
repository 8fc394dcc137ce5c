// SPDX-License-Identifier: Apache-2.0
#include "gateway/call_window.hpp"

#include <cstring>
#include <utility>

#include "rr/error.hpp"

namespace rr::gateway {
namespace {

constexpr std::uint16_t begun = 1;
constexpr std::uint16_t ended = 2;

// An answer in a record: payload, then each property as two texts, each behind its length.
void put_part(Bytes& bytes, const void* data, std::size_t size) {
  const auto length = static_cast<std::uint32_t>(size);
  const auto* const from = reinterpret_cast<const std::byte*>(&length);
  bytes.insert(bytes.end(), from, from + sizeof length);
  const auto* const content = static_cast<const std::byte*>(data);
  bytes.insert(bytes.end(), content, content + size);
}

Bytes packed(const Message& answer) {
  Bytes bytes;
  put_part(bytes, answer.payload.data(), answer.payload.size());
  for (const auto& [name, value] : answer.properties) {
    put_part(bytes, name.data(), name.size());
    put_part(bytes, value.data(), value.size());
  }
  return bytes;
}

bool take_part(std::span<const std::byte>& bytes, std::span<const std::byte>& part) {
  std::uint32_t length = 0;
  if (bytes.size() < sizeof length) return false;
  std::memcpy(&length, bytes.data(), sizeof length);
  bytes = bytes.subspan(sizeof length);
  if (bytes.size() < length) return false;
  part = bytes.first(length);
  bytes = bytes.subspan(length);
  return true;
}

std::string part_text(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

Message answer_of(std::span<const std::byte> bytes) {
  Message answer;
  std::span<const std::byte> one;
  std::span<const std::byte> two;
  if (take_part(bytes, one)) answer.payload.assign(one.begin(), one.end());
  while (take_part(bytes, one) && take_part(bytes, two))
    answer.properties.emplace_back(part_text(one), part_text(two));
  return answer;
}

}  // namespace

CallWindow::CallWindow(const std::string& folder, const Limits& limits, std::int64_t now)
    : limits_(limits),
      log_(folder, {.bytes = limits.bytes * 2, .age = limits.age, .file_bytes = limits.bytes / 8}) {
  std::uint64_t next = 1;
  while (const auto record = log_.read_from(next)) {
    restore(*record, now);
    next = record->number + 1;
  }
  forget_old(now);
}

// Its age begins anew: the clock may have been set since.
void CallWindow::restore(const Record& record, std::int64_t now) {
  const auto known = calls_.find(record.label);
  if (record.kind == begun && known == calls_.end()) {
    remember(record.label, {State::interrupted, now, {}});
  } else if (record.kind == ended && known != calls_.end()) {
    known->second.state = State::answered;
    known->second.answer = answer_of(record.body);
    bytes_ += record.body.size();
  }
}

void CallWindow::remember(const std::string& id, Call call) {
  calls_[id] = std::move(call);
  order_.push_back(id);
  while (order_.size() > limits_.count || bytes_ > limits_.bytes) forget_first();
}

void CallWindow::forget_first() {
  const auto oldest = calls_.find(order_.front());
  if (oldest->second.state == State::answered) bytes_ -= packed(oldest->second.answer).size();
  calls_.erase(oldest);
  order_.pop_front();
}

CallWindow::State CallWindow::state(const std::string& id) const {
  const auto known = calls_.find(id);
  return known == calls_.end() ? State::unknown : known->second.state;
}

void CallWindow::begin(const std::string& id, std::int64_t now) {
  log_.append(begun, id, {}, now);
  remember(id, {State::running, now, {}});
}

void CallWindow::end(const std::string& id, const Message& answer, std::int64_t now) {
  const auto known = calls_.find(id);
  if (known == calls_.end()) return;
  const Bytes bytes = packed(answer);
  known->second.state = State::answered;
  known->second.answer.payload = answer.payload;
  known->second.answer.properties = answer.properties;
  bytes_ += bytes.size();
  try {
    log_.append(ended, id, bytes, now);
  } catch (const Error&) {
    // After a restart it is as one that was interrupted: it is not executed again.
    return;
  }
}

const Message& CallWindow::answer(const std::string& id) const { return calls_.at(id).answer; }

void CallWindow::clock_was_set(std::int64_t by) {
  for (auto& [id, call] : calls_) call.begun += by;
  log_.clock_was_set(by);
}

void CallWindow::forget_old(std::int64_t now) {
  const auto oldest = now - std::chrono::nanoseconds(limits_.age).count();
  while (!order_.empty() && calls_.at(order_.front()).begun < oldest) forget_first();
  log_.discard_old(now);
}

}  // namespace rr::gateway
