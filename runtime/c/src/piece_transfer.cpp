// SPDX-License-Identifier: Apache-2.0
#include "runtime/c/src/piece_transfer.hpp"

#include <utility>

#include "rr/type.hpp"
#include "runtime/c/src/border.hpp"
#include "runtime/c/src/piece.hpp"
#include "runtime/cpp/src/endpoint/values.hpp"

namespace rr::capi {
namespace {

void check_status(rr_status status) {
  if (status != RR_OK) throw Error(piece_error(status));
}

}  // namespace

Error piece_error(rr_status status) {
  const auto code =
      status > 0 && status <= 0xFFFF ? static_cast<ErrorCode>(status) : ErrorCode::operation_failed;
  return {code, "the program has not transferred the piece"};
}

PieceTransfer::PieceTransfer(const RawStub& stub, const Member& member, Direction direction,
                             Numbers position, Numbers count, std::size_t size,
                             const rr_memory_pieces* given)
    : tables_(stub.shared_tables()),
      session_(stub.rr_session()),
      timeout_(stub.rr_timeout()),
      terms_(CallTerms::of_started_call()),
      direction_(direction),
      functions_(known(given, true)),
      transfer_(stub.rr_path(), member, direction, position, count, nullptr, size,
                session_->memory_transfer_limit()) {
  const bool is_there =
      direction == Direction::read ? functions_.take != nullptr : functions_.give != nullptr;
  if (!is_there) refuse_argument("a function is NULL that is needed");
}

// The piece that is at hand; the program is asked for what it writes.
Outgoing PieceTransfer::request() {
  Outgoing request = transfer_.request();
  if (direction_ == Direction::read) return request;
  rr_piece piece;
  check_status(functions_.give(functions_.context, transfer_.offset(), transfer_.count().data(),
                               transfer_.count().size(), &piece));
  data_ = piece.take();
  parameters_.assign(request.parameters.begin(), request.parameters.end());
  values_.assign(request.values, request.values + parameters_.size());
  parameters_.back().type = &raw_type;
  values_.back() = &data_;
  request.parameters = parameters_;
  request.values = values_.data();
  return request;
}

// The answer has come.
void PieceTransfer::hand_over() {
  if (direction_ == Direction::read) {
    const rr_elements elements = data_.data.elements();
    check_status(functions_.take(functions_.context, transfer_.offset(), transfer_.count().data(),
                                 transfer_.count().size(), &elements));
  }
  transfer_.advance();
}

void PieceTransfer::run() {
  const Session::AnswerReader read = [this](Decoder& decoder, const Message&, const Entry& entry) {
    if (direction_ == Direction::read) {
      endpoint::read_value(decoder, entry, "data", raw_type, &data_);
    }
  };
  while (!transfer_.is_done()) {
    session_->call(transfer_.question(), Incoming{"return", &type_of<std::uint32_t>, &limit_},
                   timeout_);
    if (!transfer_.fits(limit_)) continue;
    session_->call(request(), read, timeout_);
    hand_over();
  }
}

void PieceTransfer::start(std::unique_ptr<Completion> completion) {
  completion_ = std::move(completion);
  go_on();
}

void PieceTransfer::go_on() {
  // As if the thread that began the transfer made all its calls.
  const CallOptionsScope scope(terms_);
  if (is_asking_) {
    session_->start(transfer_.question(), {"return", &type_of<std::uint32_t>, &limit_}, timeout_,
                    shared_from_this());
    return;
  }
  session_->start(
      request(),
      [self = shared_from_this()](Decoder& decoder, const Message&, const Entry& entry) {
        if (self->direction_ != Direction::read) return;
        endpoint::read_value(decoder, entry, "data", raw_type, &self->data_);
      },
      timeout_, shared_from_this());
}

void PieceTransfer::succeed() {
  try {
    if (is_asking_) {
      is_asking_ = !transfer_.fits(limit_);
    } else {
      hand_over();
      is_asking_ = true;
    }
    if (!transfer_.is_done()) {
      go_on();
      return;
    }
  } catch (...) {
    completion_->fail(std::current_exception());
    return;
  }
  completion_->succeed();
}

}  // namespace rr::capi
