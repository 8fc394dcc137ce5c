// SPDX-License-Identifier: Apache-2.0
// How a session begins and ends (07, section 5; 04, section 8).
#include <algorithm>
#include <utility>

#include "rr/call.hpp"
#include "rr/error.hpp"
#include "rr/type.hpp"
#include "rr/varvalue.hpp"
#include "runtime/cpp/src/channel/directories.hpp"
#include "runtime/cpp/src/channel/texts.hpp"
#include "runtime/cpp/src/channel/time.hpp"
#include "runtime/cpp/src/client/definition_reader.hpp"
#include "runtime/cpp/src/client/session.hpp"
#include "runtime/cpp/src/endpoint/client_version.hpp"
#include "runtime/cpp/src/endpoint/user_code.hpp"
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

// Whether a local URL means a node of this user or of the system.
bool is_own(const Url& url) {
  if (url.path.size() > 1) return false;  // anybody can have made what is at a path
  if (url.host.empty() || url.host == "localhost" || url.host == "root@localhost") return true;
  return url.host == channel::own_user_name() + "@localhost";
}

SessionLimits limits_of(const NodeOptions& options) {
  return {.held = std::max(options.budget.client_session,
                           std::size_t{options.limits.message_size} / 2 * 7),
          .definitions = options.definitions};
}

// In a pool that the session shares with nobody.
std::shared_ptr<channel::Account> make_account(std::size_t limit) {
  return std::make_shared<channel::Account>(std::make_shared<channel::Pool>(limit, limit), limit);
}

}  // namespace

Session::Session(std::shared_ptr<endpoint::Core> core, const Url& url, ConnectOptions options)
    : core_(std::move(core)),
      service_(url.service),
      on_closed_(std::move(options.on_closed)),
      on_path_released_(std::move(options.on_path_released)),
      options_(std::move(options)),
      limits_(limits_of(core_->options())),
      endpoint_(core_->new_endpoint()),
      remote_{.endpoint = 0, .node = url.node_id, .name = {}},
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
  return stubs_.keep(service_, make_stub(object_type_, service_, type, object_implements_, wanted));
}

// What differs is known before there is a stub of a new type.
void Session::learn() {
  if (options_.definition_reader) return;  // whose types grow by themselves
  auto types = core_->types();
  const auto is_known = [&]() RR_REQUIRES(mutex_) { return known_types_.back() == types; };
  {
    const MutexLock lock(mutex_);
    if (is_known()) return;
  }
  compare_definitions(*types);
  const MutexLock lock(mutex_);
  if (is_known()) return;
  known_types_.push_back(std::move(types));
  types_.store(&known_types_.back(), std::memory_order_release);
}

// `check` refuses the service by throwing.
void Session::establish(const Url& url, const std::function<void()>& check) {
  const channel::Time deadline =
      channel::after(channel::Clock::now(), core_->options().connect_timeout);
  core_->start();
  channel::Channel& way = core_->channel(url.scheme);
  check_channel(url, way.traits(url.scheme));
  if (service_.empty()) service_ = way.service_at(url, deadline);
  if (service_.empty()) {
    throw Error(ErrorCode::invalid_argument,
                std::string("the URL names no service; ") + channel::url_example);
  }
  way.connect(url, deadline, [this](std::shared_ptr<channel::Connection> connection) {
    connection->set_endpoints(endpoint_, 0);
    connection->set_account(make_account(limits_.held));
    const MutexLock lock(mutex_);
    connection_ = std::move(connection);
    return shared_from_this();
  });
  try {
    const Patience patience = patience_for(Milliseconds(0));
    if (connection_->may_combine()) {
      connect_combined(patience);
    } else {
      connect_in_steps(patience);
    }
    compare_definitions(*types());
    check();
    core_->attend(weak_from_this());
  } catch (const Error&) {
    std::function<void(const Error&)> on_closed;
    {
      const MutexLock lock(mutex_);
      on_closed.swap(on_closed_);  // it never was open
    }
    drop();
    connection_->close(Error(ErrorCode::connection_error, "the session has ended"));
    throw;
  }
}

// Before anything is sent.
void Session::check_channel(const Url& url, const ChannelTraits& traits) {
  if (core_->options().tls.is_required && !traits.is_encrypted && !traits.is_local) {
    throw Error(ErrorCode::connection_error,
                "this node requires TLS, and `" + url.scheme + "` does not use it" +
                    (url.scheme.starts_with("rr+") ? ": `rrs" + url.scheme.substr(2) + "` does"
                                                   : std::string()));
  }
  is_found_ = is_found_ || core_->found_urls().contains(url);
  if (!is_found_ || options_.allow_clear_credentials) return;
  may_send_credentials_ =
      traits.is_encrypted || (traits.is_local && (url.scheme != "rr+local" || is_own(url)));
  if (!options_.username.empty()) check_credentials();
}

void Session::check_credentials() const {
  if (may_send_credentials_) return;
  throw Error(ErrorCode::authentication_error,
              "credentials are not sent without TLS to a URL that discovery has found; the option "
              "`allow_clear_credentials` (C#, MATLAB: `AllowClearCredentials`) sends them");
}

void Session::connect_combined(const Patience& patience) {
  Texts texts;
  texts.add("clientversion", std::string(endpoint::own_version));
  texts.add("returnservicedefs", "true");
  if (!options_.username.empty()) {
    texts.add("username", options_.username);
    texts.add("credentials", options_.credentials);
  }
  std::vector<std::string> definitions;
  ask(
      texts.request(EntryType::connect_client_combined, service_),
      [&](Decoder& decoder, const Message&, const Entry& entry) {
        object_type_ = required_text(decoder, entry, "objecttype");
        object_implements_ = optional_texts(decoder, entry, "objectimplements");
        definitions = optional_texts(decoder, entry, "servicedefs");
        attributes_ = optional_map(decoder, entry, "attributes");
      },
      patience);
  for (const std::string& text : definitions) keep_definition(text);
  const MutexLock lock(mutex_);
  user_ = options_.username;
}

// Requests that follow each other have a time all together, and each has its own.
Session::Patience Session::patience_for(Milliseconds timeout) const {
  const Milliseconds one = timeout_for(timeout, CallTerms::of_blocking_call());
  const Milliseconds all = std::max(limits_.definitions.timeout, one);
  return {one, channel::after(channel::Clock::now(), all)};
}

void Session::ask(const Outgoing& request, const AnswerReader& read, const Patience& patience) {
  const auto left = std::chrono::ceil<Milliseconds>(patience.deadline - channel::Clock::now());
  if (left.count() <= 0) throw Error(ErrorCode::request_timeout, "no answers in time");
  const CallOptions options = within(std::min(patience.one, left));
  const CallOptionsScope scope(options);
  call(request, read, Milliseconds(0));
}

void Session::connect_in_steps(const Patience& patience) {
  {
    Texts texts;
    texts.add("clientversion", std::string(endpoint::own_version));
    std::string definition;
    std::vector<std::string> extra;
    ask(
        texts.request(EntryType::get_service_desc, service_),
        [&](Decoder& decoder, const Message&, const Entry& entry) {
          attributes_ = optional_map(decoder, entry, "attributes");
          extra = optional_texts(decoder, entry, "extraimports");
          definition = required_text(decoder, entry, "servicedef");
        },
        patience);
    keep_definition(definition);
    pull_imports(patience);
    for (const std::string& name : extra) pull_definition(name, patience);
    pull_imports(patience);
  }
  {
    Texts texts;
    texts.add("clientversion", std::string(endpoint::own_version));
    ask(
        texts.request(EntryType::object_type_name, service_),
        [&](Decoder& decoder, const Message&, const Entry& entry) {
          object_type_ = required_text(decoder, entry, "objecttype");
          object_implements_ = optional_texts(decoder, entry, "objectimplements");
        },
        patience);
  }
  const auto nothing = [](Decoder&, const Message&, const Entry&) {};
  ask({EntryType::connect_client, service_, {}}, nothing, patience);
  if (!options_.username.empty()) {
    authenticate(options_.username, options_.credentials, patience);
  }
}

void Session::authenticate(const std::string& username,
                           const std::map<std::string, VarValue>& credentials,
                           Milliseconds timeout) {
  authenticate(username, credentials, patience_for(timeout));
}

void Session::authenticate(const std::string& username,
                           const std::map<std::string, VarValue>& credentials,
                           const Patience& patience) {
  check_credentials();
  Texts texts;
  texts.add("username", username);
  texts.add("credentials", credentials);
  const auto nothing = [](Decoder&, const Message&, const Entry&) {};
  ask(texts.request(EntryType::client_session_op_req, service_, "AuthenticateUser"), nothing,
      patience);
  const MutexLock lock(mutex_);
  user_ = username;
}

void Session::log_out() {
  Texts texts;
  {
    const MutexLock lock(mutex_);
    texts.add("username", user_);
  }
  call(texts.request(EntryType::client_session_op_req, service_, "LogoutUser"), Incoming{},
       Milliseconds(0));
  const MutexLock lock(mutex_);
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

// What the answer to a connect request says about the other side, be it a failure. Once: who uses
// the session may look at it from then on.
void Session::take_remote(const Message& message, bool is_success) {
  {
    const MutexLock lock(mutex_);
    if (std::exchange(has_remote_, true)) return;
    remote_.node = message.sender_node;
    remote_.name = message.sender_name;
    remote_.endpoint = message.sender_endpoint;
    is_connected_ = is_success;
  }
  if (!is_success) return;
  connection_->set_endpoints(endpoint_, message.sender_endpoint);
  connection_->set_authorised(limits_.has_full_messages);
}

bool Session::is_open() const {
  const MutexLock lock(mutex_);
  return !why_closed_;
}

std::map<std::string, std::string> Session::definitions() const {
  const MutexLock lock(mutex_);
  return texts_.all();
}

void Session::close() {
  {
    const MutexLock lock(mutex_);
    if (why_closed_) is_given_up_ = true;
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
    const MutexLock lock(mutex_);
    if (why_closed_) is_given_up_ = true;
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
    const MutexLock lock(mutex_);
    if (!why_closed_) why_closed_ = why;
    is_ending_ = true;
    is_given_up_ = true;
  }
  connection_->close(Error(ErrorCode::connection_error, "the session has ended"));
}

void Session::lost(const Error& why, channel::DeferredCallbacks& deferred) {
  {
    const MutexLock lock(mutex_);
    if (!why_closed_) why_closed_ = why;
  }
  fail_all(Error(ErrorCode::connection_error, why.message()), deferred);
  for (const auto& end : wires_.take_all()) end->finish(deferred);
}

void Session::closed() {
  pipes_.end();
  std::optional<Error> why;
  std::function<void(const Error&)> on_closed;
  // What the program has given goes when the lock has: it may own stubs, which forget themselves.
  std::function<void(const std::string&)> on_path_released;
  std::vector<std::shared_ptr<client::EventSubscription>> handlers;
  {
    const MutexLock lock(mutex_);
    why = why_closed_;
    on_closed.swap(on_closed_);
    on_path_released.swap(on_path_released_);
    stubs_.clear();
    handlers.swap(handlers_);
  }
  callbacks_.end();
  if (on_closed) {
    endpoint::call_user_code(*core_, "an on_closed handler", [&] { on_closed(*why); });
  }
  // Whoever holds a Subscription holds no more than that: the functions, and what they own, go now.
  for (const auto& handler : handlers) handler->disconnect();
}

void Session::attend(channel::Time now) {
  {
    const MutexLock lock(mutex_);
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
