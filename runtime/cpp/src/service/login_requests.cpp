// SPDX-License-Identifier: Apache-2.0
// How a client logs in (07, sections 5 and 6): its name and credentials are checked on a thread of
// the logins, and the message that has brought them is handled when the outcome is there. Meanwhile
// its other requests wait.
#include <utility>

#include "rr/error.hpp"
#include "rr/type.hpp"
#include "rr/varvalue.hpp"
#include "runtime/cpp/src/endpoint/requests.hpp"
#include "runtime/cpp/src/endpoint/values.hpp"
#include "runtime/cpp/src/service/decoded_memory.hpp"
#include "runtime/cpp/src/service/directory.hpp"
#include "runtime/cpp/src/service/server_endpoint.hpp"
#include "runtime/cpp/src/service/service_host.hpp"

namespace rr::service {
namespace {

// What was refused is read by the client before the connection ends.
constexpr channel::Milliseconds refusal_delay{100};

bool may_log_in(const Entry& entry) {
  return entry.type == EntryType::connect_client_combined ||
         (entry.type == EntryType::client_session_op_req && entry.member == "AuthenticateUser");
}

}  // namespace

// True when the message is to be handled later: it has been put off.
[[gnu::hot]] bool ServerEndpoint::must_wait_for_login(const Message& message, const Entry& first,
                                                      const MemoryRef& owner) {
  if (message.entry_count == 1 && !may_log_in(first)) return false;
  if (has_outcome_) return connection_->is_closed();
  if (!unfinished_.empty()) return false;  // it has been looked through before its first request
  if (message.entry_count == 1) return begin_login(message, first, owner);
  EntryReader entries(message);
  for (Entry entry; entries.next(entry);) {
    if (may_log_in(entry) && begin_login(message, entry, owner)) return true;
  }
  return false;
}

// False when there is nothing to be checked: what is wrong then is said when the message is
// handled.
bool ServerEndpoint::begin_login(const Message& message, const Entry& entry,
                                 const MemoryRef& owner) {
  std::shared_ptr<ServiceHost> host;
  std::string name;
  VarStringMap credentials;
  try {
    if (!read_login(message, entry, owner, host, name, credentials)) return false;
  } catch (const std::exception&) {
    return false;
  }
  if (!connection_->suspend()) return false;
  const bool is_new = entry.type == EntryType::connect_client_combined;
  Logins::Request request{.address = connection_->remote_address(),
                          .user = name,
                          .failures = failed_logins_,
                          .check =
                              [host, name, credentials = std::move(credentials),
                               node = is_new ? message.sender_node : client_.node] {
                                return host->users()->authenticate(name, credentials, node);
                              },
                          .on_finished = [connection = connection_] { connection->resume(); }};
  auto login = directory_->logins().add(std::move(request));
  {
    const MutexLock lock(user_mutex_);
    login_ = login;
  }
  login_host_ = std::move(host);
  has_outcome_ = true;  // by the time that the message is handled again
  // It may have gone before it could be told of the attempt.
  if (connection_->is_closed()) directory_->logins().cancel(login);
  return true;
}

// Throws rr::Error for what cannot be read.
bool ServerEndpoint::read_login(const Message& message, const Entry& entry, const MemoryRef& owner,
                                std::shared_ptr<ServiceHost>& host, std::string& name,
                                VarStringMap& credentials) {
  DecodedMemory decoded(*this);
  if (entry.type == EntryType::connect_client_combined) {
    Decoder decoder(message.version, &message.strings);
    decoder.set_budget(decoded);
    std::string_view user;
    Element given;
    host = host_ ? nullptr : directory_->find(entry.service_path);
    if (!host || !host->requires_user() || host->users() == nullptr ||
        !endpoint::find_text(decoder, entry, "username", user) ||
        !find_element(decoder, entry.elements, entry.element_count, "credentials", given)) {
      return false;
    }
    name = user;
    return type_of<VarStringMap>.read(decoder, given, &credentials);
  }
  if (!is_in_session(message) || host_->users() == nullptr) return false;
  host = host_;
  Decoder decoder(message.version, &message.strings, owner, host_->types().get());
  decoder.set_budget(decoded);
  endpoint::read_value(decoder, entry, "username", type_of<std::string>, &name);
  endpoint::read_value(decoder, entry, "credentials", type_of<VarStringMap>, &credentials);
  return true;
}

// An outcome is good for its message only.
void ServerEndpoint::forget_login() {
  has_outcome_ = false;
  login_host_.reset();
  const MutexLock lock(user_mutex_);
  login_.reset();
}

// With the outcome that begin_login() has asked for. Throws what the authenticator has thrown.
void ServerEndpoint::log_in(std::string_view name) {
  std::shared_ptr<Logins::Attempt> login;
  {
    const MutexLock lock(user_mutex_);
    login = std::exchange(login_, nullptr);
  }
  // A message brings one login; what else it brings has not been checked.
  if (!login || login->request.user != name || login_host_ != host_) {
    throw Error(ErrorCode::authentication_error, "this is not the login that was checked");
  }
  if (!login->user) {
    audit_.refused_login(name, login->refusal);
    const unsigned most = directory_->core()->options().login.max_failures;
    // One for which there was no room says nothing of the client.
    const bool was_checked = login->request.check == nullptr;
    if (was_checked && ++failed_logins_ == most) connection_->close_after(refusal_delay);
    std::rethrow_exception(login->refusal);
  }
  become(login->user);
}

}  // namespace rr::service
