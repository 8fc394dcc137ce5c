// SPDX-License-Identifier: Apache-2.0
#include <nats/nats.h>

#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "gateway/kept_stream.hpp"
#include "gateway/matrix/probe_broker.hpp"

namespace rr::gateway::matrix {
namespace {

constexpr std::chrono::seconds connect_time{30};
constexpr std::int64_t request_ms = 3'000;
constexpr std::int64_t ping_ms = 5'000;  // as the gateway has it
constexpr std::int64_t reconnect_ms = 100;

void check(natsStatus status, const char* what) {
  if (status == NATS_OK) return;
  throw std::runtime_error(std::string(what) + ": " + natsStatus_GetText(status));
}

/// `tls://a:1,b:2` as the library has them: nats://a:1 and nats://b:2.
std::vector<std::string> servers_of(const std::string& url) {
  std::vector<std::string> all;
  std::size_t at = url.find("://") + 3;
  while (at < url.size()) {
    const std::size_t comma = std::min(url.find(',', at), url.size());
    all.push_back("nats://" + url.substr(at, comma - at));
    at = comma + 1;
  }
  return all;
}

class NatsProbe final : public ProbeBroker {
 public:
  explicit NatsProbe(const ProbeOptions& options) {
    natsOptions* made = nullptr;
    check(natsOptions_Create(&made), "options");
    const std::vector<std::string> servers = servers_of(options.url);
    std::vector<const char*> names;
    for (const std::string& server : servers) names.push_back(server.c_str());
    check(natsOptions_SetServers(made, names.data(), static_cast<int>(names.size())), "servers");
    check(natsOptions_SetSecure(made, true), "TLS");
    check(natsOptions_LoadCATrustedCertificates(made, options.authority.c_str()), "authority");
    check(natsOptions_SetUserInfo(made, options.user.c_str(), options.password.c_str()), "user");
    check(natsOptions_SetMaxReconnect(made, -1), "reconnection");
    check(natsOptions_SetReconnectWait(made, reconnect_ms), "reconnection");
    check(natsOptions_SetPingInterval(made, ping_ms), "ping");
    check(natsOptions_SetMaxPingsOut(made, 1), "ping");
    check(natsOptions_SetSendAsap(made, true), "sending at once");
    check(natsConnection_Connect(&connection_, made), "connection");
    natsOptions_Destroy(made);
    make_stream(options.replicas);
  }
  ~NatsProbe() override {
    natsSubscription_Destroy(subscription_);
    natsConnection_Destroy(connection_);
  }

  void publish(const std::string& topic, const std::string& payload) override {
    // The library would keep it, and send it late.
    if (natsConnection_Status(connection_) != NATS_CONN_STATUS_CONNECTED) return;
    natsConnection_Publish(connection_, ("rrkept.probe." + topic).c_str(), payload.data(),
                           static_cast<int>(payload.size()));
  }
  void subscribe(Taken taken) override {
    taken_ = std::move(taken);
    check(natsConnection_Subscribe(&subscription_, connection_, "rr.probe.>", on_message, this),
          "subscription");
    check(natsConnection_FlushTimeout(connection_, request_ms), "subscription");
  }

 private:
  /// The one of the gateways, so that what the broker does to it is done to both; all but the first
  /// find it.
  void make_stream(int replicas) {
    const std::string subject = stream_create_subject();
    const std::string wanted = stream_create_text(replicas);
    const auto end = std::chrono::steady_clock::now() + connect_time;
    std::string got = "no answer";
    while (std::chrono::steady_clock::now() < end) {
      natsMsg* answer = nullptr;
      if (natsConnection_RequestString(&answer, connection_, subject.c_str(), wanted.c_str(),
                                       request_ms) == NATS_OK) {
        got = std::string(natsMsg_GetData(answer),
                          static_cast<std::size_t>(natsMsg_GetDataLength(answer)));
        natsMsg_Destroy(answer);
        if (got.find("\"error\"") == std::string::npos) return;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
    }
    throw std::runtime_error("no stream: " + got);
  }
  static void on_message(natsConnection*, natsSubscription*, natsMsg* message, void* user) {
    static_cast<NatsProbe*>(user)->taken_(std::string(
        natsMsg_GetData(message), static_cast<std::size_t>(natsMsg_GetDataLength(message))));
    natsMsg_Destroy(message);
  }

  natsConnection* connection_ = nullptr;
  natsSubscription* subscription_ = nullptr;
  Taken taken_;
};

}  // namespace

std::unique_ptr<ProbeBroker> make_nats_probe(const ProbeOptions& options) {
  return std::make_unique<NatsProbe>(options);
}

}  // namespace rr::gateway::matrix
