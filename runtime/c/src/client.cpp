// SPDX-License-Identifier: Apache-2.0
// Sessions, objects and requests to their members.
#include <utility>

#include "rr/locks.hpp"
#include "rr/type.hpp"
#include "runtime/c/src/node.hpp"
#include "runtime/cpp/src/client/session.hpp"
#include "runtime/cpp/src/endpoint/service_path.hpp"

namespace rr::capi {

rr_object* make_object(std::shared_ptr<Stub> stub) {
  auto raw = std::dynamic_pointer_cast<RawStub>(std::move(stub));
  if (!raw) throw Error(ErrorCode::internal_error, "a stub of another kind");
  return new rr_object{std::move(raw)};
}

namespace {

// A request that the program makes of elements of its own.
class Request {
 public:
  Request(const RawStub& stub, std::uint32_t type, rr_str member, const rr_elements* elements,
          const Terms& terms)
      : values_(elements),
        outgoing_{.type = check_type(type),
                  .path = stub.rr_path(),
                  .member = text(member),
                  .parameters = values_.parameters(),
                  .values = values_.places(),
                  .is_urgent = (terms.access() & RR_URGENT) != 0} {}
  [[nodiscard]] const Outgoing& outgoing() const { return outgoing_; }

 private:
  static EntryType check_type(std::uint32_t type) {
    switch (type) {
      case RR_PROPERTY_GET:
      case RR_PROPERTY_SET:
      case RR_FUNCTION_CALL:
      case RR_MEMORY_READ:
      case RR_MEMORY_WRITE:
      case RR_MEMORY_GET_PARAM:
        return static_cast<EntryType>(type);
      default:
        refuse_argument("this is no request to a member");
    }
  }

  const Values values_;
  const Outgoing outgoing_;
};

// Calls `find` with the index as the runtime takes it.
template <class Find>
auto with_index(const rr_index* index, const Find& find) {
  if (index == nullptr || index->form == RR_INDEX_NONE) return find();
  if (index->form == RR_INDEX_INT32) return find(index->number);
  if (index->form != RR_INDEX_STRING) refuse_argument("there is no such form of an index");
  return find(text(index->text));
}

// An objref as the runtime knows it, for the one call.
Member objref_to(rr_str member, rr_str type) {
  return {.kind = MemberKind::objref, .name = text(member), .object_type = text(type)};
}

std::string path_of(const RawStub& stub, rr_str member, const rr_index* index) {
  std::string path = stub.rr_path() + "." + std::string(text(member));
  if (index == nullptr || index->form == RR_INDEX_NONE) return path;
  const std::string item = index->form == RR_INDEX_INT32 ? std::to_string(index->number)
                                                         : std::string(text(index->text));
  return path + "[" + endpoint::escape_index(item) + "]";
}

Session& session_of(const rr_client* client) {
  const auto& session = need(client, "there is no client").client.rr_session();
  return *session;
}

}  // namespace
}  // namespace rr::capi

using rr::capi::guarded;
using rr::capi::guarded_or;
using rr::capi::need;
using rr::capi::output;
using rr::capi::stub_of;
using rr::capi::Terms;

extern "C" {

void rr_client_release(rr_client* client) { rr::capi::release(client); }

void rr_client_close(rr_client* client) {
  guarded_or(0, [&] {
    if (client != nullptr) client->client.close();
    return 0;
  });
}

int32_t rr_client_is_open(const rr_client* client) {
  return guarded_or(0, [&] { return client != nullptr && client->client.is_open() ? 1 : 0; });
}

void rr_client_cancel_calls(rr_client* client) {
  guarded_or(0, [&] {
    if (client != nullptr) client->client.cancel_calls();
    return 0;
  });
}

uint32_t rr_client_message_version(const rr_client* client) {
  return guarded_or(0U, [&] {
    return static_cast<uint32_t>(rr::capi::session_of(client).connection().version());
  });
}

rr_node_id rr_client_remote_node(const rr_client* client) {
  return client != nullptr ? rr::capi::id_of(client->client.remote_node()) : rr_node_id{};
}

rr_str rr_client_remote_name(const rr_client* client) {
  return client != nullptr ? rr::capi::view(client->client.remote_name()) : rr_str{};
}

rr_str rr_client_object_type(const rr_client* client) {
  return client != nullptr ? rr::capi::view(client->client.object_type()) : rr_str{};
}

rr_status rr_client_root(rr_client* client, rr_object** out_object, rr_error** error) {
  return guarded(error, [&] {
    output(out_object) = nullptr;
    *out_object = new rr_object{need(client, "there is no client").root};
  });
}

rr_status rr_client_definitions(const rr_client* client, rr_data** out_data, rr_error** error) {
  return guarded(error, [&] {
    output(out_data) = nullptr;
    const auto texts = need(client, "there is no client").client.definitions();
    rr::Writer writer;
    writer.reset(rr::MessageVersion::v4);
    for (auto text = texts.rbegin(); text != texts.rend(); ++text) {
      writer.string_element(text->first, text->second);
    }
    *out_data =
        rr::capi::Data::copy(writer.copy(), static_cast<uint32_t>(texts.size()), 4).hand_out();
  });
}

rr_status rr_client_attributes(const rr_client* client, rr_data** out_data, rr_error** error) {
  return guarded(error, [&] {
    output(out_data) = nullptr;
    const rr::VarStringMap& map = need(client, "there is no client").client.attributes();
    *out_data = rr::capi::write_data(rr::type_of<rr::VarStringMap>, &map, "attributes").hand_out();
  });
}

rr_status rr_client_fetch_attributes(rr_client* client, rr_data** out_data, rr_error** error) {
  return guarded(error, [&] {
    output(out_data) = nullptr;
    const rr::VarStringMap map = need(client, "there is no client").client.fetch_attributes();
    *out_data = rr::capi::write_data(rr::type_of<rr::VarStringMap>, &map, "attributes").hand_out();
  });
}

rr_status rr_client_authenticate(rr_client* client, rr_str username, rr_str password,
                                 const rr_elements* credentials, rr_error** error) {
  return guarded(error, [&] {
    rr::ClientBase& of = need(client, "there is no client").client;
    std::map<std::string, rr::VarValue> map;
    if (credentials != nullptr && credentials->count != 0) {
      map = rr::capi::read_map(*credentials);
    } else {
      map.emplace("password", std::string(rr::capi::text(password)));
    }
    of.authenticate(std::string(rr::capi::text(username)), map);
  });
}

rr_status rr_client_logout(rr_client* client, rr_error** error) {
  return guarded(error, [&] { need(client, "there is no client").client.logout(); });
}

void rr_object_release(rr_object* object) { rr::capi::release(object); }

rr_str rr_object_path(const rr_object* object) {
  return object != nullptr ? rr::capi::view(object->stub->rr_path()) : rr_str{};
}

rr_str rr_object_type_name(const rr_object* object) {
  return object != nullptr ? rr::capi::view(object->stub->rr_object_type().name) : rr_str{};
}

int32_t rr_object_is_a(const rr_object* object, rr_str type) {
  return guarded_or(0, [&] {
    const rr::capi::RawStub& stub = stub_of(object);
    return stub.tables().is_a(stub.rr_object_type().name, rr::capi::text(type)) ? 1 : 0;
  });
}

rr_status rr_object_find(rr_object* object, rr_str member, const rr_index* index, rr_str type,
                         const rr_call_options* options, rr_object** out_object, rr_error** error) {
  return guarded(error, [&] {
    output(out_object) = nullptr;
    rr::capi::RawStub& stub = stub_of(object);
    const Terms terms(options);
    const rr::Member objref = rr::capi::objref_to(member, type);
    *out_object = rr::capi::make_object(rr::capi::with_index(
        index, [&](const auto&... item) { return stub.rr_find(objref, {}, item...); }));
  });
}

rr_status rr_object_find_async(rr_object* object, rr_str member, const rr_index* index, rr_str type,
                               const rr_call_options* options, const rr_completion* completion,
                               rr_error** error) {
  return guarded(error, [&] {
    rr::capi::RawStub& stub = stub_of(object);
    const Terms terms(options);
    const rr::Member objref = rr::capi::objref_to(member, type);
    auto done = rr::capi::complete<std::shared_ptr<rr::Stub>>(
        completion, [](std::shared_ptr<rr::Stub>& found) -> void* {
          return rr::capi::make_object(std::move(found));
        });
    rr::capi::with_index(
        index, [&](const auto&... item) { stub.rr_start_find(objref, item..., std::move(done)); });
  });
}

rr_status rr_object_find_type(rr_object* object, rr_str member, const rr_index* index,
                              const rr_call_options* options, rr_data** out_data,
                              rr_error** error) {
  return guarded(error, [&] {
    output(out_data) = nullptr;
    const rr::capi::RawStub& stub = stub_of(object);
    const Terms terms(options);
    *out_data = rr::capi::Data::text(
                    stub.rr_session()->ask_object_type(rr::capi::path_of(stub, member, index), {}))
                    .hand_out();
  });
}

rr_status rr_object_call(rr_object* object, uint32_t request, rr_str member,
                         const rr_elements* elements, const rr_call_options* options,
                         rr_data** out_answer, rr_error** error) {
  return guarded(error, [&] {
    output(out_answer) = nullptr;
    const rr::capi::RawStub& stub = stub_of(object);
    const Terms terms(options);
    const rr::capi::Request asked(stub, request, member, elements, terms);
    rr::capi::Data answer;
    const rr::Session::AnswerReader read = [&answer](rr::Decoder& decoder, const rr::Message&,
                                                     const rr::Entry& entry) {
      answer = rr::capi::read_entry(decoder, entry);
    };
    stub.rr_session()->call(asked.outgoing(), read, stub.rr_timeout());
    *out_answer = std::move(answer).hand_out();
  });
}

rr_status rr_object_call_async(rr_object* object, uint32_t request, rr_str member,
                               const rr_elements* elements, const rr_call_options* options,
                               const rr_completion* completion, rr_error** error) {
  return guarded(error, [&] {
    const rr::capi::RawStub& stub = stub_of(object);
    const Terms terms(options);
    const rr::capi::Request asked(stub, request, member, elements, terms);
    auto done = rr::capi::complete<rr::capi::Data>(
        completion, [](rr::capi::Data& answer) -> void* { return std::move(answer).hand_out(); });
    rr::capi::Data& place = done->place();
    stub.rr_session()->start(
        asked.outgoing(),
        [&place](rr::Decoder& decoder, const rr::Message&, const rr::Entry& entry) {
          place = rr::capi::read_entry(decoder, entry);
        },
        stub.rr_timeout(), std::move(done));
  });
}

rr_status rr_object_lock(rr_object* object, int32_t session_only, const rr_call_options* options,
                         rr_error** error) {
  return guarded(error, [&] {
    const Terms terms(options);
    rr::lock(stub_of(object), session_only != 0 ? rr::LockOwner::session : rr::LockOwner::user);
  });
}

rr_status rr_object_unlock(rr_object* object, const rr_call_options* options, rr_error** error) {
  return guarded(error, [&] {
    const Terms terms(options);
    rr::unlock(stub_of(object));
  });
}

rr_status rr_object_enter_monitor(rr_object* object, int32_t wait_ms,
                                  const rr_call_options* options, rr_error** error) {
  return guarded(error, [&] {
    const Terms terms(options);
    rr::enter_monitor(stub_of(object), rr::capi::patience(wait_ms));
  });
}

rr_status rr_object_exit_monitor(rr_object* object, const rr_call_options* options,
                                 rr_error** error) {
  return guarded(error, [&] {
    const Terms terms(options);
    rr::exit_monitor(stub_of(object));
  });
}

}  // extern "C"
