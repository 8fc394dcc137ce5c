// SPDX-License-Identifier: Apache-2.0
#include "runtime/matlab/src/subscriptions.hpp"

#include "rr/error.hpp"
#include "runtime/matlab/src/credentials.hpp"

namespace rr::matlab {

SubscriptionHandle::SubscriptionHandle(Runtime& runtime, ServiceSubscription given)
    : subscription(std::move(given)), home(std::make_shared<Connection>(runtime)) {}

SubscriptionHandle::~SubscriptionHandle() { close(); }

void SubscriptionHandle::close() {
  home->close();
  for (const auto& [session, connection] : connections_) {
    if (const auto open = connection.lock()) open->close();
  }
  connections_.clear();
  subscription.close();
}

mxArray* SubscriptionHandle::give(Runtime& runtime, const std::shared_ptr<Stub>& stub) {
  dynamic::Object object = dynamic::Object::of(stub);
  std::erase_if(connections_, [](const auto& one) { return one.second.expired(); });
  auto& known = connections_[stub->rr_session().get()];
  auto connection = known.lock();
  if (!connection) {
    connection = std::make_shared<Connection>(runtime);
    known = connection;
  }
  connection->any_object = object;
  home->any_object = object;
  return give_object(runtime, std::move(connection), std::move(object));
}

mxArray* client_to_mex(const SubscriptionClientId& client) {
  return make_struct(
      {{"NodeID", make_text(client.node.text())}, {"ServiceName", make_text(client.service)}});
}

namespace {

// A field that need not be there.
const mxArray* find_field(const mxArray* record, const char* name, std::size_t index = 0) {
  if (!mxIsStruct(record)) throw Misfit("expected a struct, got " + described(record));
  const mxArray* const field = mxGetField(record, static_cast<mwIndex>(index), name);
  return field == nullptr || is_null(field) ? nullptr : field;
}

NodeFilter read_node(const mxArray* given, std::size_t index) {
  NodeFilter node;
  if (const mxArray* const id = find_field(given, "NodeID", index)) {
    const auto parsed = NodeId::parse(read_text(id));
    if (!parsed) throw Misfit("expected the id of a node");
    node.id = *parsed;
  }
  if (const mxArray* const name = find_field(given, "NodeName", index)) node.name = read_text(name);
  if (const mxArray* const user = find_field(given, "Username", index)) {
    node.username = read_text(user);
  }
  if (const mxArray* const credentials = find_field(given, "Credentials", index)) {
    node.credentials = read_credentials(credentials);
  }
  return node;
}

std::map<std::string, AttributeGroup> read_attributes(const mxArray* given) {
  std::map<std::string, AttributeGroup> attributes;
  if (!mxIsStruct(given)) throw Misfit("expected a struct of texts, got " + described(given));
  for (int i = 0; i < mxGetNumberOfFields(given); ++i) {
    const std::string name = mxGetFieldNameByNumber(given, i);
    AttributeGroup group;
    for (std::string& text : read_texts(read_field(given, name.c_str()))) {
      group.tests.push_back({.value = std::move(text)});
    }
    attributes.emplace(name, std::move(group));
  }
  return attributes;
}

}  // namespace

ServiceFilter read_filter(const mxArray* given) {
  return as_subject("filter", [&] {
    ServiceFilter filter;
    if (is_null(given)) return filter;
    if (const mxArray* const nodes = find_field(given, "Nodes")) {
      for (std::size_t i = 0; i < count_of(nodes); ++i) filter.nodes.push_back(read_node(nodes, i));
    }
    if (const mxArray* const names = find_field(given, "ServiceNames")) {
      filter.service_names = read_texts(names);
    }
    if (const mxArray* const schemes = find_field(given, "TransportSchemes")) {
      filter.transport_schemes = read_texts(schemes);
    }
    if (const mxArray* const attributes = find_field(given, "Attributes")) {
      filter.attributes = read_attributes(attributes);
    }
    if (const mxArray* const count = find_field(given, "MaxConnections")) {
      filter.max_connections = read_number<std::uint32_t>(count);
    }
    return filter;
  });
}

mxArray* services_to_mex(const std::vector<FoundService>& services) {
  constexpr int field_count = 7;
  const char* names[field_count] = {"Name",          "RootObjectType", "RootObjectImplements",
                                    "ConnectionURL", "NodeID",         "NodeName",
                                    "Attributes"};
  mxArray* const found =
      mxCreateStructMatrix(static_cast<mwSize>(services.size()), 1, field_count, names);
  const auto cells = [](const std::vector<std::string>& texts) {
    std::vector<mxArray*> items;
    for (const std::string& text : texts) items.push_back(make_text(text));
    return make_cells(items);
  };
  for (std::size_t i = 0; i < services.size(); ++i) {
    const FoundService& service = services[i];
    const auto set = [&](int field, mxArray* value) {
      mxSetFieldByNumber(found, static_cast<mwIndex>(i), field, value);
    };
    set(0, make_text(service.name));
    set(1, make_text(service.object_type));
    set(2, cells(service.implements));
    set(3, cells(service.urls));
    set(4, make_text(service.node.text()));
    set(5, make_text(service.node_name));
    std::map<std::string, mxArray*> attributes;
    for (const auto& [name, value] : service.attributes) {
      const auto* const text = value.get_if<std::string>();
      attributes.emplace(name, text != nullptr ? make_text(*text) : make_null());
    }
    set(6, make_map(attributes));
  }
  return found;
}

}  // namespace rr::matlab
