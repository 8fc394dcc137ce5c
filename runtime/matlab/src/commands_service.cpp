// SPDX-License-Identifier: Apache-2.0
// Services that the interpreter offers.
#include <optional>
#include <set>
#include <utility>

#include "rr/error.hpp"
#include "rr/users.hpp"
#include "runtime/matlab/src/credentials.hpp"
#include "runtime/matlab/src/served.hpp"
#include "runtime/matlab/src/struct_fields.hpp"

namespace rr::matlab {
namespace {

using dynamic::List;
using dynamic::MemberDescription;
using dynamic::Value;

struct ServiceHandle final : Handled {
  explicit ServiceHandle(Service given) : service(std::move(given)) {}
  const Service service;
};

List read_parameters(const ServedHandle& served, const MemberDescription& member, Call& call,
                     std::size_t first) {
  List arguments;
  for (std::size_t i = first; call.has(i); ++i) {
    // What is too much is refused by the runtime, which says what the parameters are.
    if (arguments.size() >= member.parameters.size()) {
      arguments.emplace_back();
      continue;
    }
    const auto& [name, type] = member.parameters[arguments.size()];
    arguments.push_back(served.read(call[i], type, member.name + ", parameter " + name));
  }
  return arguments;
}

// service_type(text): makes a definition known
void service_type(Runtime& runtime, Call& call) {
  const std::string text = call.text(0);
  for (const std::string& known : runtime.service_types) {
    if (known == text) return;
  }
  runtime.service_types.push_back(text);
  runtime.served_types.reset();
}

// serve(type, dispatch): number of an object that is asked by `dispatch(kind, member, ...)`
void serve(Runtime& runtime, Call& call) {
  if (!runtime.served_types) {
    try {
      runtime.served_types =
          std::make_shared<ServedTypes>(dynamic::Definitions(runtime.service_types));
    } catch (const Error&) {
      runtime.service_types.pop_back();  // of those before nothing was wrong
      throw;
    }
  }
  call.give(give_handle(runtime, std::make_shared<ServedHandle>(runtime, runtime.served_types,
                                                                call.text(0), call[1])));
}

// served_members(object): names, and their declarations
void served_members(Runtime& runtime, Call& call) {
  const auto served = served_of(runtime, call);
  std::vector<mxArray*> names;
  std::vector<mxArray*> declarations;
  for (const MemberDescription& member : served->object.members()) {
    names.push_back(make_text(member.name));
    declarations.push_back(make_text(member.declaration));
  }
  call.give(make_cells(names));
  call.give(make_cells(declarations));
}

// register_service(name, object, options): number; the options are those of
// RobotRaconteur.RegisterService
void register_service(Runtime& runtime, Call& call) {
  const auto served = runtime.handles().get<ServedHandle>(call.handle(1));
  ServiceOptions options;
  std::optional<std::set<std::string>> extra;
  read_fields(
      call[2], "service options",
      {{"Attributes",
        [&](const mxArray* given) {
          options.attributes = read_varvalues(given, "attributes", "a containers.Map or a struct");
        }},
       {"Users",
        [&](const mxArray* given) {
          const std::string users = read_text(given);
          if (!users.empty()) options.users = std::make_shared<PasswordUsers>(users);
        }},
       {"RequireUser", read_into(options.require_user)},
       {"ExtraImports",
        [&](const mxArray* given) {
          if (!mxIsCell(given)) return;  // `[]`: all, as without it
          const std::vector<std::string> names = read_texts(given);
          extra.emplace(names.begin(), names.end());
        }},
       {"Rights",
        [&](const mxArray* given) { options.rights = std::make_shared<Rights>(read_text(given)); }},
       {"RightsFile", read_into(options.rights_file)}});
  const Service service = dynamic::register_service(runtime.node(), call.text(0), served->object,
                                                    std::move(options), extra);
  call.give(give_handle(runtime, std::make_shared<ServiceHandle>(service)));
}

// unregister_service(service): requests that wait are answered meanwhile
void unregister_service(Runtime& runtime, Call& call) {
  const auto handle = runtime.handles().get<ServiceHandle>(call.handle(0));
  const auto has_ended = std::make_shared<std::atomic<bool>>(false);
  runtime.node().run_aside([service = handle->service, has_ended, queue = runtime.queue()] {
    service->close();
    *has_ended = true;
    queue->wake();
  });
  runtime.wait_until([&] { return has_ended->load(); }, std::chrono::milliseconds::max());
  runtime.handles().remove(call.handle(0));
}

// set_rights(service, text): with `[]` for the text everything is allowed
void set_rights(Runtime& runtime, Call& call) {
  const auto handle = runtime.handles().get<ServiceHandle>(call.handle(0));
  const bool is_all = mxIsNumeric(call[1]) && count_of(call[1]) == 0;
  handle->service->set_rights(is_all ? nullptr : std::make_shared<const Rights>(call.text(1)));
}

// service_clients(service): numbers of the clients, a column
void service_clients(Runtime& runtime, Call& call) {
  std::vector<std::uint32_t> numbers;
  const auto handle = runtime.handles().get<ServiceHandle>(call.handle(0));
  for (const ServiceClient& client : handle->service->clients()) {
    numbers.push_back(client.endpoint);
  }
  call.give(make_column<std::uint32_t>(numbers));
}

// release_path(service, path)
void release_path(Runtime& runtime, Call& call) {
  runtime.handles().get<ServiceHandle>(call.handle(0))->service->release_path(call.text(1));
}

// listen_tcp(port, address): the port; without an address that of this machine
void listen_tcp(Runtime& runtime, Call& call) {
  const auto port = read_number<std::uint16_t>(call[0]);
  const std::string address = call.has(1) ? call.text(1) : std::string();
  const std::uint16_t given =
      address.empty() ? runtime.node().listen_tcp(port) : runtime.node().listen_tcp(port, address);
  call.give(mxCreateDoubleScalar(given));
}

// listen_url(url): listens there, as at `rr+local:///path`
void listen_url(Runtime& runtime, Call& call) { runtime.node().listen(call.text(0)); }

// serve_for(seconds): answers requests and runs handlers so long; how many requests
void serve_for(Runtime& runtime, Call& call) {
  const std::uint64_t before = runtime.served_count;
  (void)runtime.wait_until(
      [&] {
        runtime.run_queue();
        return false;
      },
      call.seconds(0));
  call.give(mxCreateDoubleScalar(static_cast<double>(runtime.served_count - before)));
}

// current_client(): whose request is answered; 0 for none
void current_client(Runtime& runtime, Call& call) {
  call.give(make_number<std::uint32_t>(runtime.current_client));
}

// fire(object, event, arguments...)
void fire(Runtime& runtime, Call& call) {
  const auto served = served_of(runtime, call);
  const MemberDescription member = served->object.member(call.text(1));
  served->object.fire(member.name, read_parameters(*served, member, call, 2));
}

// call_back(object, callback, client, arguments...): result
void call_back(Runtime& runtime, Call& call) {
  const auto served = served_of(runtime, call);
  const MemberDescription member = served->object.member(call.text(1));
  const auto client = read_number<std::uint32_t>(call[2]);
  const List arguments = read_parameters(*served, member, call, 3);
  const Value result = runtime.call<Value>(
      [&] { return served->object.call_back(member.name, client, arguments); },
      [&](auto done) {
        served->object.async_call_back(member.name, client, arguments, std::move(done));
      });
  if (member.type.kind() == dynamic::Kind::null) return call.give(make_null());
  call.give(served->write(member.type, result));
}

}  // namespace

std::vector<Command> service_commands() {
  return {{"service_type", service_type},
          {"serve", serve},
          {"served_members", served_members},
          {"register_service", register_service},
          {"unregister_service", unregister_service},
          {"set_rights", set_rights},
          {"service_clients", service_clients},
          {"release_path", release_path},
          {"listen_tcp", listen_tcp},
          {"listen_url", listen_url},
          {"serve_for", serve_for},
          {"current_client", current_client},
          {"fire", fire},
          {"call_back", call_back}};
}

}  // namespace rr::matlab
