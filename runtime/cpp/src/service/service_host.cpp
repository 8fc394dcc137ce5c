// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/service/service_host.hpp"

#include <algorithm>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/service/directory.hpp"
#include "runtime/cpp/src/service/object_types.hpp"
#include "runtime/cpp/src/service/places.hpp"
#include "runtime/cpp/src/service/server_endpoint.hpp"

namespace rr {

void Skeleton::Places::add(std::weak_ptr<service::ServiceHost> host, std::string path) {
  const std::lock_guard lock(mutex_);
  places_.emplace_back(std::move(host), std::move(path));
}

void Skeleton::Places::remove(const service::ServiceHost& host, const std::string& path) {
  const std::lock_guard lock(mutex_);
  std::erase_if(places_, [&](const auto& place) {
    const auto other = place.first.lock();
    return !other || (other.get() == &host && place.second == path);
  });
}

std::vector<std::pair<std::shared_ptr<service::ServiceHost>, std::string>> Skeleton::Places::all() {
  std::vector<std::pair<std::shared_ptr<service::ServiceHost>, std::string>> result;
  const std::lock_guard lock(mutex_);
  for (const auto& [host, path] : places_) {
    if (auto alive = host.lock()) result.emplace_back(std::move(alive), path);
  }
  return result;
}

Skeleton::Skeleton() : rr_places_(std::make_shared<Places>()) {}
Skeleton::~Skeleton() = default;
void Skeleton::rr_attached(ServiceContext& /*context*/, const std::string& /*path*/) {}

void Skeleton::rr_fire(const Member& member, const void* const* arguments) const {
  for (const auto& [host, path] : rr_places_->all()) host->fire(path, member, arguments);
}

namespace service {
namespace {

std::vector<const Definition*> all_definitions(const Skeleton& root,
                                               const ServiceOptions& options) {
  std::vector<const Definition*> definitions = options.extra_imports;
  definitions.push_back(&root.rr_object_type().definition);
  return with_imports(definitions);
}

}  // namespace

ServiceHost::ServiceHost(std::shared_ptr<endpoint::Core> core, std::weak_ptr<Directory> directory,
                         std::string name, std::shared_ptr<Skeleton> root, ServiceOptions options)
    : core_(std::move(core)),
      directory_(std::move(directory)),
      name_(std::move(name)),
      options_(std::move(options)),
      types_(core_->types()),
      definitions_(all_definitions(*root, options_)),
      objects_(
          name_, std::move(root), [this](const ServedObject& object) { attach(object); },
          [this](const ServedObject& object) { detach(object); }),
      monitors_(std::make_shared<Monitors>(core_, options_.monitor_patience)),
      clients_(std::make_shared<const Clients>()) {}

void ServiceHost::start() {
  if (options_.users) {
    for (const std::string& warning : options_.users->warnings()) {
      core_->log(LogLevel::warning, "`" + name_ + "`: " + warning);
    }
  }
  attach(*objects_.root());
}

void ServiceHost::attach(const ServedObject& object) {
  Skeleton::Places::of(*object.skeleton).add(weak_from_this(), object.path);
  object.skeleton->rr_attached(*this, object.path);
}

void ServiceHost::detach(const ServedObject& object) {
  Skeleton::Places::of(*object.skeleton).remove(*this, object.path);
  locks_.forget(object.path);
  monitors_->forget(object.path);
}

std::map<std::string, VarValue> ServiceHost::attributes() const {
  const std::lock_guard lock(mutex_);
  return options_.attributes;
}

void ServiceHost::set_attributes(std::map<std::string, VarValue> attributes) {
  const std::lock_guard lock(mutex_);
  options_.attributes = std::move(attributes);
}

std::optional<std::string> ServiceHost::root_type_for(
    const std::optional<DefinitionVersion>& client) const {
  return type_for(*objects_.root()->type, client);
}

std::shared_ptr<const ServiceHost::Clients> ServiceHost::connected() const {
  const std::lock_guard lock(mutex_);
  return clients_;
}

bool ServiceHost::may_hear(const ServerEndpoint& client) const {
  return !requires_user() || client.user() != nullptr;
}

std::vector<ServiceClient> ServiceHost::clients() const {
  std::vector<ServiceClient> result;
  const auto all = connected();  // kept through the loop
  for (const auto& client : *all) {
    result.push_back(client->client());
    if (const auto user = client->user()) result.back().user = user->name;
  }
  return result;
}

bool ServiceHost::add_client(const std::shared_ptr<ServerEndpoint>& client) {
  {
    const std::lock_guard lock(mutex_);
    if (is_closed_) return false;
    auto clients = std::make_shared<Clients>(*clients_);
    clients->push_back(client);
    clients_ = std::move(clients);
  }
  locks_.enter(client->client().endpoint);
  notify(options_.on_client_connected, client->client());
  return true;
}

void ServiceHost::remove_client(const ServerEndpoint& client) {
  {
    const std::lock_guard lock(mutex_);
    auto clients = std::make_shared<Clients>(*clients_);
    if (std::erase_if(*clients, [&](const auto& other) { return other.get() == &client; }) == 0) {
      return;
    }
    clients_ = std::move(clients);
  }
  locks_.leave(client.client().endpoint);
  monitors_->leave(client.client().endpoint);
  notify(options_.on_client_disconnected, client.client());
}

void ServiceHost::notify(const std::function<void(const ServiceClient&)>& function,
                         const ServiceClient& client) const {
  if (!function) return;
  try {
    function(client);
  } catch (const std::exception& error) {
    core_->log(LogLevel::error, "a listener of `" + name_ + "` has thrown: " + error.what());
  }
}

void ServiceHost::disconnect(std::uint32_t endpoint) {
  const auto all = connected();  // kept through the loop
  for (const auto& client : *all) {
    if (client->client().endpoint == endpoint) client->leave();
  }
}

void ServiceHost::release_path(const std::string& path) {
  const auto segments = endpoint::parse_path(path);
  if (!segments) throw Error(ErrorCode::service_error, "Invalid service path specified");
  const std::string canonical = endpoint::canonical_path(*segments);
  if (canonical == name_) {
    throw Error(ErrorCode::invalid_operation, "Root object cannot be released");
  }
  if (!objects_.release(canonical)) {
    throw Error(ErrorCode::service_error, "Unknown service path");
  }
  const auto all = connected();  // kept through the loop
  for (const auto& client : *all) {
    if (!may_hear(*client)) continue;
    client->send_packet({.type = EntryType::service_path_released_req, .service_path = canonical},
                        {}, nullptr);
  }
}

void ServiceHost::fire(const std::string& path, const Member& member,
                       const void* const* arguments) {
  const EntryHeader header{
      .type = EntryType::event_req, .service_path = path, .member = member.name};
  const auto all = connected();  // kept through the loop
  for (const auto& client : *all) {
    if (may_hear(*client)) client->send_packet(header, member.parameters, arguments);
  }
}

void ServiceHost::close() {
  {
    const std::lock_guard lock(mutex_);
    if (std::exchange(is_closed_, true)) return;
  }
  if (const auto directory = directory_.lock()) directory->remove(*this);
  const auto clients = connected();
  for (const auto& client : *clients) {
    if (may_hear(*client)) client->send_packet({.type = EntryType::service_closed}, {}, nullptr);
  }
  for (const auto& client : *clients) client->leave();
  objects_.clear();
}

}  // namespace service
}  // namespace rr
