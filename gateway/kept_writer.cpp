// SPDX-License-Identifier: Apache-2.0
#include "gateway/kept_writer.hpp"

#include <utility>

#include "gateway/kept_stream.hpp"
#include "gateway/nats_subjects.hpp"

namespace rr::gateway {
namespace {

std::string token_in(const std::string& inbox, const std::string& reply) {
  return reply.substr(inbox.size() + 1);
}

}  // namespace

NatsMessage KeptWriter::add(NatsMessage message, Clock::time_point now) {
  const std::string token = std::to_string(++last_token_);
  message.reply = inbox_ + "." + token;
  Waiting& waiting = waiting_[message.subject];
  if (!waiting.message.reply.empty()) subjects_.erase(token_in(inbox_, waiting.message.reply));
  subjects_[token] = message.subject;
  waiting = {std::move(message), now};
  return waiting.message;
}

KeptWriter::Outcome KeptWriter::take(std::string_view token, const NatsMessage& answer) {
  const auto known = subjects_.find(token);
  // Of an older message of the same subject.
  if (known == subjects_.end()) return {};
  if (answer.is_unanswered) return {.wants_stream = true};
  const auto result = read_answer(answer.payload);
  if (!result) return {};
  if (result->code != 0) {
    const auto subject = subject_of_kept(known->second);
    return {.refusal =
                Refusal{subject ? topic_of(*subject).value_or("") : "", result->description}};
  }
  waiting_.erase(known->second);
  subjects_.erase(known);
  return {};
}

void KeptWriter::drop(const std::string& subject) {
  const auto waiting = waiting_.find(subject);
  if (waiting == waiting_.end()) return;
  subjects_.erase(token_in(inbox_, waiting->second.message.reply));
  waiting_.erase(waiting);
}

std::vector<NatsMessage> KeptWriter::late(Clock::time_point now,
                                          std::chrono::milliseconds patience) {
  std::vector<NatsMessage> messages;
  for (auto& [subject, waiting] : waiting_) {
    if (now - waiting.sent < patience) continue;
    waiting.sent = now;
    messages.push_back(waiting.message);
  }
  return messages;
}

}  // namespace rr::gateway
