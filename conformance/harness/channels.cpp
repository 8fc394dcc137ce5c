// SPDX-License-Identifier: Apache-2.0
#include "conformance/harness/channels.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <rr/message_tree.hpp>
#include <rr/node_id.hpp>
#include <rr/options.hpp>
#include <rr/url.hpp>
#include <stdexcept>

#include "conformance/harness/broker.hpp"
#include "conformance/harness/decoded.hpp"
#include "conformance/harness/entry_types.hpp"
#include "conformance/harness/sharing.hpp"
#include "conformance/harness/starttls.hpp"
#include "runtime/cpp/src/channel/components.hpp"
#include "runtime/cpp/src/channel/openssl_tls.hpp"
#include "runtime/cpp/src/channel/web_socket.hpp"

namespace rr::conformance {
namespace {

namespace fs = std::filesystem;

constexpr Milliseconds handshake_limit{3000};
// What runners and their clients use on this machine.
constexpr const char* loopback = "127.0.0.1";

fs::path new_folder() {
  std::string name = (fs::temp_directory_path() / "rr-conformance-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make a folder");
  return name;
}

rr::NodeId id_of(const std::string& text) {
  const auto id = rr::NodeId::parse(text);
  if (!id) throw std::runtime_error("no node id: " + text);
  return *id;
}

}  // namespace

const std::vector<std::string>& channel_names() {
  static const std::vector<std::string> names = {"tcp",    "local", "shm",   "ws",   "tls",
                                                 "rrs+ws", "wss",   "intra", "mqtt", "nats"};
  return names;
}

// An authority, and certificates of it for whoever is asked for.
class Channel::Secrets {
 public:
  explicit Secrets(const fs::path& folder)
      : authority_(rr::Authority::create((folder / "ca").string())) {}

  [[nodiscard]] std::string authority_file() const { return authority_.certificate_file(); }
  const std::string& certificate_of(const std::string& node) {
    std::string& file = files_[node];
    if (file.empty()) file = authority_.issue(id_of(node));
    return file;
  }
  const channel::Tls& side_of(const std::string& node) {
    std::unique_ptr<channel::Tls>& side = sides_[node];
    if (!side) {
      rr::TlsOptions options;
      options.certificate_file = certificate_of(node);
      options.authority_files = {authority_file()};
      side = std::make_unique<channel::OpenSslTls>(options, id_of(node));
    }
    return *side;
  }

 private:
  rr::Authority authority_;
  std::map<std::string, std::string> files_;
  std::map<std::string, std::unique_ptr<channel::Tls>> sides_;
};

Channel::Channel(std::string name)
    : name_(std::move(name)), web_sockets_(channel::make_web_sockets({})) {
  if (std::ranges::find(channel_names(), name_) == channel_names().end()) {
    throw std::runtime_error("there is no channel " + name_);
  }
}

Channel::~Channel() {
  std::error_code error;
  if (!folder_.empty()) fs::remove_all(folder_, error);
}

Broker& Channel::broker() {
  if (!broker_) broker_ = std::make_unique<Broker>(name_);
  return *broker_;
}

// Under the lock.
Channel::Secrets& Channel::secrets() {
  if (!secrets_) secrets_ = std::make_unique<Secrets>(folder_ = new_folder());
  return *secrets_;
}

const channel::Tls& Channel::tls_of(const std::string& node) {
  const std::lock_guard lock(mutex_);
  return secrets().side_of(node);
}

bool Channel::has_web_socket() const { return name_.ends_with("ws") || name_ == "wss"; }

Json Channel::settings(const Node& node) {
  if (name_ == "tcp") return nullptr;
  Json json = {{"name", name_}};
  if (is_local()) {
    if (folder_.empty()) folder_ = new_folder();
    json["path"] = socket().string();
  } else if (name_ == "tls" || name_ == "rrs+ws" || name_ == "wss") {
    const std::lock_guard lock(mutex_);
    json["certificate"] = secrets().certificate_of(node.id);
    json["authority"] = secrets().authority_file();
  }
  return json;
}

Stream Channel::connect(const Scenario& scenario, const std::string& host, int port) {
  if (is_local()) {
    Stream stream = Stream::connect(socket());
    if (name_ == "shm") share_as_client(stream);
    return stream;
  }
  Stream stream = Stream::connect(host, port);
  if (plays_as_recorded() && !scenario.web_socket.is_empty()) {
    stream.put(recorded_web_socket_client(scenario.web_socket), handshake_limit);
  }
  if (name_ == "wss") {
    stream.put(tls_of(scenario.client.id).make_web_client(host, {}), handshake_limit);
  }
  if (has_web_socket()) {
    const std::string url = "rr+ws://" + host + ":" + std::to_string(port) + "/?service=any";
    stream.put(web_sockets_->make_client(rr::Url::parse(url)), handshake_limit);
  }
  if (name_ == "tls" || name_ == "rrs+ws") {
    ask_for_tls(stream, scenario);
    const channel::Tls& side = tls_of(scenario.client.id);
    stream.put(side.make_client(id_of(scenario.service.id)), handshake_limit);
  }
  return stream;
}

// By local sockets a node is asked for by its id or its name, not by both (04, section 4.1).
Frame Channel::as_sent(const Frame& frame) const {
  rr::MessageTree message;
  if (!is_local() || !opens(frame) || !rr::read_tree(frame.bytes, message) ||
      message.receiver_node.is_any() || message.receiver_name.empty()) {
    return frame;
  }
  message.receiver_name.clear();
  Frame sent = frame;
  sent.bytes = rr::write_tree(message);
  sent.decoded = json_of_message(message);
  return sent;
}

replay::Listener Channel::listen() {
  if (!is_local()) return replay::Listener(0);
  if (folder_.empty()) folder_ = new_folder();
  return replay::Listener(socket());
}

std::string Channel::place(const Scenario& scenario, int port) const {
  if (is_local()) return "rr+local://" + socket().string() + "?";
  if (is_in_process()) return "rr+intra:///?";
  static const std::map<std::string, std::string> schemes = {{"tcp", "rr+tcp"},
                                                             {"ws", "rr+ws"},
                                                             {"tls", "rrs+tcp"},
                                                             {"rrs+ws", "rrs+ws"},
                                                             {"wss", "rr+wss"}};
  const bool is_recorded = plays_as_recorded() && !scenario.web_socket.is_empty();
  const std::string& scheme = schemes.at(is_recorded ? "ws" : name_);
  return scheme + "://" + loopback + ":" + std::to_string(port) + "/?";
}

void Channel::answer(Stream& stream, const Scenario& scenario) {
  if (plays_as_recorded() && !scenario.web_socket.is_empty()) {
    stream.put(recorded_web_socket_service(scenario.web_socket), handshake_limit);
  }
  if (name_ == "shm") share_as_service(stream);
  if (name_ == "wss") {
    stream.put(tls_of(scenario.service.id).make_server(false), handshake_limit);
  }
  if (has_web_socket())
    stream.put(web_sockets_->make_server({.is_encrypted = name_ == "wss"}), handshake_limit);
  if (name_ == "tls" || name_ == "rrs+ws") {
    bool is_mutual = false;
    const Node node = answer_for_tls(stream, scenario, is_mutual);
    stream.put(tls_of(node.id).make_server(is_mutual), handshake_limit);
  }
}

std::optional<Stream> Entrance::accept(Milliseconds limit) {
  std::optional<Stream> stream = listener_.accept(limit);
  if (stream) channel_.answer(*stream, scenario_);
  return stream;
}

}  // namespace rr::conformance
