// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/service/request.hpp"

#include <utility>

#include "rr/error.hpp"
#include "rr/type.hpp"
#include "runtime/cpp/src/endpoint/errors.hpp"
#include "runtime/cpp/src/endpoint/values.hpp"

namespace rr {

bool Request::is_set() const { return source_->is_set; }

void Request::read_value(void* value) const {
  const service::Question& question = source_->question;
  Decoder decoder = question.decoder(&source_->types);
  endpoint::read_value(decoder, question.entry, "value", *source_->member.type, value);
}

[[gnu::hot]] void Request::read_arguments(void* const* values) const {
  const service::Question& question = source_->question;
  Decoder decoder = question.decoder(&source_->types);
  endpoint::read_values(decoder, question.entry, source_->member.parameters, values);
  source_->made.expect();
}

[[gnu::hot]] void Request::answer(const void* value) {
  Source& source = *source_;
  if (source.state != Source::State::open) {
    throw Error(ErrorCode::invalid_operation, "the request has been answered already");
  }
  const bool is_call = source.member.kind == MemberKind::function;
  if (source.member.generator != GeneratorForm::none) {
    throw Error(ErrorCode::internal_error, "the handler has given no generator");
  }
  if (source.is_set) {
    source.endpoint.answer_empty(source.question);
  } else if (source.member.type != nullptr && value != nullptr) {
    source.endpoint.answer_result(source.question, source.member, source.made, value);
  } else if (is_call && source.member.type == nullptr) {
    const std::int32_t nothing = 0;  // what void looks like (07, section 8)
    source.endpoint.answer_value(source.question, "return", type_of<std::int32_t>, &nothing);
  } else {
    throw Error(ErrorCode::internal_error, "the handler has given no value");
  }
  source.state = Source::State::answered;
}

void Request::Source::complete() {
  if (state == State::open) Request(*this).answer(nullptr);
}

ReplyHandle Request::defer() {
  Source& source = *source_;
  if (source.state != Source::State::open) {
    throw Error(ErrorCode::invalid_operation, "the request has been answered already");
  }
  if (source.member.generator != GeneratorForm::none) {
    throw Error(ErrorCode::invalid_operation, "a generator cannot be given later");
  }
  const Entry& entry = source.question.entry;
  service::ServerEndpoint& endpoint = source.endpoint;
  const std::uint64_t number = endpoint.owed_answers()->add(
      endpoint.shared_from_this(),
      {entry.type, std::string(entry.service_path), std::string(entry.member), entry.request_id,
       &source.member, source.question.batch, source.question.place,
       service::admission_of(source.question), source.question.begun},
      endpoint.late_answer_limit());
  auto state =
      std::make_unique<ReplyHandle::State>(ReplyHandle::State{endpoint.owed_answers(), number});
  source.made.end();  // it may be answered much later
  source.question.is_put_off = true;
  source.state = Source::State::deferred;
  return ReplyHandle(std::move(state));
}

ReplyHandle::ReplyHandle(std::unique_ptr<State> state) : state_(std::move(state)) {}
ReplyHandle::ReplyHandle(ReplyHandle&&) noexcept = default;

ReplyHandle& ReplyHandle::operator=(ReplyHandle&& other) noexcept {
  std::swap(state_, other.state_);
  return *this;
}

ReplyHandle::~ReplyHandle() {
  if (!state_) return;
  if (const auto taken = state_->owed->take(state_->number)) {
    taken->endpoint->answer_late(
        taken->answer, Error(ErrorCode::operation_aborted, "the request was dropped unanswered"));
  }
}

void ReplyHandle::fail(std::exception_ptr error) {
  const auto state = std::exchange(state_, nullptr);
  if (!state) throw Error(ErrorCode::invalid_operation, "the request has been answered already");
  if (const auto taken = state->owed->take(state->number)) {
    taken->endpoint->answer_late(taken->answer, endpoint::describe(error));
  }
}

void ReplyHandle::succeed(const void* result) {
  const auto state = std::exchange(state_, nullptr);
  if (!state) throw Error(ErrorCode::invalid_operation, "the request has been answered already");
  if (const auto taken = state->owed->take(state->number)) {
    taken->endpoint->answer_late(taken->answer, result);
  }
}

}  // namespace rr
