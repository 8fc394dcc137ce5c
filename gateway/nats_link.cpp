// SPDX-License-Identifier: Apache-2.0
#include "gateway/nats_link.hpp"

#include <nats/nats.h>

#include <cstdint>
#include <cstdlib>
#include <utility>

#include "gateway/nats_subjects.hpp"
#include "rr/error.hpp"

namespace rr::gateway {
namespace {

constexpr std::int64_t connect_time_ms = 3'000;
constexpr std::int64_t write_time_ms = 5'000;
constexpr std::int64_t closing_time_ms = 10'000;
constexpr int host_mismatch = 62;     // X509_V_ERR_HOSTNAME_MISMATCH
constexpr int address_mismatch = 64;  // X509_V_ERR_IP_ADDRESS_MISMATCH

struct OptionsDestroyed {
  void operator()(natsOptions* options) const { natsOptions_Destroy(options); }
};
using LibraryOptions = std::unique_ptr<natsOptions, OptionsDestroyed>;

struct MessageDestroyed {
  void operator()(natsMsg* message) const { natsMsg_Destroy(message); }
};
using LibraryMessage = std::unique_ptr<natsMsg, MessageDestroyed>;

/// The text of the calling thread's last error, without the place in the library's sources.
std::string nats_error(natsStatus status) {
  const char* const last = nats_GetLastError(nullptr);
  std::string text = last != nullptr && *last != '\0' ? last : natsStatus_GetText(status);
  const std::size_t end = text.find("): ");
  if (text.starts_with('(') && end != std::string::npos) text.erase(0, end + 3);
  return text;
}

void check_nats(natsStatus status) {
  if (status == NATS_OK) return;
  throw Error(ErrorCode::connection_error, nats_error(status));
}

/// What the library says of a handshake: `SSL handshake error: 62:hostname mismatch:expected=...`.
std::string tls_trouble(const std::string& text, const BrokerOptions& broker,
                        const BrokerPlace& place) {
  if (!place.is_encrypted) return "the broker asks for TLS: its URL begins with tls://";
  const std::size_t number = text.find(": ");
  if (number == std::string::npos) return text;
  char* end = nullptr;
  const long code = std::strtol(text.c_str() + number + 2, &end, 10);
  if (code == 0 || *end != ':') return "TLS to the broker fails: " + text.substr(number + 2);
  if (code == host_mismatch || code == address_mismatch) {
    return "the broker's certificate is not for `" + place.host + "`";
  }
  const std::string rest = end + 1;
  return "the broker's certificate is refused: " + rest.substr(0, rest.find(':')) +
         " (authorities: " + (broker.authority.empty() ? "of the system" : broker.authority) + ")";
}

std::string refusal_of(const std::string& text, const BrokerOptions& broker) {
  if (!broker.credentials.empty()) {
    return "the broker refuses the credentials of " + broker.credentials + ": " + text;
  }
  if (!broker.token.empty()) return "the broker refuses the token: " + text;
  if (broker.user.empty()) return "the broker refuses a connection without a user: " + text;
  return "the broker refuses user `" + broker.user + "` or the password: " + text;
}

/// Why it could not be connected, for people.
std::string connect_reason(natsStatus status, const BrokerOptions& broker,
                           const BrokerPlace& place) {
  const std::string text = nats_error(status);
  switch (status) {
    case NATS_CONNECTION_AUTH_FAILED:
    case NATS_NOT_PERMITTED:
      return refusal_of(text, broker);
    case NATS_SSL_ERROR:
      return tls_trouble(text, broker, place);
    case NATS_SECURE_CONNECTION_WANTED:
      return "it speaks no TLS";
    case NATS_NO_SERVER:
      return "no server at its port";
    case NATS_TIMEOUT:
      return "the broker does not answer";
    default:
      return place.is_encrypted ? "the broker has ended the connection after TLS began: perhaps it "
                                  "wants a certificate (" +
                                      text + ")"
                                : text;
  }
}

std::string library_url(const BrokerPlace& place) {
  const bool is_address = place.host.find(':') != std::string::npos;
  return "nats://" + (is_address ? "[" + place.host + "]" : place.host) + ":" +
         std::to_string(place.port);
}

void set_user(natsOptions* options, const BrokerOptions& broker) {
  if (!broker.credentials.empty()) {
    check_nats(
        natsOptions_SetUserCredentialsFromFiles(options, broker.credentials.c_str(), nullptr));
  } else if (!broker.token.empty()) {
    check_nats(natsOptions_SetToken(options, broker.token.c_str()));
  } else if (!broker.user.empty()) {
    check_nats(natsOptions_SetUserInfo(options, broker.user.c_str(), broker.password.c_str()));
  }
}

void set_tls(natsOptions* options, const BrokerOptions& broker, const BrokerPlace& place) {
  if (!place.is_encrypted) return;
  check_nats(natsOptions_SetSecure(options, true));
  check_nats(natsOptions_SetExpectedHostname(options, place.host.c_str()));
  if (!broker.authority.empty()) {
    check_nats(natsOptions_LoadCATrustedCertificates(options, broker.authority.c_str()));
  }
  if (!broker.certificate.empty()) {
    const std::string& key = broker.key.empty() ? broker.certificate : broker.key;
    check_nats(natsOptions_LoadCertificatesChain(options, broker.certificate.c_str(), key.c_str()));
  }
}

void read_headers(natsMsg* message, Properties& headers) {
  const char** names = nullptr;
  int count = 0;
  if (natsMsgHeader_Keys(message, &names, &count) != NATS_OK) return;
  for (int i = 0; i < count; ++i) {
    const char** values = nullptr;
    int value_count = 0;
    if (natsMsgHeader_Values(message, names[i], &values, &value_count) != NATS_OK) continue;
    for (int k = 0; k < value_count; ++k) headers.emplace_back(names[i], values[k]);
    std::free(static_cast<void*>(values));
  }
  std::free(static_cast<void*>(names));
}

NatsMessage taken_message(natsMsg* message) {
  NatsMessage result{natsMsg_GetSubject(message)};
  if (const char* const reply = natsMsg_GetReply(message)) result.reply = reply;
  const auto* const bytes = reinterpret_cast<const std::byte*>(natsMsg_GetData(message));
  result.payload.assign(bytes, bytes + natsMsg_GetDataLength(message));
  result.is_unanswered = natsMsg_IsNoResponders(message);
  read_headers(message, result.headers);
  return result;
}

}  // namespace

/// What the library's threads call. It has to stay until they do not any more.
class NatsLink::Callbacks {
 public:
  explicit Callbacks(std::shared_ptr<NatsMailbox> mailbox) : mailbox_(std::move(mailbox)) {}

  void use_in(natsOptions* options) {
    check_nats(natsOptions_SetErrorHandler(options, on_error, this));
    check_nats(natsOptions_SetClosedCB(options, on_closed, this));
  }
  /// For a subscription, which frees it with forget().
  [[nodiscard]] void* closure(const std::string& subject) const {
    return new Closure{mailbox_, subject};
  }
  static void forget(void* closure) { delete static_cast<Closure*>(closure); }

  static void on_message(natsConnection*, natsSubscription*, natsMsg* taken, void* closure) {
    const LibraryMessage owned(taken);
    const Closure& to = *static_cast<Closure*>(closure);
    NatsMessage message = taken_message(taken);
    message.heard_at = to.subject;
    to.mailbox->add(std::move(message));
  }
  /// Until the last call of the library, which tells that the connection is closed. False when it
  /// does not come.
  bool wait() {
    const MutexLock lock(mutex_);
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(closing_time_ms);
    return changed_.wait_until(mutex_, end, [this]() RR_REQUIRES(mutex_) { return is_closed_; });
  }

 private:
  struct Closure {
    std::shared_ptr<NatsMailbox> mailbox;
    std::string subject;
  };

  static void on_error(natsConnection*, natsSubscription*, natsStatus status, void* closure) {
    // A slow reader has lost messages: they are asked for again.
    if (status != NATS_NOT_PERMITTED) return;
    static_cast<Callbacks*>(closure)->mailbox_->refuse(nats_error(status));
  }
  static void on_closed(natsConnection* connection, void* closure) {
    auto& self = *static_cast<Callbacks*>(closure);
    const char* text = nullptr;
    const natsStatus status = natsConnection_GetLastError(connection, &text);
    const bool has_text = text != nullptr && *text != '\0';
    const char* const known =
        status == NATS_OK ? "the connection was lost" : natsStatus_GetText(status);
    self.mailbox_->close(has_text ? text : known);
    const MutexLock lock(self.mutex_);
    self.is_closed_ = true;
    self.changed_.notify_all();
  }

  std::shared_ptr<NatsMailbox> mailbox_;
  Mutex mutex_;
  Condition changed_;
  bool is_closed_ RR_GUARDED_BY(mutex_) = false;
};

void NatsLink::Subscription::Ended::operator()(__natsSubscription* subscription) const {
  natsSubscription_Destroy(subscription);
}

NatsLink::NatsLink(const BrokerOptions& broker, const BrokerPlace& place,
                   std::chrono::seconds keep_alive, std::shared_ptr<NatsMailbox> mailbox)
    : callbacks_(std::make_unique<Callbacks>(std::move(mailbox))) {
  natsOptions* made = nullptr;
  check_nats(natsOptions_Create(&made));
  const LibraryOptions options(made);
  check_nats(natsOptions_SetURL(made, library_url(place).c_str()));
  // The carrier connects again by itself: the library would keep messages for that, without a word
  // whether they have arrived, and use the files of TLS that it has read once.
  check_nats(natsOptions_SetAllowReconnect(made, false));
  check_nats(natsOptions_SetTimeout(made, connect_time_ms));
  check_nats(natsOptions_SetWriteDeadline(made, write_time_ms));
  // Two pings without an answer end the connection.
  check_nats(natsOptions_SetPingInterval(made, std::chrono::milliseconds(keep_alive).count() / 2));
  check_nats(natsOptions_SetMaxPingsOut(made, 1));
  // All subscriptions have one thread, and messages stay in their order.
  check_nats(natsOptions_UseGlobalMessageDelivery(made, true));
  check_nats(natsOptions_SetSendAsap(made, true));
  set_user(made, broker);
  set_tls(made, broker, place);
  callbacks_->use_in(made);
  const natsStatus status = natsConnection_Connect(&connection_, made);
  if (status != NATS_OK) {
    throw Error(ErrorCode::connection_error, connect_reason(status, broker, place));
  }
}

NatsLink::~NatsLink() {
  natsConnection_Close(connection_);
  // The library may still call what it has not called yet: rather a leak than that.
  if (!callbacks_->wait()) {
    [[maybe_unused]] const Callbacks* const leaked = callbacks_.release();
  }
  natsConnection_Destroy(connection_);
}

NatsLink::Subscription NatsLink::subscribe(const std::string& subject) {
  void* const closure = callbacks_->closure(subject);
  natsSubscription* subscription = nullptr;
  const natsStatus status = natsConnection_Subscribe(&subscription, connection_, subject.c_str(),
                                                     Callbacks::on_message, closure);
  if (status != NATS_OK) {
    Callbacks::forget(closure);
    return Subscription();
  }
  natsSubscription_SetOnCompleteCB(subscription, Callbacks::forget, closure);
  // The mailbox has limits of its own, and never drops what is for an inbox.
  natsSubscription_SetPendingLimits(subscription, -1, -1);
  return Subscription(subscription);
}

bool NatsLink::publish(const NatsMessage& message) {
  natsMsg* made = nullptr;
  const natsStatus status = natsMsg_Create(&made, message.subject.c_str(),
                                           message.reply.empty() ? nullptr : message.reply.c_str(),
                                           reinterpret_cast<const char*>(message.payload.data()),
                                           static_cast<int>(message.payload.size()));
  const LibraryMessage owned(made);
  if (status != NATS_OK) return false;
  for (const auto& [name, value] : message.headers) {
    if (natsMsgHeader_Add(made, name.c_str(), value.c_str()) != NATS_OK) return false;
  }
  return natsConnection_PublishMsg(connection_, made) == NATS_OK;
}

std::size_t NatsLink::largest() const {
  const std::int64_t largest = natsConnection_GetMaxPayload(connection_);
  return largest > 0 ? static_cast<std::size_t>(largest) : SIZE_MAX;
}

}  // namespace rr::gateway
