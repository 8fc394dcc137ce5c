// SPDX-License-Identifier: Apache-2.0
// What is asked of a service.
#include <utility>

#include "gateway/elements.hpp"
#include "gateway/properties.hpp"
#include "gateway/service_exporter.hpp"
#include "rr/error.hpp"

namespace rr::gateway {
namespace {

constexpr std::size_t longest_id = 128;

/// Any of these will do.
unsigned access_of(Verb verb) {
  if (verb == Verb::connect) return reading | writing;
  if (verb == Verb::lock) return locking;
  if (verb == Verb::call || verb == Verb::next) return calling;
  return verb == Verb::set || verb == Verb::poke || verb == Verb::send ? writing : reading;
}

/// Whether asking twice makes a difference.
bool has_effect(Verb verb) {
  return verb == Verb::set || verb == Verb::call || verb == Verb::next || verb == Verb::send ||
         verb == Verb::lock;
}

/// `id` of a user in the window.
std::string id_of(const RequestTopic& request, const Message& message) {
  return request.user + " " +
         std::string(reinterpret_cast<const char*>(message.correlation.data()),
                     message.correlation.size());
}

}  // namespace

bool ServiceExporter::take(const Message& message) {
  const auto request = parse_request_topic(address_, message.topic);
  if (!request) return false;
  if (request->verb == Verb::stream || request->verb == Verb::confirm) {
    handle_stream(*request, message);
  } else {
    handle(*request, message);
  }
  return true;
}

// Whether there is a rule for the object at a path is for its members to say.
void ServiceExporter::handle(const RequestTopic& request, const Message& message) {
  if (message.correlation.empty() || message.correlation.size() > longest_id) return;
  if (request.verb == Verb::session) {
    handle_session(request, message);
    return;
  }
  const bool is_allowed =
      request.verb == Verb::object ||
      find_rule(options_, request.user, request.path, request.member, access_of(request.verb));
  if (!is_allowed) {
    answer_error(
        request, message,
        error_pointer(ErrorCode::permission_denied,
                      "the export file of the robot does not allow " + request.user + " to " +
                          std::string(verb_name(request.verb)) + " `" +
                          (request.verb == Verb::lock ? request.path : request.member) + "`"),
        "gateway");
  } else if (has_effect(request.verb)) {
    execute_once(request, message);
  } else if (is_reachable(request, message)) {
    execute(request, message);
  }
}

// While the first attempt to connect goes on there is no answer: the request comes again.
bool ServiceExporter::is_reachable(const RequestTopic& request, const Message& message) {
  if (const auto name = message.find("session")) {
    if (sessions_.find(request.user, *name)) return true;
    answer_ended(request, message);
    return false;
  }
  std::optional<Error> reason;
  if (session_of(request.user)->is_connected(reason)) return true;
  if (reason) {
    const bool is_login = reason->code() == ErrorCode::authentication_error;
    answer_error(
        request, message,
        error_pointer(is_login ? reason->code() : ErrorCode::connection_error,
                      "the gateway is not connected to the robot's service: " + reason->message()),
        "robot");
  }
  return false;
}

void ServiceExporter::handle_stream(const RequestTopic& request, const Message& message) {
  if (find_rule(options_, "", request.path, request.member, reading) == nullptr) return;
  const auto reader = message.find("reader");
  StreamExport* const found = stream(request.path, request.member, false);
  if (found == nullptr || !reader || !is_level_name(*reader)) return;
  if (request.verb == Verb::confirm) {
    const auto epoch = number_property(message, "stream", 16);
    const auto number = number_property(message, "number");
    if (epoch && number) found->writer->confirm(std::string(*reader), *epoch, *number);
  } else if (is_reply_topic(message.response_topic, request.user)) {
    const auto from = number_property(message, "from");
    const auto count = number_property(message, "count");
    if (from && count) {
      found->writer->ask(std::string(*reader), *from, *count, message.response_topic);
    }
    shared_.pump();
  }
}

void ServiceExporter::execute_once(const RequestTopic& request, const Message& message) {
  const std::string id = id_of(request, message);
  switch (window_.state(id)) {
    case CallWindow::State::running:
      return;
    case CallWindow::State::answered:
      answer(request, message, window_.answer(id));
      return;
    case CallWindow::State::interrupted:
      answer_error(
          request, message,
          error_pointer(ErrorCode::operation_aborted,
                        "the robot's gateway ended while this ran: it may have been executed"),
          "gateway");
      return;
    case CallWindow::State::unknown:
      break;
  }
  if (!is_reachable(request, message)) return;
  try {
    window_.begin(id, wall_time());
  } catch (const Error&) {
    answer_error(request, message, std::current_exception(), "gateway");
    return;
  }
  execute(request, message);
}

std::shared_ptr<RobotSession> ServiceExporter::session_of(const std::string& user) {
  if (!options_.users.contains({user})) return session_;
  auto& session = user_sessions_[user];
  if (!session) session = RobotSession::open(*node_, options_.url, login_of(options_, {user}), {});
  return session;
}

void ServiceExporter::answer(const RequestTopic& request, const Message& message, Message result) {
  if (has_effect(request.verb)) window_.end(id_of(request, message), result, wall_time());
  // Whoever asks must not make this gateway publish elsewhere.
  if (!is_reply_topic(message.response_topic, request.user)) return;
  result.topic = message.response_topic;
  result.correlation = message.correlation;
  shared_.outbox.add(std::move(result));
  shared_.pump();
}

void ServiceExporter::answer_error(const RequestTopic& request, const Message& message,
                                   const std::exception_ptr& error, std::string_view at) {
  Message result;
  set_error(result, error, at);
  answer(request, message, std::move(result));
}

}  // namespace rr::gateway
