// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/discovery/index_client.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <string>
#include <utility>

#include "rr/error.hpp"
#include "rr/url.hpp"
#include "runtime/cpp/src/channel/time.hpp"
#include "runtime/cpp/src/client/session.hpp"
#include "runtime/cpp/src/endpoint/service_index_types.hpp"
#include "runtime/cpp/src/endpoint/values.hpp"

namespace rr::discovery {
namespace {

using service_index::IndexStub;
using service_index::ServiceInfo;

constexpr std::chrono::seconds connecting_limit{15};
constexpr std::chrono::seconds call_limit{5};
constexpr std::size_t longest_answer = 64 * 1024;
// Anybody can have announced the node.
const SessionLimits limits{.held = 512 * 1024,
                           .definitions = {.count = 8, .bytes = 256 * 1024},
                           .has_full_messages = false};

void add_once(std::vector<std::string>& urls, std::string url) {
  if (std::find(urls.begin(), urls.end(), url) == urls.end()) urls.push_back(std::move(url));
}

bool is_url_of(const std::string& text, const NodeId& node) {
  try {
    const Url url = Url::parse(text);
    return !url.service.empty() && (url.node_id.is_any() || url.node_id == node);
  } catch (const Error&) {
    return false;
  }
}

// Names of the root's own definition are stored without it.
std::string qualified(const std::string& name, const std::string& root) {
  const std::size_t dot = root.rfind('.');
  if (name.find('.') != std::string::npos || dot == std::string::npos) return name;
  return root.substr(0, dot + 1) + name;
}

FoundService as_found(const ServiceInfo& info, const DetectedNode& node) {
  FoundService service{.name = info.Name,
                       .node = node.id,
                       .node_name = node.name,
                       .object_type = info.RootObjectType};
  if (info.RootObjectImplements) {
    for (const auto& [key, name] : *info.RootObjectImplements) {
      service.implements.push_back(qualified(name, info.RootObjectType));
    }
  }
  if (info.ConnectionURL) {
    for (const auto& [key, url] : *info.ConnectionURL) {
      if (is_url_of(url, node.id)) add_once(service.urls, url);
    }
  }
  if (info.Attributes) service.attributes = *info.Attributes;
  add_urls(service, node);
  return service;
}

// Nothing is read of an answer that is too large.
service_index::ServiceInfos ask_services(Session& session, const std::string& path,
                                         const std::string& url) {
  service_index::ServiceInfos infos;
  session.call(
      {.type = EntryType::function_call_req, .path = path, .member = "GetLocalNodeServices"},
      [&](Decoder& decoder, const Message&, const Entry& entry) {
        if (entry.elements.size() > longest_answer) {
          throw Error(ErrorCode::protocol_error,
                      "the service index at `" + url + "` says too much");
        }
        endpoint::read_value(decoder, entry, "return", type_of<service_index::ServiceInfos>,
                             &infos);
      },
      Session::Milliseconds(0));
  return infos;
}

std::vector<FoundService> ask_at(const subscription::Host& host, const std::string& url,
                                 const KnownNode& known, Question& question) {
  const Url parsed = Url::parse(url);
  host.core->add_definition(service_index::definition);
  auto session = std::make_shared<Session>(host.core, parsed, ConnectOptions());
  session->set_limits(limits);
  host.keep(session);
  const channel::Interruption::Scope interruptible(question.interruption);
  const CallOptions options{call_limit, question.cancellation.get_token()};
  const CallOptionsScope scope(options);
  const auto stub = stub_cast<IndexStub>(session->connect(parsed, &service_index::index_stub_type));
  struct Leave {
    Session& session;
    ~Leave() { session.drop(); }
  } const leave{*session};
  const DetectedNode& node = known.node;
  if (session->remote_node() != node.id ||
      (!node.name.empty() && session->remote_name() != node.name)) {
    throw Error(ErrorCode::connection_error, "the node at `" + url + "` is not the announced one");
  }
  const service_index::ServiceInfos infos = ask_services(*session, stub->rr_path(), url);
  DetectedNode described = node;
  if (described.name.empty()) described.name = session->remote_name();
  std::vector<FoundService> services;
  if (infos) {
    for (const auto& [key, info] : *infos) {
      if (info && !info->Name.empty()) services.push_back(as_found(*info, described));
    }
  }
  return services;
}

}  // namespace

// In an order that does not depend on who was heard first: local ones, then IPv4, then IPv6.
bool add_urls(FoundService& service, const DetectedNode& node) {
  const std::size_t before = service.urls.size();
  for (const std::string& url : node.urls) {
    add_once(service.urls, service_index::exchange_service(url, service.name));
  }
  std::sort(service.urls.begin(), service.urls.end());
  return service.urls.size() != before;
}

std::vector<FoundService> ask_index(const subscription::Host& host, const KnownNode& node,
                                    Question& question) {
  const channel::Time deadline = channel::Clock::now() + connecting_limit;
  std::exception_ptr last;
  for (const std::string& url : node.node.urls) {
    if (question.interruption.is_interrupted() || channel::Clock::now() > deadline) break;
    try {
      return ask_at(host, url, node, question);
    } catch (const Error&) {
      last = std::current_exception();
    }
  }
  if (last) std::rethrow_exception(last);
  throw Error(ErrorCode::connection_error, "no way to ask the node");
}

}  // namespace rr::discovery
