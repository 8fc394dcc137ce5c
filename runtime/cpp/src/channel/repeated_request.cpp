// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/repeated_request.hpp"

#include <algorithm>
#include <utility>

namespace rr::channel {
namespace {

// Of a record of TLS: a type, two bytes of version, two of the body's size.
constexpr std::size_t record_header = 5;
constexpr std::size_t size_at = 3;

}  // namespace

Bytes RepeatedRequest::kept(std::span<const std::byte> request) {
  if (request.size() > largest) return {};
  return {request.begin(), request.end()};
}

void RepeatedRequest::receive(std::span<const std::byte> wire, Bytes& plain, Bytes& reply) {
  while (!wire.empty() && !request_.empty()) {
    if (is_between_records() && wire.front() == request_[repeated_]) {
      wire = wire.subspan(take_repetition(wire));
    } else if (repeated_ != 0) {  // it was none
      const Bytes begun = std::exchange(request_, {});
      tls_->receive(std::span(begun).first(repeated_), plain, reply);
    } else if (tls_->is_open()) {
      request_.clear();
    } else {
      const std::size_t size = take_record(wire);
      tls_->receive(wire.first(size), plain, reply);
      wire = wire.subspan(size);
    }
  }
  if (!wire.empty()) tls_->receive(wire, plain, reply);
}

// How many bytes belong to one record, which may have begun before.
std::size_t RepeatedRequest::take_record(std::span<const std::byte> wire) {
  std::size_t at = 0;
  for (; at != wire.size() && header_size_ != record_header; ++at, ++header_size_) {
    if (header_size_ >= size_at)
      body_left_ = body_left_ << 8 | std::to_integer<std::size_t>(wire[at]);
  }
  const std::size_t body = std::min(body_left_, wire.size() - at);
  if (header_size_ != record_header) return at;
  body_left_ -= body;
  if (body_left_ == 0) header_size_ = 0;
  return at + body;
}

// How many bytes go on as the request does.
std::size_t RepeatedRequest::take_repetition(std::span<const std::byte> wire) {
  const auto rest = std::span(request_).subspan(repeated_);
  const auto end = std::mismatch(wire.begin(), wire.end(), rest.begin(), rest.end()).first;
  const auto size = static_cast<std::size_t>(end - wire.begin());
  repeated_ += size;
  if (repeated_ == request_.size()) request_.clear();
  return size;
}

}  // namespace rr::channel
