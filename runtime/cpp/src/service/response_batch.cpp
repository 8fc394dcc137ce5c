// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/service/response_batch.hpp"

#include <algorithm>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/scratch.hpp"
#include "runtime/cpp/src/endpoint/requests.hpp"
#include "runtime/cpp/src/service/server_endpoint.hpp"

namespace rr::service {
namespace {

// Header of a message of several entries, with what senders leave free.
constexpr std::size_t header_room = 512;
// Small answers are copied into the message in which they leave, which nobody is charged for.
constexpr std::size_t most_copied = std::size_t{256} * 1024;
// Making a message of so many answers keeps others waiting for long enough.
constexpr std::size_t most_gathered = 256;
// What an answer that waits takes besides its bytes, about.
constexpr std::size_t answer_cost = 256;

Error too_much() {
  return {ErrorCode::out_of_system_resource,
          "the answers that wait for this client are larger than they may be"};
}

}  // namespace

ResponseBatch::ResponseBatch(const std::shared_ptr<ServerEndpoint>& endpoint, std::size_t count)
    : endpoint_(endpoint),
      version_(endpoint->connection().version()),
      message_room_(
          std::max<std::size_t>(endpoint->core()->options().limits.message_size, 2 * header_room) -
          header_room),
      charge_(endpoint->connection().account()),
      settled_(count),
      missing_(count) {}

ResponseBatch::Answer ResponseBatch::kept(const Entry& request, Writer& answer) {
  Answer result{.size = answer.size(),
                .request_type = request.type,
                .request_id = request.request_id,
                .path = std::string(request.service_path),
                .member = std::string(request.member)};
  std::size_t copied = 0;
  const std::span<const Piece> pieces = answer.pieces();
  for (const Piece& piece : pieces) {
    if (!answer.owner(piece)) copied += piece.size;
  }
  result.copied = copied;
  const Allocation memory = allocate(copied);
  std::byte* room = memory.bytes;
  for (const Piece& piece : pieces) {
    if (MemoryRef owner = answer.owner(piece)) {
      result.parts.push_back({std::move(owner), {piece.data, piece.size}});
      continue;
    }
    std::copy(piece.data, piece.data + piece.size, room);
    result.parts.push_back({memory.owner, {room, piece.size}});
    room += piece.size;
  }
  return result;
}

void ResponseBatch::put(std::size_t place, const Entry& request, Writer& answer, bool is_late) {
  const auto endpoint = endpoint_.lock();
  if (!endpoint) return;
  endpoint->connection().check_size(answer);
  const std::size_t cost =
      answer_cost + answer.size() + request.service_path.size() + request.member.size();
  bool is_drawn = false;
  {
    const MutexLock lock(mutex_);
    is_drawn = charge_.add(cost);
  }
  Answer result = kept(request, answer);  // the writer may be the thread's, which flush() uses
  result.cost = cost;
  const MutexLock lock(mutex_);
  if (!is_drawn) {
    must_flush_ = true;  // what leaves may make room
    flush(is_late);
    if (!charge_.add(cost)) throw too_much();
  }
  waiting_.insert_or_assign(place, std::move(result));
  settle(place);
  flush(is_late);
}

void ResponseBatch::put_nothing(std::size_t place) {
  const MutexLock lock(mutex_);
  settle(place);
  flush(false);
}

void ResponseBatch::settle(std::size_t place) {
  settled_[place] = true;
  --missing_;
  auto answer = waiting_.lower_bound(ready_);
  for (; ready_ != settled_.size() && settled_[ready_]; ++ready_) {
    if (answer == waiting_.end() || answer->first != ready_) continue;
    ready_size_ += answer->second.size;
    ready_copied_ += answer->second.copied;
    ++ready_count_;
    ++answer;
  }
}

// The next answers, if they fill a message or no more will come.
ResponseBatch::Answers ResponseBatch::take_ready() {
  Answers answers;
  const bool is_full =
      ready_size_ > message_room_ || ready_copied_ > most_copied || ready_count_ >= most_gathered;
  if (missing_ != 0 && !must_flush_ && !is_full) return answers;
  std::size_t size = 0;
  std::size_t copied = 0;
  while (!waiting_.empty() && waiting_.begin()->first < ready_) {
    const auto first = waiting_.begin();
    size += first->second.size;
    copied += first->second.copied;
    const bool fits = size <= message_room_ && copied <= most_copied;
    if (!answers.empty() && (!fits || answers.size() == most_gathered)) return answers;
    --ready_count_;
    ready_size_ -= first->second.size;
    ready_copied_ -= first->second.copied;
    answers.push_back(std::move(first->second));
    waiting_.erase(first);
  }
  must_flush_ = false;
  return answers;
}

// One thread at a time sends, so that batches leave in their order; it sends what comes meanwhile.
void ResponseBatch::flush(bool is_late) {
  if (std::exchange(is_sending_, true)) return;
  for (Answers answers = take_ready(); !answers.empty(); answers = take_ready()) {
    std::size_t cost = 0;
    {
      const MutexUnlock unlock(mutex_);
      if (const auto endpoint = endpoint_.lock(); endpoint && !endpoint->connection().is_closed()) {
        send(*endpoint, answers, is_late);
      }
      for (const Answer& answer : answers) cost += answer.cost;
      answers.clear();
    }
    charge_.reduce(cost);  // not before: the connection has drawn for its copy
  }
  is_sending_ = false;
}

void ResponseBatch::send(ServerEndpoint& endpoint, std::span<const Answer> answers, bool is_late) {
  Writer& writer = channel::thread_writer();
  writer.reset(version_);
  for (auto answer = answers.rbegin(); answer != answers.rend(); ++answer) {
    for (auto part = answer->parts.rbegin(); part != answer->parts.rend(); ++part) {
      writer.prepend_array(part->bytes, part->owner);
    }
  }
  ErrorCode failure = ErrorCode::none;
  try {
    // Several entries have no type of their own; one that is left alone is a session's.
    endpoint.send_answer(writer, static_cast<std::uint32_t>(answers.size()),
                         EntryType::function_call_res,
                         is_late ? ServerEndpoint::Way::send : ServerEndpoint::Way::reply);
    return;
  } catch (const Error& error) {
    failure = error.code();
  }
  // Each fits alone. Otherwise the client is gone, or takes too little of what it asks for.
  const bool is_too_much = failure == ErrorCode::out_of_system_resource;
  if (failure != ErrorCode::protocol_error && !is_too_much) return;
  if (answers.size() > 1) {
    send(endpoint, answers.first(answers.size() / 2), is_late);
    send(endpoint, answers.subspan(answers.size() / 2), is_late);
  } else if (is_too_much) {
    send_errors(endpoint, answers.front(), is_late);
  }
}

void ResponseBatch::send_errors(ServerEndpoint& endpoint, const Answer& answer, bool is_late) {
  Entry request;
  request.type = answer.request_type;
  request.request_id = answer.request_id;
  request.service_path = answer.path;
  request.member = answer.member;
  Writer& writer = channel::thread_writer();
  writer.reset(version_);
  endpoint::write_error_answer(writer, request, too_much());
  try {
    endpoint.send_answer(writer, 1, EntryType::function_call_res,
                         is_late ? ServerEndpoint::Way::send : ServerEndpoint::Way::reply);
  } catch (const Error& failure) {
    endpoint.connection().close(failure);
  }
}

}  // namespace rr::service
