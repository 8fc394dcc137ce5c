// SPDX-License-Identifier: Apache-2.0
// How a session begins and ends (07, section 5; 04, section 8).
#include <algorithm>
#include <utility>

#include "rr/error.hpp"
#include "rr/tap.hpp"
#include "rr/type.hpp"
#include "rr/varvalue.hpp"
#include "runtime/cpp/src/channel/time.hpp"
#include "runtime/cpp/src/client/definition_reader.hpp"
#include "runtime/cpp/src/client/session.hpp"
#include "runtime/cpp/src/endpoint/client_version.hpp"
#include "runtime/cpp/src/endpoint/values.hpp"

namespace rr {
namespace {

// How long the answer to a farewell is waited for (07, section 7).
constexpr std::chrono::milliseconds farewell_time{500};

// An entry's elements that are texts, known while they are written.
class Texts {
 public:
  void add(std::string_view name, std::string text) {
    texts_.push_back(std::move(text));
    names_.push_back(name);
  }
  void add(std::string_view name, VarStringMap map) {
    maps_.push_back(std::move(map));
    names_.push_back(name);
    texts_.emplace_back();
    map_at_ = names_.size() - 1;
  }

  // The request with these as its elements; valid while this is unchanged.
  Outgoing request(EntryType type, std::string_view path, std::string_view member = {}) {
    parameters_.clear();
    values_.clear();
    for (std::size_t i = 0; i < names_.size(); ++i) {
      const bool is_map = i == map_at_;
      parameters_.push_back({names_[i], is_map ? &type_of<VarStringMap> : &type_of<std::string>});
      values_.push_back(is_map ? static_cast<const void*>(&maps_.back()) : &texts_[i]);
    }
    return {type, path, member, parameters_, values_.data()};
  }

 private:
  std::vector<std::string_view> names_;
  std::vector<std::string> texts_;
  std::vector<VarStringMap> maps_;
  std::size_t map_at_ = static_cast<std::size_t>(-1);
  std::vector<Parameter> parameters_;
  std::vector<const void*> values_;
};

std::string required_text(Decoder& decoder, const Entry& entry, std::string_view name) {
  std::string text;
  endpoint::read_value(decoder, entry, name, type_of<std::string>, &text);
  return text;
}

std::vector<std::string> optional_texts(Decoder& decoder, const Entry& entry,
                                        std::string_view name) {
  std::vector<std::string> texts;
  Element element;
  if (find_element(decoder, entry.elements, entry.element_count, name, element)) {
    type_of<std::vector<std::string>>.read(decoder, element, &texts);
  }
  return texts;
}

std::map<std::string, VarValue> optional_map(Decoder& decoder, const Entry& entry,
                                             std::string_view name) {
  std::map<std::string, VarValue> map;
  Element element;
  if (find_element(decoder, entry.elements, entry.element_count, name, element) &&
      !type_of<VarStringMap>.read(decoder, element, &map)) {
    map.clear();
  }
  return map;
}

}  // namespace

Session::Session(std::shared_ptr<endpoint::Core> core, const Url& url, ConnectOptions options)
    : core_(std::move(core)),
      service_(url.service),
      options_(std::move(options)),
      endpoint_(core_->new_endpoint()),
      remote_node_(url.node_id),
      known_types_{options_.definition_reader ? options_.definition_reader->types()
                                              : core_->types()},
      types_(&known_types_.back()),
      quiet_since_(channel::coarse_now()) {}

Session::~Session() { core_->release_endpoint(endpoint_); }

std::shared_ptr<Stub> Session::connect(const Url& url, const ObjectType* wanted) {
  std::shared_ptr<Stub> stub;
  establish(url, [&] { stub = root(wanted); });
  return stub;
}

void Session::connect(const Url& url) {
  establish(url, [] {});
}

std::shared_ptr<Stub> Session::root(const ObjectType* wanted) {
  learn();
  const std::string_view type = !options_.object_type.empty() ? options_.object_type
                                : wanted != nullptr           ? wanted->name
                                                              : std::string_view();
  return make_stub(object_type_, service_, type, object_implements_, wanted);
}

void Session::learn() {
  if (options_.definition_reader) return;  // whose types grow by themselves
  auto types = core_->types();
  const std::lock_guard lock(mutex_);
  if (known_types_.back() == types) return;
  known_types_.push_back(std::move(types));
  types_.store(&known_types_.back(), std::memory_order_release);
}

// `check` refuses the service by throwing.
void Session::establish(const Url& url, const std::function<void()>& check) {
  const channel::Time deadline =
      channel::after(channel::Clock::now(), core_->options().connect_timeout);
  core_->start();
  channel::Channel& way = core_->channel(url.scheme);
  if (service_.empty()) service_ = way.service_at(url, deadline);
  if (service_.empty()) throw Error(ErrorCode::invalid_argument, "the URL names no service");
  way.connect(url, deadline, [this](std::shared_ptr<channel::Connection> connection) {
    connection->set_endpoints(endpoint_, 0);
    const std::lock_guard lock(mutex_);
    connection_ = std::move(connection);
    return shared_from_this();
  });
  try {
    const Milliseconds timeout = timeout_for(Milliseconds(0), {});
    if (connection_->may_combine()) {
      connect_combined(timeout);
    } else {
      connect_in_steps(timeout);
    }
    check();
    core_->attend(weak_from_this());
  } catch (const Error&) {
    std::function<void(const Error&)> on_closed;
    {
      const std::lock_guard lock(mutex_);
      on_closed.swap(options_.on_closed);  // it never was open
    }
    drop();
    connection_->close(Error(ErrorCode::connection_error, "the session has ended"));
    throw;
  }
}

void Session::connect_combined(Milliseconds timeout) {
  Texts texts;
  texts.add("clientversion", std::string(endpoint::own_version));
  texts.add("returnservicedefs", "true");
  if (!options_.username.empty()) {
    texts.add("username", options_.username);
    texts.add("credentials", options_.credentials);
  }
  std::vector<std::string> definitions;
  call(
      texts.request(EntryType::connect_client_combined, service_),
      [&](Decoder& decoder, const Message&, const Entry& entry) {
        object_type_ = required_text(decoder, entry, "objecttype");
        object_implements_ = optional_texts(decoder, entry, "objectimplements");
        definitions = optional_texts(decoder, entry, "servicedefs");
        attributes_ = optional_map(decoder, entry, "attributes");
      },
      timeout);
  for (const std::string& text : definitions) keep_definition(text);
  const std::lock_guard lock(mutex_);
  user_ = options_.username;
}

void Session::connect_in_steps(Milliseconds timeout) {
  {
    Texts texts;
    texts.add("clientversion", std::string(endpoint::own_version));
    std::string definition;
    std::vector<std::string> extra;
    call(
        texts.request(EntryType::get_service_desc, service_),
        [&](Decoder& decoder, const Message&, const Entry& entry) {
          attributes_ = optional_map(decoder, entry, "attributes");
          extra = optional_texts(decoder, entry, "extraimports");
          definition = required_text(decoder, entry, "servicedef");
        },
        timeout);
    keep_definition(definition);
    pull_imports(timeout);
    for (const std::string& name : extra) pull_definition(name, timeout);
    pull_imports(timeout);
  }
  object_type_ = ask_object_type(service_, timeout);
  call({EntryType::connect_client, service_, {}}, Incoming{}, timeout);
  if (!options_.username.empty()) {
    authenticate(options_.username, options_.credentials, timeout);
  }
}

void Session::authenticate(const std::string& username,
                           const std::map<std::string, VarValue>& credentials,
                           Milliseconds timeout) {
  Texts texts;
  texts.add("username", username);
  texts.add("credentials", credentials);
  call(texts.request(EntryType::client_session_op_req, service_, "AuthenticateUser"), Incoming{},
       timeout);
  const std::lock_guard lock(mutex_);
  user_ = username;
}

void Session::log_out() {
  Texts texts;
  {
    const std::lock_guard lock(mutex_);
    texts.add("username", user_);
  }
  call(texts.request(EntryType::client_session_op_req, service_, "LogoutUser"), Incoming{},
       Milliseconds(0));
  const std::lock_guard lock(mutex_);
  user_.clear();
}

std::string Session::ask_object_type(const std::string& path, Milliseconds timeout) {
  Texts texts;
  texts.add("clientversion", std::string(endpoint::own_version));
  std::string type;
  call(
      texts.request(EntryType::object_type_name, path),
      [&](Decoder& decoder, const Message&, const Entry& entry) {
        type = required_text(decoder, entry, "objecttype");
        if (path == service_)
          object_implements_ = optional_texts(decoder, entry, "objectimplements");
      },
      timeout);
  return type;
}

std::map<std::string, VarValue> Session::ask_attributes() {
  std::map<std::string, VarValue> attributes;
  call(
      {EntryType::get_service_attributes, service_, {}},
      [&](Decoder& decoder, const Message&, const Entry& entry) {
        attributes = optional_map(decoder, entry, "return");
      },
      Milliseconds(0));
  return attributes;
}

void Session::pull_definition(const std::string& name, Milliseconds timeout) {
  {
    const std::lock_guard lock(mutex_);
    if (outlines_.contains(name)) return;
  }
  Texts texts;
  texts.add("ServiceType", name);
  texts.add("clientversion", std::string(endpoint::own_version));
  std::string definition;
  call(
      texts.request(EntryType::get_service_desc, service_),
      [&](Decoder& decoder, const Message&, const Entry& entry) {
        definition = required_text(decoder, entry, "servicedef");
      },
      timeout);
  keep_definition(definition);
}

// Everything that what is here imports, one by one.
void Session::pull_imports(Milliseconds timeout) {
  while (true) {
    std::string missing;
    {
      const std::lock_guard lock(mutex_);
      for (const auto& [name, outline] : outlines_) {
        for (const std::string& import : outline.imports) {
          if (missing.empty() && !outlines_.contains(import)) missing = import;
        }
      }
    }
    if (missing.empty()) return;
    pull_definition(missing, timeout);
    const std::lock_guard lock(mutex_);
    if (!outlines_.contains(missing)) {
      throw Error(ErrorCode::service_definition_error,
                  "the service sent another definition for `" + missing + "`");
    }
  }
}

void Session::keep_definition(std::string_view text) {
  if (core_->options().tap) core_->options().tap->definition(text);
  client::DefinitionOutline outline = client::outline(text);
  const std::lock_guard lock(mutex_);
  texts_[outline.name] = text;
  std::string name = outline.name;
  outlines_[std::move(name)] = std::move(outline);
}

// What an answer to a connect request says about the other side, be it a failure.
void Session::take_remote(const Message& message, bool is_success) {
  remote_node_ = message.sender_node;
  remote_name_ = message.sender_name;
  remote_endpoint_ = message.sender_endpoint;
  if (!is_success) return;
  connection_->set_endpoints(endpoint_, remote_endpoint_);
  connection_->set_authorised();
  const std::lock_guard lock(mutex_);
  is_connected_ = true;
}

bool Session::is_open() const {
  const std::lock_guard lock(mutex_);
  return !why_closed_;
}

std::map<std::string, std::string> Session::definitions() const {
  const std::lock_guard lock(mutex_);
  return texts_;
}

void Session::close() {
  {
    const std::lock_guard lock(mutex_);
    if (why_closed_ || is_ending_) return;
    is_ending_ = true;
  }
  try {
    const CallTerms::Suspended scopes;  // neither shorter, nor longer, nor left out
    Texts texts;
    texts.add("servicename", service_);
    call(texts.request(EntryType::disconnect_client, {}), Incoming{}, farewell_time);
  } catch (const Error&) {
    // It ends in any case.
  }
  give_up(Error(ErrorCode::operation_aborted, "the client was closed"));
}

void Session::drop() {
  {
    const std::lock_guard lock(mutex_);
    if (why_closed_ || is_ending_) return;
    is_ending_ = true;
    if (!connection_) {  // it is being made, and will find that the session has ended
      why_closed_ = Error(ErrorCode::operation_aborted, "the client was closed");
      return;
    }
  }
  try {
    Texts texts;
    texts.add("servicename", service_);
    send(texts.request(EntryType::disconnect_client, {}), true);
  } catch (const Error&) {
    // It ends in any case.
  }
  give_up(Error(ErrorCode::operation_aborted, "the client was closed"));
}

void Session::give_up(const Error& why) {
  {
    const std::lock_guard lock(mutex_);
    if (!why_closed_) why_closed_ = why;
    is_ending_ = true;
  }
  connection_->close(Error(ErrorCode::connection_error, "the session has ended"));
}

void Session::lost(const Error& why, channel::Laters& laters) {
  {
    const std::lock_guard lock(mutex_);
    if (!why_closed_) why_closed_ = why;
  }
  fail_all(Error(ErrorCode::connection_error, why.message()), laters);
  for (const auto& end : wires_.take_all()) end->finish(laters);
}

void Session::closed() {
  pipes_.end();
  std::optional<Error> why;
  std::function<void(const Error&)> on_closed;
  // What the program has given goes when the lock has: it may own stubs, which forget themselves.
  std::function<void(const std::string&)> on_path_released;
  std::vector<std::shared_ptr<client::EventSubscription>> handlers;
  {
    const std::lock_guard lock(mutex_);
    why = why_closed_;
    on_closed.swap(options_.on_closed);
    on_path_released.swap(options_.on_path_released);
    stubs_.clear();
    handlers.swap(handlers_);
  }
  callbacks_.end();
  if (on_closed) {
    try {
      on_closed(*why);
    } catch (const std::exception& error) {
      core_->log(LogLevel::error, std::string("an on_closed handler has thrown: ") + error.what());
    }
  }
  // Whoever holds a Subscription holds no more than that: the functions, and what they own, go now.
  for (const auto& handler : handlers) handler->disconnect();
}

void Session::attend(channel::Time now) {
  {
    const std::lock_guard lock(mutex_);
    if (why_closed_ || !is_connected_) return;
    const std::uint16_t next = next_message_id_;
    if (std::exchange(seen_message_id_, next) != next) quiet_since_ = now;
    if (now - quiet_since_ < core_->options().keep_alive_period) return;
    quiet_since_ = now;
  }
  try {
    send({EntryType::client_keep_alive_req, service_, {}}, false);
  } catch (const Error&) {
    // The session ends, which is told in another way.
  }
}

}  // namespace rr
