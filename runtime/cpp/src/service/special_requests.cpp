// SPDX-License-Identifier: Apache-2.0
// Requests that need no session (07, sections 1, 4 and 5).
#include <atomic>
#include <optional>
#include <utility>

#include "runtime/cpp/src/endpoint/client_version.hpp"
#include "runtime/cpp/src/endpoint/errors.hpp"
#include "runtime/cpp/src/endpoint/requests.hpp"
#include "runtime/cpp/src/endpoint/values.hpp"
#include "runtime/cpp/src/service/decoded_memory.hpp"
#include "runtime/cpp/src/service/directory.hpp"
#include "runtime/cpp/src/service/object_types.hpp"
#include "runtime/cpp/src/service/server_endpoint.hpp"
#include "runtime/cpp/src/service/service_host.hpp"

namespace rr::service {
namespace {

// Nobody asks so much at once; what is more ends the connection.
constexpr std::uint32_t most_special_entries = 16;

// Whatever goes wrong with a special request is told in these words; the names are the reference's.
Error service_not_found() {
  return {ErrorCode::service_not_found, "RobotRaconteur.ServiceNotFoundException",
          "Service not found"};
}
Error object_not_found() {
  return {ErrorCode::object_not_found, "RobotRaconteur.ObjectNotFoundException",
          "Object not found"};
}
Error no_route() { return {ErrorCode::node_not_found, "Could not find route to remote node"}; }
Error attributes_not_found() { return {ErrorCode::service_error, "Service not found"}; }

std::optional<DefinitionVersion> client_version(Decoder& decoder, const Entry& entry) {
  std::string_view text;
  if (!endpoint::find_text(decoder, entry, "clientversion", text)) return std::nullopt;
  return endpoint::parse_version(text);
}

std::uint32_t write_texts(Writer& writer, std::string_view name,
                          std::span<const std::string_view> texts) {
  if (texts.empty()) return 0;
  const std::vector<std::string> list(texts.begin(), texts.end());
  type_of<std::vector<std::string>>.write(writer, name, &list);
  return 1;
}

std::uint32_t write_map(Writer& writer, std::string_view name,
                        const std::map<std::string, VarValue>& map) {
  type_of<VarStringMap>.write(writer, name, &map);
  return 1;
}

bool wants_definitions(Decoder& decoder, const Entry& entry) {
  std::string_view text;
  if (!endpoint::find_text(decoder, entry, "returnservicedefs", text)) return true;
  std::string lower(text);
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  return lower != "false" && lower != "0";
}

}  // namespace

// A special request travels alone: what comes behind it in its message is refused, and so is a
// connection that makes a habit of it.
void ServerEndpoint::handle_special(const Message& message, const Entry& first) {
  const NodeOptions& own = directory_->core()->options();
  const bool is_for_us = message.receiver_node == own.id ||
                         (message.receiver_node.is_any() &&
                          (message.receiver_name.empty() || message.receiver_name == own.name));
  std::uint32_t own_endpoint = message.receiver_endpoint;
  if (message.entry_count > most_special_entries) {
    connection_->close(Error(ErrorCode::protocol_error, "a message has too many special requests"));
    return;
  }

  Writer writer;  // not the thread's: user code runs on the way to objects, and hears of clients
  writer.reset(connection_->version());
  if (is_for_us) {
    write_special_answer(writer, message, first, own_endpoint);
  } else {
    endpoint::write_error_answer(writer, first, no_route());
  }
  if (connection_->is_closed()) return;
  if (message.entry_count > 1) add_refusals(writer, message, is_for_us);
  // What is not for us is answered in the name of whom it was for.
  writer.message({.sender_node = is_for_us ? own.id : message.receiver_node,
                  .receiver_node = message.sender_node,
                  .sender_name = is_for_us ? std::string_view(own.name) : message.receiver_name,
                  .receiver_name = message.sender_name,
                  .sender_endpoint = own_endpoint,
                  .receiver_endpoint = message.sender_endpoint},
                 message.entry_count);
  try {
    connection_->reply(writer, channel::Priority::fixed);
  } catch (const Error& error) {
    directory_->core()->log(LogLevel::error, error.what());
    // The client would wait for it.
    if (error.code() == ErrorCode::out_of_system_resource) connection_->close(error);
  }
  if (is_leaving_) leave();
}

// Puts refusals of the other entries behind the answer to the first one.
void ServerEndpoint::add_refusals(Writer& writer, const Message& message, bool is_for_us) {
  const Error refusal =
      is_for_us ? Error(ErrorCode::protocol_error, "a special request must be alone in its message")
                : no_route();
  Writer refusals;
  std::vector<std::byte> answers = writer.copy();
  EntryReader entries(message);
  Entry entry;
  entries.next(entry);
  while (entries.next(entry)) {
    refusals.reset(writer.version());
    endpoint::write_error_answer(refusals, entry, refusal);
    const std::vector<std::byte> one = refusals.copy();
    answers.insert(answers.end(), one.begin(), one.end());
  }
  writer.reset(writer.version());
  writer.prepend_bytes(answers.data(), answers.size());
}

// One whole entry.
void ServerEndpoint::write_special_answer(Writer& writer, const Message& message,
                                          const Entry& entry, std::uint32_t& own_endpoint) {
  Decoder decoder(message.version, &message.strings);
  DecodedMemory decoded(*this);
  decoder.set_budget(decoded);
  const auto attempt = [&](const Error& failure, auto&& write) {
    const MessageVersion version = writer.version();
    const channel::Time begun = channel::Clock::now();
    std::optional<Error> error;
    try {
      const std::uint32_t count = write();
      if (!writer.failed()) {
        writer.entry(endpoint::answer_header(entry), count, 0);
        this->count(entry.type, begun, ErrorCode::none);
        return;
      }
      error = failure;
    } catch (const Error& thrown) {
      const bool is_told = thrown.code() == ErrorCode::authentication_error ||
                           thrown.code() == ErrorCode::out_of_system_resource;
      error = is_told ? thrown : failure;
    } catch (...) {  // user code, on the way to an object
      error = failure;
    }
    this->count(entry.type, begun, error->code());
    writer.reset(version);
    endpoint::write_error_answer(writer, entry, *error);
  };
  switch (entry.type) {
    case EntryType::get_node_info:
      endpoint::write_empty_answer(writer, entry);
      break;
    case EntryType::node_check_capability:
      endpoint::write_capability_answer(writer, entry);
      break;
    case EntryType::get_service_desc:
      attempt(service_not_found(),
              [&] { return write_service_definition(writer, decoder, entry); });
      break;
    case EntryType::object_type_name:
      attempt(object_not_found(), [&] { return write_object_type(writer, decoder, entry); });
      break;
    case EntryType::get_service_attributes:
      attempt(attributes_not_found(), [&] { return write_attributes(writer, entry); });
      break;
    case EntryType::connect_client:
    case EntryType::connect_client_combined:
      if (host_) {  // a second one ends the connection (04, section 8)
        connection_->close(Error(ErrorCode::protocol_error, "a client connects a second time"));
        return;
      }
      attempt(service_not_found(),
              [&] { return connect(writer, decoder, message, entry, own_endpoint); });
      break;
    case EntryType::disconnect_client:
      attempt(service_not_found(), [&] { return disconnect(decoder, message, entry); });
      break;
    default:
      endpoint::write_error_answer(writer, entry,
                                   Error(ErrorCode::protocol_error, "Invalid Special Operation"));
      break;
  }
}

// Elements are written last first, here and below.
std::uint32_t ServerEndpoint::write_service_definition(Writer& writer, Decoder& decoder,
                                                       const Entry& entry) {
  std::string_view name;
  if (endpoint::find_text(decoder, entry, "ServiceType", name) ||
      endpoint::find_text(decoder, entry, "servicetype", name)) {
    const Definition* const definition = directory_->core()->types()->find_definition(name);
    if (definition == nullptr) throw service_not_found();
    writer.string_element("servicedef", definition->text);
    return 1;
  }
  const auto host = directory_->find(entry.service_path);
  if (!host) throw service_not_found();
  std::vector<std::string_view> extra;
  for (const Definition* definition : host->extra_imports()) extra.push_back(definition->name);
  writer.string_element("servicedef", host->root().rr_object_type().definition.text);
  std::uint32_t count = 1;
  count += write_texts(writer, "extraimports", extra);
  count += write_map(writer, "attributes", host->attributes());
  return count;
}

std::uint32_t ServerEndpoint::write_object_type(Writer& writer, Decoder& decoder,
                                                const Entry& entry) {
  const std::string_view path = entry.service_path;
  const auto host = directory_->find(path.substr(0, path.find('.')));
  if (!host) throw object_not_found();
  // Objects other than the root may be for users only, and here nobody is one yet.
  if (!may_stranger_describe(*host, path)) throw object_not_found();
  const auto object = host->objects().find(path, 0);
  const auto type = type_for(*object->type, client_version(decoder, entry));
  if (!type) throw object_not_found();
  const std::uint32_t count = write_texts(writer, "objectimplements", object->type->implements);
  writer.string_element("objecttype", *type);
  return count + 1;
}

std::uint32_t ServerEndpoint::write_attributes(Writer& writer, const Entry& entry) {
  const auto host = directory_->find(entry.service_path);
  if (!host) throw attributes_not_found();
  return write_map(writer, "return", host->attributes());
}

std::uint32_t ServerEndpoint::connect(Writer& writer, Decoder& decoder, const Message& message,
                                      const Entry& entry, std::uint32_t& own_endpoint) {
  const auto host = directory_->find(entry.service_path);
  if (!host) throw service_not_found();
  if (entry.type == EntryType::connect_client) {
    own_endpoint = join(host, message);
    return 0;
  }
  const auto type = host->root_type_for(client_version(decoder, entry));
  if (!type) throw service_not_found();
  const bool with_definitions = wants_definitions(decoder, entry);
  std::string_view user;
  Element credentials;
  const bool has_user =
      endpoint::find_text(decoder, entry, "username", user) &&
      find_element(decoder, entry.elements, entry.element_count, "credentials", credentials);
  own_endpoint = join(host, message);
  // Where none is needed it is an error to name a user (07, section 5).
  if (has_user != host->requires_user() || (has_user && !let_in(decoder, user, credentials))) {
    quit();
    throw Error(ErrorCode::authentication_error, "Authentication Failed");
  }
  std::uint32_t count = write_map(writer, "attributes", host->attributes());
  if (with_definitions) {
    std::vector<std::string_view> texts;
    for (const Definition* definition : host->definitions()) texts.push_back(definition->text);
    count += write_texts(writer, "servicedefs", texts);
  }
  count += write_texts(writer, "objectimplements", host->root().rr_object_type().implements);
  writer.string_element("objecttype", *type);
  return count + 1;
}

// Whoever the credentials name is logged in; false when they name nobody.
bool ServerEndpoint::let_in(Decoder& decoder, std::string_view user, const Element& credentials) {
  VarStringMap map;
  if (!type_of<VarStringMap>.read(decoder, credentials, &map)) {
    if (decoder.code() == ErrorCode::out_of_system_resource) throw endpoint::latched(decoder);
    return false;
  }
  try {
    log_in(user);
  } catch (...) {  // it has been logged
    return false;
  }
  return true;
}

namespace {

std::uint64_t new_session() {
  static std::atomic<std::uint64_t> last{0};
  return last.fetch_add(1, std::memory_order_relaxed) + 1;
}

}  // namespace

// Makes a session; returns its number.
std::uint32_t ServerEndpoint::join(const std::shared_ptr<ServiceHost>& host,
                                   const Message& message) {
  const std::uint32_t number = directory_->core()->new_endpoint();
  client_ = {.endpoint = number,
             .node = message.sender_node,
             .node_name = std::string(message.sender_name),
             .session = new_session()};
  remote_endpoint_ = message.sender_endpoint;
  host_ = host;
  access_.open(*host);
  is_member_ = true;
  if (!host->add_client(shared_from_this())) {
    is_member_ = false;
    access_.close();
    host_.reset();
    throw service_not_found();
  }
  is_announced_ = true;
  {
    const MutexLock lock(user_mutex_);
    session_ = {host, client_};
    present_at_ = host;
  }
  connection_->set_endpoints(number, remote_endpoint_);
  connection_->set_authorised(!host->requires_user());
  access_.renew_rights(*host);  // others may have been set before the host knew of this
  audit_.connected();
  return number;
}

// Undoes join(): the connection stays, and another attempt may follow.
void ServerEndpoint::quit() {
  if (is_member_.exchange(false)) host_->remove_client(*this);
  end_members();
  if (std::exchange(is_announced_, false)) {
    host_->announce_end(*this);
    audit_.disconnected();
  }
  access_.close();
  host_.reset();
  directory_->core()->release_endpoint(client_.endpoint);
  client_ = {};
  connection_->set_endpoints(0, 0);
  connection_->set_authorised(false);
  const MutexLock lock(user_mutex_);
  session_ = {};
}

std::uint32_t ServerEndpoint::disconnect(Decoder& decoder, const Message& message,
                                         const Entry& entry) {
  std::string_view name;
  if (!is_member_ || message.receiver_endpoint != client_.endpoint ||
      !endpoint::find_text(decoder, entry, "servicename", name) || name != host_->name()) {
    throw service_not_found();
  }
  is_leaving_ = true;
  // Before the answer: who has closed a session is not to find it listed.
  if (is_member_.exchange(false)) host_->remove_client(*this);
  return 0;
}

}  // namespace rr::service
