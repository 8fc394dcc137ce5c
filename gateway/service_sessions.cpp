// SPDX-License-Identifier: Apache-2.0
// Sessions of far clients at the robot, and what belongs to them: locks and callbacks.
#include <utility>
#include <vector>

#include "gateway/elements.hpp"
#include "gateway/far_locks.hpp"
#include "gateway/properties.hpp"
#include "gateway/service_exporter.hpp"
#include "rr/error.hpp"

namespace rr::gateway {
namespace {

/// Names of sessions in one message: as many as a robot's gateway has, with their commas.
constexpr std::size_t longest_names = std::size_t{1'024} * 65;

}  // namespace

void ServiceExporter::handle_session(const RequestTopic& request, const Message& message) {
  const auto operation = message.find("op").value_or("");
  const std::string name(message.find("session").value_or(""));
  if (!is_user(options_, request.user)) {
    answer_error(request, message,
                 error_pointer(ErrorCode::permission_denied,
                               "the export file of the robot has no rule for " + request.user),
                 "gateway");
  } else if (operation == "open") {
    open_session(request, message);
  } else if (operation == "end") {
    sessions_.end(request.user, name);
    answer(request, message, {});
  } else if (operation == "alive" && message.payload.size() <= longest_names) {
    answer(request, message,
           {"", {}, {{"ended", sessions_.still_used(request.user, text_of(message.payload))}}});
  } else if (operation == "answer") {
    callbacks_->take(request.user, message);
    answer(request, message, {});
  } else {
    answer_error(request, message,
                 error_pointer(ErrorCode::invalid_argument, "this is no request about a session"),
                 "gateway");
  }
}

// A request that comes again while the session begins is answered by the same answer.
void ServiceExporter::open_session(const RequestTopic& request, const Message& message) {
  const auto opened = [weak = Weak(shared_from_this()), request,
                       message](const std::exception_ptr& error) {
    const Self self = weak.lock();
    if (!self) return;
    if (error) {
      self->answer_error(request, message, error, "robot");
    } else {
      self->answer(request, message, {});
    }
  };
  try {
    // Calls of the client's functions go there.
    if (!is_reply_topic(message.response_topic, request.user)) return;
    const BrokerUser user{request.user, std::string(message.find("client-user").value_or(""))};
    sessions_.open(*node_, options_.url, login_of(options_, user), request.user,
                   std::string(message.find("session").value_or("")), message.response_topic,
                   opened);
  } catch (const Error&) {
    answer_error(request, message, std::current_exception(), "gateway");
  }
}

// If this is lost, the next message about sessions in use is answered by it.
void ServiceExporter::tell_ended(const std::string& session, const std::string& reply_topic) {
  shared_.outbox.add({reply_topic, {}, {{"ended", session}}});
  shared_.pump();
}

void ServiceExporter::answer_ended(const RequestTopic& request, const Message& message) {
  Message result;
  set_error(result,
            error_pointer(ErrorCode::connection_error, "the session at the robot has ended"),
            "gateway");
  result.properties.emplace_back("session-ended", "1");
  answer(request, message, std::move(result));
}

// The functions of a far client are not known here: the robot's calls say whether there is one.
void ServiceExporter::serve_callbacks(const RequestTopic& request, const Message& message,
                                      ExportedSession& session, const dynamic::Object& object) {
  std::vector<dynamic::MemberDescription> exported = object.members();
  std::erase_if(exported, [&](const dynamic::MemberDescription& member) {
    return member.kind != MemberKind::callback ||
           find_rule(options_, request.user, request.path, member.name, calling) == nullptr;
  });
  if (exported.empty() || !session.is_new(request.path, object)) return;
  for (const dynamic::MemberDescription& member : exported) {
    Message call{session.reply_topic(), {}};
    call.properties = {{"session", std::string(message.find("session").value_or(""))},
                       {"path", request.path},
                       {"member", member.name}};
    object.callback(member.name)
        .set([callbacks = callbacks_, user = request.user, call, member,
              types = object.types()](const dynamic::List& arguments) {
          Message wanted = call;
          wanted.payload = encode_arguments(member.parameters, arguments);
          return decode_element(types, member.type, callbacks->wait(user, std::move(wanted)));
        });
  }
}

// The session belongs to the worker's thread.
void ServiceExporter::keep_lock(const RequestTopic& request, const Message& message,
                                const std::shared_ptr<ExportedSession>& session,
                                const dynamic::Object& object,
                                const Function<void(std::exception_ptr, Message)>& done) {
  if (!session) {
    throw Error(ErrorCode::invalid_operation, "a lock is for the session of a client");
  }
  LockRequest wanted{lock_operation(message.find("op").value_or("")), request.path, 0};
  const auto timeout = signed_property(message, "timeout");
  if (wanted.operation == LockRequest::Operation::enter_monitor) {
    if (!timeout) throw Error(ErrorCode::invalid_argument, "`timeout` of the request is no number");
    wanted.timeout = std::chrono::milliseconds(*timeout);
  }
  shared_.worker.post(
      [weak = Weak(shared_from_this()), user = request.user, session, wanted, object, done] {
        const auto locked = [weak, user, wanted, done](const std::exception_ptr& error,
                                                       bool is_waiting) {
          const Self self = weak.lock();
          if (self && !error && wanted.operation == LockRequest::Operation::unlock) {
            self->sessions_.released(user, wanted.path);
          }
          done(error, is_waiting ? Message{"", {}, {{"waiting", "1"}}} : Message());
        };
        try {
          session->keep(wanted, object, locked);
        } catch (...) {
          done(std::current_exception(), {});
        }
      });
}

}  // namespace rr::gateway
