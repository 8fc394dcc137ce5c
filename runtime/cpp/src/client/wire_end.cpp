// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/client/wire_end.hpp"

#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/client/session.hpp"
#include "runtime/cpp/src/endpoint/wire_values.hpp"

namespace rr::client {
namespace {

// How long the answer to a farewell is waited for.
constexpr std::chrono::milliseconds farewell_time{500};

}  // namespace

ClientWireEnd::ClientWireEnd(std::shared_ptr<Session> session, std::string path,
                             const Member& member)
    : State(session->core(), std::move(path), member), session_(std::move(session)) {
  stream_ = session_->connection().new_stream();
  may_receive_ = (member.access & writeonly) == 0;
}

channel::Connection& ClientWireEnd::connection() const { return session_->connection(); }

void ClientWireEnd::check_sending() const {
  if ((member().access & readonly) != 0) {
    throw Error(ErrorCode::read_only_member, "Read only member");
  }
}

void ClientWireEnd::transmit(Writer& writer, const channel::Newest& newest) {
  session_->send_newest(writer,
                        {.type = EntryType::wire_packet,
                         .service_path = path(),
                         .member = member().name,
                         .metadata = endpoint::unreliable_mark},
                        endpoint::wire_elements, newest);
}

void ClientWireEnd::take_answer(Decoder& decoder, const Entry& entry) {
  notices_before_ = session_->notices().read();
  take_slots(decoder, entry);
}

void ClientWireEnd::close() {
  if (!begin_close()) return;
  try {
    session_->call({EntryType::wire_disconnect_req, path(), member().name}, Incoming{},
                   farewell_time);
  } catch (const Error&) {
    // It ends in any case.
  }
  give_up();
}

void ClientWireEnd::give_up() {
  session_->wires().remove(*this);
  finish_now();
}

}  // namespace rr::client
