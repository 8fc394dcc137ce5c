// SPDX-License-Identifier: Apache-2.0
// Functions of clients here that the robot calls.
#include <algorithm>
#include <utility>

#include "gateway/elements.hpp"
#include "gateway/far_service.hpp"
#include "gateway/properties.hpp"
#include "rr/error.hpp"

namespace rr::gateway {
namespace {

/// Calls are repeated for some seconds: these are remembered for longer.
constexpr std::size_t most_remembered = 4'096;

}  // namespace

/// Whether any object has some: the robot tells clients from one another by their sessions.
bool FarService::has_callbacks() const {
  const auto is_callback = [](const dynamic::MemberDescription& member) {
    return member.kind == MemberKind::callback;
  };
  for (const std::string& service : definitions_->services()) {
    for (const std::string& object : definitions_->declared(service).objects) {
      const std::string name =
          object.find('.') == std::string::npos ? service + "." + object : object;
      if (std::ranges::any_of(definitions_->members(name), is_callback)) return true;
    }
  }
  return false;
}

// A call that comes again is answered by the answer to the first, which is repeated as well.
bool FarService::take_callback(const Message& message, std::string_view id) {
  const std::string session(message.find("session").value_or(""));
  const auto client = sessions_->client_of(session);
  if (!client) return false;  // another service's, or of a client that has gone
  if (!called_.emplace(id).second) return true;
  called_order_.emplace_back(id);
  if (called_order_.size() > most_remembered) {
    called_.erase(called_order_.front());
    called_order_.pop_front();
  }
  const auto answer = [calls = shared_.calls, address = address_, session, id = std::string(id)](
                          const std::exception_ptr& error, Message result) {
    if (error) set_error(result, error, "client");
    FarRequest request{address, Verb::session, "", "", std::move(result.payload)};
    request.properties = std::move(result.properties);
    request.properties.insert(request.properties.end(),
                              {{"op", "answer"}, {"session", session}, {"callback", id}});
    calls->request(std::move(request), [](const std::exception_ptr&, const Message&) {});
  };
  try {
    call_back(message, *client, answer);
  } catch (...) {
    answer(std::current_exception(), {});
  }
  return true;
}

void FarService::call_back(const Message& message, std::uint32_t client,
                           const FarCalls::Done& done) {
  const auto found = objects_.find(std::string(message.find("path").value_or("")));
  const dynamic::ServedObject object =
      found == objects_.end() ? dynamic::ServedObject() : found->second.lock();
  if (!object) throw Error(ErrorCode::object_not_found, "the client does not use this object");
  const auto member = object.member(message.find("member").value_or(""));
  const auto arguments = decode_arguments(*definitions_, member.parameters, message.payload);
  object.async_call_back(
      member.name, client, arguments,
      [done, type = member.type](const std::exception_ptr& error, const dynamic::Value& value) {
        if (error) {
          done(error, {});
          return;
        }
        try {
          done(nullptr, {"", encode_element(type, value)});
        } catch (...) {
          done(std::current_exception(), {});
        }
      });
}

}  // namespace rr::gateway
