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
  Decoder decoder(question.message.version, &question.message.strings, question.owner,
                  &source_->types);
  endpoint::read_value(decoder, question.entry, "value", *source_->member.type, value);
}

void Request::read_arguments(void* const* values) const {
  const service::Question& question = source_->question;
  Decoder decoder(question.message.version, &question.message.strings, question.owner,
                  &source_->types);
  endpoint::read_values(decoder, question.entry, source_->member.parameters, values);
}

void Request::answer(const void* value) {
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
    source.endpoint.answer_value(source.question, is_call ? "return" : "value", *source.member.type,
                                 value);
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
  auto state = std::make_unique<ReplyHandle::State>(ReplyHandle::State{
      source.endpoint.weak_from_this(),
      {entry.type, std::string(entry.service_path), std::string(entry.member), entry.request_id,
       &source.member, source.question.gathering, source.question.place}});
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
  if (const auto endpoint = state_->endpoint.lock()) {
    endpoint->answer_late(
        state_->answer, Error(ErrorCode::operation_aborted, "the request was dropped unanswered"));
  }
}

void ReplyHandle::fail(std::exception_ptr error) {
  const auto state = std::exchange(state_, nullptr);
  if (!state) throw Error(ErrorCode::invalid_operation, "the request has been answered already");
  if (const auto endpoint = state->endpoint.lock()) {
    endpoint->answer_late(state->answer, endpoint::describe(error));
  }
}

void ReplyHandle::succeed(const void* result) {
  const auto state = std::exchange(state_, nullptr);
  if (!state) throw Error(ErrorCode::invalid_operation, "the request has been answered already");
  if (const auto endpoint = state->endpoint.lock()) endpoint->answer_late(state->answer, result);
}

}  // namespace rr
