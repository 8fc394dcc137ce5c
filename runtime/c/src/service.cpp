// SPDX-License-Identifier: Apache-2.0
// Services and their clients.
#include <utility>

#include "runtime/c/src/node.hpp"
#include "runtime/c/src/security.hpp"
#include "runtime/c/src/served_object.hpp"
#include "runtime/c/src/users.hpp"

namespace rr::capi {
namespace {

rr_client_info info_of(const ServiceClient& client) {
  rr_client_info info{};
  info.size = sizeof info;
  info.client = client.endpoint;
  info.node = id_of(client.node);
  info.node_name = view(client.node_name);
  info.user = view(client.user);
  info.session = client.session;
  return info;
}

ServiceOptions read_options(const rr_service_options& given,
                            const std::shared_ptr<Context>& context, Keeper& keeper) {
  ServiceOptions options;
  options.attributes = read_map(given.attributes);
  for (std::size_t i = 0; i < given.extra_definition_count; ++i) {
    const auto* const extra = (&need(given.extra_definitions, "there are no definitions"))[i];
    const auto& definition = need(extra, "a definition is NULL").definition;
    keeper.keep(definition);
    options.extra_imports.push_back(&definition->definition());
  }
  if (given.users != nullptr) options.users = given.users->users;
  options.require_user = given.user_is_optional == 0;
  if (given.monitor_patience_ms != 0) {
    options.monitor_patience = duration(given.monitor_patience_ms);
  }
  options.rights = read_rights(given.rights);
  options.rights_file = text(given.rights_file);
  // Both always, since it is they that keep the context.
  options.on_client_connected = [call = given.on_client_connected,
                                 context](const ServiceClient& client) {
    const rr_client_info info = info_of(client);
    if (call != nullptr) call(context->data(), &info);
  };
  options.on_client_disconnected = [call = given.on_client_disconnected,
                                    context](const ServiceClient& client) {
    const rr_client_info info = info_of(client);
    if (call != nullptr) call(context->data(), &info);
  };
  if (given.on_client_leaving != nullptr) {
    options.on_client_leaving = [call = given.on_client_leaving,
                                 context](const ServiceClient& client) {
      const rr_client_info info = info_of(client);
      call(context->data(), &info);
    };
  }
  return options;
}

// Throws rr::Error when the service has ended.
std::shared_ptr<ServiceContext> context_of(const rr_service* service) {
  auto context = need(service, "there is no service").context.lock();
  if (!context) throw Error(ErrorCode::invalid_operation, "the service has ended");
  return context;
}

}  // namespace
}  // namespace rr::capi

using rr::capi::context_of;
using rr::capi::guarded;
using rr::capi::guarded_or;
using rr::capi::need;
using rr::capi::output;
using rr::capi::text;

extern "C" {

rr_status rr_service_register(rr_node* node, rr_str name, rr_served_object* root,
                              const rr_service_options* options, rr_service** out_service,
                              rr_error** error) {
  return guarded(error, [&] {
    if (out_service != nullptr) *out_service = nullptr;
    const rr_service_options given = rr::capi::known(options);
    const auto context = std::make_shared<rr::capi::Context>(given.context, given.drop);
    const rr_node& of = need(node, "there is no node");
    const auto& object = need(root, "there is no root object").skeleton;
    rr::ServiceOptions read = rr::capi::read_options(given, context, *of.keeper);
    auto handle = std::make_unique<rr_service>();
    object->join(of.keeper);
    const rr::Service service =
        of.node->register_service(std::string(text(name)), object, std::move(read));
    handle->context = service.context();
    handle->name = service->name();
    if (out_service != nullptr) *out_service = handle.release();
  });
}

void rr_service_release(rr_service* service) { rr::capi::release(service); }

void rr_service_close(rr_service* service) {
  guarded_or(0, [&] {
    context_of(service)->close();
    return 0;
  });
}

rr_str rr_service_name(const rr_service* service) {
  return service != nullptr ? rr::capi::view(service->name) : rr_str{};
}

rr_status rr_service_set_attributes(rr_service* service, const rr_elements* attributes,
                                    rr_error** error) {
  return guarded(error, [&] {
    const auto context = context_of(service);
    context->set_attributes(rr::capi::read_map(need(attributes, "there are no attributes")));
  });
}

rr_status rr_service_set_rights(rr_service* service, const rr_str* rights, rr_error** error) {
  return guarded(error, [&] { context_of(service)->set_rights(rr::capi::read_rights(rights)); });
}

rr_status rr_service_release_path(rr_service* service, rr_str path, uint32_t client,
                                  rr_error** error) {
  return guarded(error, [&] {
    const auto context = context_of(service);
    if (client == 0) {
      context->release_path(std::string(text(path)));
    } else {
      context->release_path(std::string(text(path)), client);
    }
  });
}

rr_status rr_service_clients(const rr_service* service, void* context,
                             void (*each)(void* context, const rr_client_info* client),
                             rr_error** error) {
  return guarded(error, [&] {
    const auto of = context_of(service);
    need(each, "a function is NULL that is needed");
    for (const rr::ServiceClient& client : of->clients()) {
      const rr_client_info info = rr::capi::info_of(client);
      each(context, &info);
    }
  });
}

void rr_service_disconnect(rr_service* service, uint32_t client) {
  guarded_or(0, [&] {
    context_of(service)->disconnect(client);
    return 0;
  });
}

uint32_t rr_current_client(void) {
  return guarded_or(0U, [] { return rr::ServiceContext::current_client(); });
}

rr_status rr_current_user(rr_data** out_name, rr_error** error) {
  return guarded(error, [&] {
    output(out_name) = nullptr;
    if (const auto user = rr::ServiceContext::current_user()) {
      *out_name = rr::capi::Data::text(user->name).hand_out();
    }
  });
}

int32_t rr_current_user_has(rr_str privilege) {
  return guarded_or(0, [&] {
    const auto user = rr::ServiceContext::current_user();
    return user && user->has(text(privilege)) ? 1 : 0;
  });
}

}  // extern "C"
