// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/service/directory.hpp"

#include <algorithm>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/endpoint/service_index_types.hpp"
#include "runtime/cpp/src/endpoint/service_path.hpp"
#include "runtime/cpp/src/service/server_endpoint.hpp"
#include "runtime/cpp/src/service/service_index.hpp"

namespace rr::service {

Directory::Directory(std::shared_ptr<endpoint::Core> core)
    : core_(std::move(core)),
      logins_(core_->options().login,
              [core = core_](LogLevel level, std::string_view text) { core->log(level, text); }) {}

void Directory::start() {
  index_ = std::make_shared<ServiceIndex>(weak_from_this());
  add(std::string(service_index::service_name), index_, {});
}

std::shared_ptr<ServiceHost> Directory::add(std::string name, std::shared_ptr<Skeleton> root,
                                            ServiceOptions options) {
  if (!root) throw Error(ErrorCode::invalid_argument, "a service needs a root object");
  const auto segments = endpoint::parse_path(name);
  if (!segments || segments->size() != 1) {
    throw Error(ErrorCode::invalid_argument,
                "`" + name + "` is no name for a service: a letter, then letters, digits and `_`");
  }
  core_->add_definition(root->rr_object_type().definition);
  for (const Definition* definition : options.extra_imports) core_->add_definition(*definition);
  auto host = std::make_shared<ServiceHost>(core_, weak_from_this(), std::move(name),
                                            std::move(root), std::move(options));
  {
    const MutexLock lock(mutex_);
    for (const auto& other : services_) {
      if (other->name() == host->name()) {
        throw Error(ErrorCode::invalid_operation,
                    "there is a service `" + host->name() + "` already");
      }
    }
    services_.push_back(host);
  }
  try {
    host->start();
  } catch (...) {
    remove(*host);
    throw;
  }
  services_changed();
  return host;
}

void Directory::remove(const ServiceHost& host) {
  std::shared_ptr<ServiceHost> removed;  // goes when the lock has, with its objects
  {
    const MutexLock lock(mutex_);
    const auto found = std::find_if(services_.begin(), services_.end(),
                                    [&](const auto& other) { return other.get() == &host; });
    if (found != services_.end()) {
      removed = std::move(*found);
      services_.erase(found);
    }
  }
  services_changed();
}

void Directory::close() {
  for (const auto& host : all()) host->close();
  logins_.refuse_all();
}

std::shared_ptr<ServiceHost> Directory::find(std::string_view name) const {
  const MutexLock lock(mutex_);
  for (const auto& host : services_) {
    if (host->name() == name && host->is_started()) return host;
  }
  return nullptr;
}

std::vector<std::shared_ptr<ServiceHost>> Directory::all() const {
  const MutexLock lock(mutex_);
  return {services_.rbegin(), services_.rend()};
}

std::vector<DetectedNode> Directory::detected_nodes() const {
  return discovery_.detected_nodes ? discovery_.detected_nodes() : std::vector<DetectedNode>();
}

void Directory::services_changed() const {
  if (index_) index_->fire_changed();
  if (discovery_.services_changed) discovery_.services_changed();
}

std::shared_ptr<channel::Receiver> Directory::accept(
    std::shared_ptr<channel::Connection> connection) {
  auto endpoint = std::make_shared<ServerEndpoint>(shared_from_this(), std::move(connection));
  core_->attend(endpoint);
  return endpoint;
}

}  // namespace rr::service
