// SPDX-License-Identifier: Apache-2.0
#include "rr/client.hpp"

#include <utility>

#include "rr/error.hpp"
#include "rr/stub_beside.hpp"
#include "runtime/cpp/src/client/session.hpp"

namespace rr {

ClientBase::ClientBase(std::shared_ptr<Session> session) : session_(std::move(session)) {}

ClientBase& ClientBase::operator=(ClientBase&& other) noexcept {
  if (this != &other) {
    close();
    session_ = std::move(other.session_);
  }
  return *this;
}

ClientBase::~ClientBase() { close(); }

void ClientBase::close() {
  if (session_) session_->close();
}

bool ClientBase::is_open() const { return session_ && session_->is_open(); }
void ClientBase::cancel_calls() {
  if (session_) session_->cancel_calls();
}
const std::map<std::string, VarValue>& ClientBase::attributes() const {
  return session_->attributes();
}
const NodeId& ClientBase::remote_node() const { return session_->remote_node(); }
const std::string& ClientBase::remote_name() const { return session_->remote_name(); }
const std::string& ClientBase::object_type() const { return session_->object_type(); }
std::map<std::string, std::string> ClientBase::definitions() const {
  return session_->definitions();
}
void ClientBase::authenticate(const std::string& username,
                              const std::map<std::string, VarValue>& credentials,
                              const CallOptions& options) {
  const CallOptionsScope scope(options);
  session_->authenticate(username, credentials, std::chrono::milliseconds(0));
}
void ClientBase::logout(const CallOptions& options) {
  const CallOptionsScope scope(options);
  session_->log_out();
}
std::string ClientBase::find_object_type(const std::string& path,
                                         const CallOptions& options) const {
  const CallOptionsScope scope(options);
  return session_->ask_object_type(path, std::chrono::milliseconds(0));
}
std::map<std::string, VarValue> ClientBase::fetch_attributes(const CallOptions& options) const {
  const CallOptionsScope scope(options);
  return session_->ask_attributes();
}

std::shared_ptr<Stub> make_stub_beside(const Stub& stub, const ObjectType& type) {
  const std::shared_ptr<Session>& session = stub.rr_session();
  if (!session) throw Error(ErrorCode::invalid_operation, "the stub has no session");
  return session->make_stub_beside(stub, type);
}

void refuse_stub() {
  throw Error(ErrorCode::service_error, "Invalid object type: the object has another class");
}

}  // namespace rr
