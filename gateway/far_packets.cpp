// SPDX-License-Identifier: Apache-2.0
#include "gateway/far_packets.hpp"

#include <utility>

#include "gateway/elements.hpp"
#include "gateway/properties.hpp"
#include "rr/error.hpp"

namespace rr::gateway {

FarPackets::FarPackets(std::shared_ptr<FarSessions> sessions, std::uint32_t client, FarRequest pipe,
                       dynamic::ValueType type, const Limits& limits, Failed failed)
    : sessions_(std::move(sessions)),
      client_(client),
      pipe_([&] {
        pipe.verb = Verb::send;
        pipe.properties = {{"endpoint", random_hex()}};
        return std::move(pipe);
      }()),
      type_(std::move(type)),
      limits_(limits),
      failed_(std::move(failed)) {}

void FarPackets::add(const dynamic::Value& packet) {
  Bytes bytes = encode_element(type_, packet);
  const std::uint64_t login = sessions_->login_of(client_);
  const char* fault = nullptr;
  {
    const MutexLock lock(mutex_);
    if (has_ended_ || has_failed_) return;
    if (!waiting_.empty() && login != login_) fault = "packets of another user wait for the robot";
    login_ = login;
    bytes_ += bytes.size();
    waiting_.push_back(std::move(bytes));
    if (bytes_ > limits_.waiting_bytes) {
      fault = "more packets wait for the robot than the gateway keeps";
    }
    if (fault == nullptr && std::exchange(is_asking_, true)) return;
  }
  if (fault != nullptr) {
    fail(fault);
  } else {
    send_next();
  }
}

void FarPackets::end() {
  {
    const MutexLock lock(mutex_);
    if (std::exchange(has_ended_, true) || has_failed_) return;
    if (std::exchange(is_asking_, true)) return;
  }
  send_next();
}

FarRequest FarPackets::next_request() {
  FarRequest request = pipe_;
  std::size_t count = 0;
  while (!waiting_.empty() && count < limits_.request_packets) {
    const Bytes& packet = waiting_.front();
    if (count > 0 && request.payload.size() + packet.size() > limits_.request_bytes) break;
    request.payload.insert(request.payload.end(), packet.begin(), packet.end());
    bytes_ -= packet.size();
    waiting_.pop_front();
    ++count;
  }
  if (count == 0) {
    is_closing_ = true;
    request.properties.emplace_back("end", "close");
  } else {
    request.properties.emplace_back("count", std::to_string(count));
    request.login = login_;
  }
  return request;
}

void FarPackets::send_next() {
  FarRequest request;
  {
    const MutexLock lock(mutex_);
    if (has_failed_) return;
    request = next_request();
  }
  sessions_->request(client_, std::move(request),
                     [self = shared_from_this()](const std::exception_ptr& error, const Message&) {
                       self->take_answer(error);
                     });
}

void FarPackets::take_answer(const std::exception_ptr& error) {
  if (error) {
    try {
      std::rethrow_exception(error);
    } catch (const std::exception& reason) {
      fail(reason.what());
    }
    return;
  }
  {
    const MutexLock lock(mutex_);
    // The last request of all has neither packets nor successors.
    if (waiting_.empty() && (!has_ended_ || is_closing_)) {
      is_asking_ = false;
      return;
    }
  }
  send_next();
}

void FarPackets::fail(const std::string& reason) {
  {
    const MutexLock lock(mutex_);
    if (std::exchange(has_failed_, true)) return;
    waiting_.clear();
  }
  failed_(reason);
}

}  // namespace rr::gateway
