// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/service/service_host.hpp"

#include <algorithm>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/endpoint/user_code.hpp"
#include "runtime/cpp/src/service/directory.hpp"
#include "runtime/cpp/src/service/object_types.hpp"
#include "runtime/cpp/src/service/offered_wire.hpp"
#include "runtime/cpp/src/service/places.hpp"
#include "runtime/cpp/src/service/server_endpoint.hpp"

namespace rr {

void Skeleton::Places::add(std::weak_ptr<service::ServiceHost> host,
                           const service::ServedObject& object) {
  const MutexLock lock(mutex_);
  places_.push_back({std::move(host), object.path, object.owner});
}

void Skeleton::Places::remove(const service::ServiceHost& host,
                              const service::ServedObject& object) {
  const std::weak_ptr<const service::ServiceHost> self = host.weak_from_this();
  const MutexLock lock(mutex_);
  // Compared without taking hold of any: letting go of the last one would destroy it under the
  // lock.
  std::erase_if(places_, [&](const auto& place) {
    const bool is_same = !place.host.owner_before(self) && !self.owner_before(place.host) &&
                         place.owner == object.owner && place.path == object.path;
    return is_same || place.host.expired();
  });
}

auto Skeleton::Places::all() -> std::vector<Place<std::shared_ptr<service::ServiceHost>>> {
  std::vector<Place<std::shared_ptr<service::ServiceHost>>> result;
  const MutexLock lock(mutex_);
  for (const auto& place : places_) {
    if (auto alive = place.host.lock()) {
      result.push_back({std::move(alive), place.path, place.owner});
    }
  }
  return result;
}

std::shared_ptr<service::OfferedWire> Skeleton::Places::wire(const Member& member) {
  const MutexLock lock(mutex_);
  auto& wire = wires_[member.name];
  if (!wire) wire = std::make_shared<service::OfferedWire>(member);
  return wire;
}

Skeleton::Skeleton() : rr_places_(std::make_shared<Places>()) {}
Skeleton::~Skeleton() = default;
void Skeleton::rr_attached(ServiceContext& /*context*/, const std::string& /*path*/) {}

std::string Skeleton::rr_path() const {
  const auto places = rr_places_->all();
  return places.empty() ? std::string() : places.front().path;
}

std::shared_ptr<ServiceContext> Skeleton::rr_service() const {
  const auto places = rr_places_->all();
  return places.empty() ? nullptr : places.front().host;
}

void Skeleton::rr_set_per_client() const { rr_places_->is_per_client = true; }

void Skeleton::rr_fire(const Member& member, const void* const* arguments) const {
  for (const auto& [host, path, owner] : rr_places_->all()) {
    host->fire(path, owner, member, arguments);
  }
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
      attributes_(std::move(options.attributes)),
      rights_(std::move(options.rights)),
      options_(std::move(options)),
      types_(core_->types()),
      definitions_(all_definitions(*root, options_)),
      objects_(name_, std::move(root), options_.limits.objects,
               std::make_shared<channel::Account>(core_->pools().sessions, channel::no_limit),
               {.attach = [this](const ServedObject& object) { attach(object); },
                .drop =
                    [this](ObjectTree::Released released) {
                      detach(released);
                      tell_released_later(std::move(released));
                    },
                .is_held = [this](const ServedObject& object) { return locks_.are_on(object); }},
               core_->options().request_timeout),
      locks_(options_.limits.locks),
      monitors_(
          std::make_shared<Monitors>(core_, options_.monitor_patience, options_.limits.monitors)),
      clients_(std::make_shared<const Clients>()) {
  if (options_.rights_file.empty()) return;
  if (rights_) {
    throw Error(ErrorCode::invalid_argument, "the rights of `" + name_ + "` are given twice");
  }
  rights_file_ = std::make_shared<RightsFile>(core_, options_.rights_file);
  rights_ = rights_file_->read();
}

void ServiceHost::start() {
  if (options_.users) {
    for (const std::string& warning : options_.users->warnings()) {
      core_->log(LogLevel::warning, "`" + name_ + "`: " + warning);
    }
  }
  attach(*objects_.root());
  if (rights_file_) {
    rights_file_->watch([self = weak_from_this()](std::shared_ptr<const Rights> rights) {
      if (const auto host = self.lock()) host->set_rights(std::move(rights));
    });
  }
  is_started_ = true;
}

void ServiceHost::attach(const ServedObject& object) {
  Skeleton::Places::of(*object.skeleton).add(weak_from_this(), object);
  object.skeleton->rr_attached(*this, object.path);
}

// What belongs to objects that are forgotten ends.
void ServiceHost::detach(const ObjectTree::Released& released) {
  for (const auto& object : released) {
    Skeleton::Places::of(*object->skeleton).remove(*this, *object);
    locks_.forget(*object);
    monitors_->forget(*object);
  }
}

// The objects may go with this. On a thread of the node.
void ServiceHost::tell_released(const endpoint::Core& core, ObjectTree::Released released) {
  for (auto& object : released) {
    endpoint::call_user_code(core, "rr_released of", object->path,
                             [&] { object->skeleton->rr_released(object->path); });
    object.reset();
  }
}

void ServiceHost::tell_released_later(ObjectTree::Released released) const {
  core_->reactor().post([core = core_, released = std::move(released)]() mutable {
    tell_released(*core, std::move(released));
  });
}

std::map<std::string, VarValue> ServiceHost::attributes() const {
  const MutexLock lock(mutex_);
  return attributes_;
}

void ServiceHost::set_attributes(std::map<std::string, VarValue> attributes) {
  {
    const MutexLock lock(mutex_);
    attributes_.swap(attributes);  // the old ones go when the lock has
  }
  if (const auto directory = directory_.lock()) directory->services_changed();
}

std::optional<std::string> ServiceHost::root_type_for(
    const std::optional<DefinitionVersion>& client) const {
  return type_for(*objects_.root()->type, client);
}

std::shared_ptr<const ServiceHost::Clients> ServiceHost::connected() const {
  const MutexLock lock(mutex_);
  return clients_;
}

std::shared_ptr<const Rights> ServiceHost::rights() const {
  const MutexLock lock(mutex_);
  return rights_;
}

void ServiceHost::set_rights(std::shared_ptr<const Rights> rights) {
  {
    const MutexLock lock(mutex_);
    rights_.swap(rights);  // the old ones go when the lock has
  }
  const auto clients = connected();
  for (const auto& client : *clients) client->renew_rights(*this);
}

std::vector<ServiceClient> ServiceHost::clients() const {
  std::vector<ServiceClient> result;
  const auto clients = connected();
  for (const auto& client : *clients) {
    result.push_back(client->client());
    if (const auto user = client->user()) result.back().user = user->name;
  }
  return result;
}

// Those that ended meanwhile may own things of the program: these do not end on this thread.
ServiceHost::Use ServiceHost::use() const {
  Use use{.objects = objects_.size()};
  auto clients = connected();
  for (const auto& client : *clients) {
    ++use.sessions;
    use.wires += client->wire_count();
    use.pipes += client->pipe_count();
  }
  core_->reactor().post([kept = std::move(clients)]() mutable { kept.reset(); });
  return use;
}

// The old list goes when the lock has, here and below, with what only it has held.
bool ServiceHost::add_client(const std::shared_ptr<ServerEndpoint>& client) {
  std::shared_ptr<const Clients> old;
  {
    const MutexLock lock(mutex_);
    if (is_closed_) return false;
    auto clients = std::make_shared<Clients>(*clients_);
    clients->push_back(client);
    old = std::exchange(clients_, std::move(clients));
  }
  locks_.enter(client->client().endpoint);
  notify(options_.on_client_connected, client->client());
  return true;
}

void ServiceHost::remove_client(const ServerEndpoint& client) {
  std::shared_ptr<const Clients> old;
  {
    const MutexLock lock(mutex_);
    auto clients = std::make_shared<Clients>(*clients_);
    std::erase_if(*clients, [&](const auto& other) { return other.get() == &client; });
    old = std::exchange(clients_, std::move(clients));
  }
  locks_.leave(client.client().endpoint);
  monitors_->leave(client.client().endpoint);
}

void ServiceHost::announce_leaving(const ServiceClient& client) const {
  notify(options_.on_client_leaving, client);
}

void ServiceHost::announce_end(const ServerEndpoint& client) const {
  notify(options_.on_client_disconnected, client.client());
}

std::shared_ptr<ServerEndpoint> ServiceHost::find_client(std::uint32_t endpoint) const {
  const auto clients = connected();
  for (const auto& client : *clients) {
    if (client->client().endpoint == endpoint) return client;
  }
  return nullptr;
}

void ServiceHost::notify(const std::function<void(const ServiceClient&)>& function,
                         const ServiceClient& client) const {
  if (!function) return;
  endpoint::call_user_code(*core_, "a listener of", name_, [&] { function(client); });
}

// For this client the service is closed; without a word it would look for a fault of its link.
void ServiceHost::disconnect(std::uint32_t endpoint) {
  const auto clients = connected();
  for (const auto& client : *clients) {
    if (client->client().endpoint != endpoint) continue;
    tell_closed(*client);
    client->leave();
  }
}

void ServiceHost::tell_closed(ServerEndpoint& client) {
  if (!client.access().may_send(EntryType::service_closed, {}, {})) return;
  client.send_packet({.type = EntryType::service_closed}, {}, nullptr);
}

std::string ServiceHost::releasable(const std::string& path) const {
  const auto segments = endpoint::parse_path(path);
  if (!segments) throw Error(ErrorCode::service_error, "Invalid service path specified");
  std::string canonical = endpoint::canonical_path(*segments);
  if (canonical == name_) {
    throw Error(ErrorCode::invalid_operation, "Root object cannot be released");
  }
  return canonical;
}

void ServiceHost::release_path(const std::string& path) {
  const std::string canonical = releasable(path);
  ObjectTree::Released released = objects_.release(canonical);
  if (released.empty()) throw Error(ErrorCode::service_error, "Unknown service path");
  detach(released);
  const auto clients = connected();
  for (const auto& client : *clients) client->release_path(canonical);
  tell_released_later(std::move(released));
}

void ServiceHost::release_path(const std::string& path, std::uint32_t client) {
  const std::string canonical = releasable(path);
  ObjectTree::Released released = objects_.release(canonical, client);
  if (released.empty()) {
    throw Error(ErrorCode::service_error, "the client has no object of its own at this path");
  }
  detach(released);
  if (const auto found = find_client(client)) found->release_path(canonical);
  tell_released_later(std::move(released));
}

void ServiceHost::lock(const std::string& path, const std::string& user) {
  locks_.lock(*objects_.find(path, 0), user);
}

bool ServiceHost::unlock(const std::string& path) {
  const auto segments = endpoint::parse_path(path);
  return segments && locks_.unlock(endpoint::canonical_path(*segments));
}

void ServiceHost::release_objects_of(std::uint32_t client) {
  ObjectTree::Released released = objects_.release_all_of(client);
  detach(released);
  tell_released(*core_, std::move(released));
  ObjectTree::Released unused = objects_.leave(client, options_.limits.unused_objects);
  detach(unused);
  tell_released(*core_, std::move(unused));
}

void ServiceHost::fire(const std::string& path, std::uint32_t owner, const Member& member,
                       const void* const* arguments) {
  const EntryHeader header{
      .type = EntryType::event_req, .service_path = path, .member = member.name};
  const bool is_urgent = (member.access & urgent) != 0;
  const auto send = [&](ServerEndpoint& client) {
    if (!client.access().may_send(EntryType::event_req, path, member.name)) return;
    client.send_packet(header, member.parameters, arguments, is_urgent);
  };
  if (owner != 0) {
    if (const auto client = find_client(owner)) send(*client);
    return;
  }
  const auto clients = connected();
  for (const auto& client : *clients) send(*client);
}

void ServiceHost::close() {
  const auto self = shared_from_this();  // the directory's reference may be the last
  {
    const MutexLock lock(mutex_);
    if (std::exchange(is_closed_, true)) return;
  }
  if (const auto directory = directory_.lock()) directory->remove(*this);
  const auto clients = connected();
  for (const auto& client : *clients) tell_closed(*client);
  for (const auto& client : *clients) client->leave();
  ObjectTree::Released released = objects_.clear();
  detach(released);
  tell_released_later(std::move(released));
}

}  // namespace service

}  // namespace rr
