// SPDX-License-Identifier: Apache-2.0
#include "gateway/far_service.hpp"

#include <utility>

#include "gateway/elements.hpp"
#include "gateway/far_locks.hpp"
#include "gateway/properties.hpp"
#include "rr/error.hpp"
#include "rr/rights.hpp"
#include "rr/users.hpp"

namespace rr::gateway {
namespace {

/// For attributes that a robot's gateway has published: a broker may deliver them after the
/// definition, or not at all.
constexpr std::chrono::seconds longest_wait{2};

std::vector<std::string> names_in(std::string_view list) {
  std::vector<std::string> names;
  while (!list.empty()) {
    const std::size_t comma = list.find(',');
    names.emplace_back(list.substr(0, comma));
    list.remove_prefix(comma == std::string_view::npos ? list.size() : comma + 1);
  }
  return names;
}

}  // namespace

FarService::FarService(ServedService served, Shared shared)
    : served_(std::move(served)),
      address_(served_.address),
      topic_(service_topic(address_)),
      shared_(std::move(shared)),
      users_(served_.users_file.empty() ? nullptr : PasswordUsers::from_file(served_.users_file)),
      is_robot_there_(std::make_shared<std::atomic<bool>>(true)) {
  // Mistakes are told now, and not when the robot's definition comes.
  if (!served_.rights_file.empty()) static_cast<void>(Rights::from_file(served_.rights_file));
}

void FarService::start() {
  sessions_ = std::make_shared<FarSessions>(
      shared_.calls, address_, FarSessions::Limits{.alive = shared_.session_alive},
      [weak = Weak(shared_from_this())](std::uint32_t client, const std::string& reason) {
        if (const Self self = weak.lock()) self->drop(client, reason);
      });
  // The robot is to know which of them asks.
  if (users_) sessions_->require();
  shared_.carrier.subscribe(topic_ + "/$closed");
  shared_.carrier.subscribe(topic_ + "/$attributes");
  shared_.carrier.subscribe(topic_ + "/$def/#");
  shared_.carrier.subscribe(topic_ + "/$life");
  shared_.carrier.subscribe(node_topic(address_.site, address_.node) + "/$life");
}

void FarService::close() {
  if (service_) (*service_)->close();
  service_.reset();
  streams_.clear();
  wires_.clear();
  objects_.clear();
  root_ = {};
}

bool FarService::take(const Message& message) {
  if (const auto stream = streams_.find(message.topic); stream != streams_.end()) {
    stream->second->receive(message, shared_.outbox);
    return true;
  }
  if (const auto topic = message.find("topic")) {
    const auto stream = streams_.find(std::string(*topic));
    if (stream == streams_.end()) return false;
    stream->second->receive(message, shared_.outbox);
    return true;
  }
  if (message.topic == shared_.reader.reply_topic) return take_reply(message);
  if (message.topic == topic_ + "/$life") {
    take_life(message);
  } else if (message.topic == topic_ + "/$attributes") {
    take_attributes(message);
  } else if (message.topic == topic_ + "/$closed") {
    for (const Closed& closed : closed_.take(message)) take_closed(closed);
  } else if (message.topic == node_topic(address_.site, address_.node) + "/$life") {
    take_gateway_life(message);
  } else if (message.topic.starts_with(topic_ + "/$def")) {
    take_definition(message, std::string_view(message.topic).substr(topic_.size() + 5));
  }
  // Several services may belong to one robot.
  return false;
}

/// What comes to this gateway alone, and is no answer to a request.
bool FarService::take_reply(const Message& message) {
  if (const auto callback = message.find("callback")) return take_callback(message, *callback);
  // Sessions of other services are unknown here.
  if (message.correlation.empty()) sessions_->take_ended(message);
  return false;
}

void FarService::take_gateway_life(const Message& message) {
  const std::string before = std::exchange(gateway_life_, text_of(message.payload));
  note_lives();
  // Requests that it did not get are not waited for.
  if (gateway_life_ == "up" && before != "up") reconnected();
}

void FarService::take_life(const Message& message) {
  const std::string before = std::exchange(robot_life_, text_of(message.payload));
  note_lives();
  if (robot_life_ == before) return;
  const auto reason = message.find("reason");
  shared_.log(reason ? LogLevel::warning : LogLevel::info,
              topic_ + " is " + robot_life_ + (reason ? ": " + std::string(*reason) : ""));
}

void FarService::note_lives() {
  const auto may_be_there = [](const std::string& life) { return life.empty() || life == "up"; };
  *is_robot_there_ = may_be_there(gateway_life_) && may_be_there(robot_life_);
}

void FarService::take_definition(const Message& message, std::string_view rest) {
  if (rest.empty()) {
    definition_ = message;
    defined_ = std::chrono::steady_clock::now();
  } else {
    texts_[std::string(rest.substr(1))] = text_of(message.payload);
  }
  offer_when_complete();
}

void FarService::take_attributes(const Message& message) {
  attributes_ = decode_attributes(message.payload);
  if (service_) {
    (*service_)->set_attributes(*attributes_);
  } else {
    offer_when_complete();
  }
}

void FarService::offer_when_complete() {
  if (!definition_) return;
  const bool has_attributes = definition_->find("attributes") == "1";
  const bool is_late = std::chrono::steady_clock::now() - defined_ >= longest_wait;
  if (has_attributes && !attributes_ && !is_late) return;
  std::vector<std::string> texts;
  std::string all;
  for (const std::string& name : names_in(definition_->find("definitions").value_or(""))) {
    const auto text = texts_.find(name);
    if (text == texts_.end()) return;
    texts.push_back(text->second);
    all += text->second;
  }
  if (all == offered_ || texts.empty()) return;
  if (!offered_.empty()) {
    shared_.log(LogLevel::error, topic_ + ": the definition has changed; start this gateway again");
    close();
    return;
  }
  offered_ = all;
  try {
    offer(texts);
  } catch (const Error& error) {
    shared_.log(LogLevel::error, topic_ + ": " + error.what());
  }
}

void FarService::offer(const std::vector<std::string>& texts) {
  definitions_.emplace(texts);
  if (has_callbacks()) sessions_->require();
  const auto type = definition_->find("object");
  root_ = make_object("", std::string(type.value_or("")));
  service_ = dynamic::register_service(shared_.node, served_.name, root_, service_options());
  shared_.log(LogLevel::info, topic_ + " is offered as `" + served_.name + "`");
  shared_.pump();
}

ServiceOptions FarService::service_options() const {
  ServiceOptions options;
  options.attributes = attributes_.value_or(std::map<std::string, VarValue>());
  options.users = users_;
  options.rights_file = served_.rights_file;
  // From the first request on: a client may connect as soon as the service is registered.
  options.lock_keeper = std::make_shared<FarLocks>(sessions_, address_, is_robot_there_);
  options.on_client_connected = [sessions = sessions_](const ServiceClient& client) {
    sessions->begin(client.endpoint);
  };
  options.on_client_leaving = [sessions = sessions_](const ServiceClient& client) {
    sessions->end(client.endpoint);
  };
  return options;
}

// Its locks are gone: it must not go on as if it had them.
void FarService::drop(std::uint32_t client, const std::string& reason) {
  shared_.log(LogLevel::warning, topic_ + ": a client is disconnected: " + reason);
  if (service_) (*service_)->disconnect(client);
}

void FarService::reconnected() {
  for (const auto& [topic, stream] : streams_) stream->reconnected(shared_.outbox);
}

void FarService::tick() {
  for (const auto& [topic, stream] : streams_) stream->tick(shared_.outbox);
  sessions_->tick(FarSessions::Clock::now());
  if (offered_.empty()) offer_when_complete();
}

std::string FarService::trouble() const {
  const std::string robot = address_.site + "/" + address_.node;
  if (gateway_life_.empty()) return "the broker knows nothing of the robot " + robot;
  if (gateway_life_ != "up") return "the gateway of the robot " + robot + " is not at the broker";
  if (robot_life_ != "up") return "the gateway of " + robot + " is not connected to the robot";
  return {};
}

}  // namespace rr::gateway
